#include "calibration/chart/exposure_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "calibration/chart/raw_scale.h"
#include "io/error.h"
#include "io/schema/read.h"
#include "io/text.h"
#include "sensor/film/crop.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/patch.h"

namespace abbe {
namespace {

constexpr int kGridColumns = 16;
constexpr int kGridRows = 12;
// Relative error of pixels in single precision; neighbouring codes of 16 bits differ by 15 times as much.
constexpr double kRounding = 1e-6;

struct Photograph {
  std::string file;  // relative to the listing while that is being read
  std::optional<double> exposure_s;
  SourcePosition where;
};

using Edges = std::array<int, 4>;

struct Listing {
  std::vector<Photograph> photographs;
  std::vector<schema::Located<Edges>> edges;
  std::vector<Crop> regions;  // built from `edges`
  std::optional<double> full_scale;
  std::optional<int> bits;
};

struct Scale {
  double black = 0;
  double full = 1;
  double rounding = 0;  ///< Standard deviation of codes due to rounding, as a fraction of the range.
};

schema::Fields fields(schema::Tag<Photograph>) {
  using namespace schema;
  return describe("photograph", "One photograph of a series.",
                  {field("file", &Photograph::file, "A picture, relative to the listing."),
                   field("exposure_s", &Photograph::exposure_s, Range::positive(),
                         "Exposure time [s]; by default the one that the file records.")});
}

schema::Fields fields(schema::Tag<Listing>) {
  using namespace schema;
  return describe(
      "series", "Photographs of one still scene.",
      {field("exposures", &Listing::photographs, list<Photograph>("exposures", 1), "The photographs."),
       defaulted("regions", &Listing::edges,
                 list<Located<Edges>>(vector<Edges>({0, kMaxImageEdge}), "regions", 0),
                 "Patches, each as its pixels [x0, y0, x1, y1], the last ones excluded."),
       field("full_scale", &Listing::full_scale, Range::positive(),
             "Value at which the camera clips; by default the level that the file records, else 1."),
       field(
           "bits", &Listing::bits, {0, 16},
           "Bits to which codes were rounded, 0 if unknown; by default the number that the file records.")});
}

std::vector<Crop> build_regions(const Listing& listing, Diagnostics& diagnostics) {
  std::vector<Crop> regions;
  for (const auto& spec : listing.edges) {
    const auto& [x0, y0, x1, y1] = spec.value;
    regions.push_back({x0, y0, x1, y1});
    if (x0 >= x1 || y0 >= y1)
      diagnostics.error(spec.where, "expected pixels x0, y0, x1, y1 with x0 < x1 and y0 < y1");
  }
  return regions;
}

// Errors are those of an input, not of a scene.
std::optional<Listing> read_listing(const std::filesystem::path& path, Diagnostics& diagnostics) {
  const auto source = read_text(path, diagnostics);
  if (!source) return std::nullopt;
  Diagnostics faults;
  const std::optional<JsonValue> root = parse_json(source, faults);
  auto listing = root ? schema::read<Listing>(*root, faults) : std::nullopt;
  if (listing) listing->regions = build_regions(*listing, faults);
  for (const Diagnostic& fault : faults.all())
    diagnostics.error(fault.where, fault.message, ErrorCode::input);
  if (faults.has_errors() || !listing) return std::nullopt;
  for (Photograph& photograph : listing->photographs)
    photograph.file = (path.parent_path() / photograph.file).string();
  return listing;
}

// Names of the channels that are responses: the sensor planes that the file records, otherwise all but alpha
// and variances.
std::vector<std::string> responses_of(const Image& image) {
  std::vector<std::string> names = plane_names(image);
  const bool are_recorded = image.metadata.contains("sensor_channels");
  if (!are_recorded || std::ranges::any_of(names, [&](const std::string& n) { return !image.find(n); })) {
    names.clear();
    for (const ImageChannel& channel : image.channels)
      if (channel.name != "A") names.push_back(channel.name);
  }
  std::erase_if(names, [](const std::string& name) { return name.find('.') != std::string::npos; });
  return names;
}

// Channels that are responses: R, G, B, then others in the file's order.
std::vector<const ImageChannel*> planes_of(const Image& image) {
  const std::vector<std::string> names = responses_of(image);
  const auto is_response = [&](const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  std::vector<const ImageChannel*> planes;
  for (const char* name : {"R", "G", "B"})
    if (is_response(name)) planes.push_back(image.find(name));
  for (const ImageChannel& channel : image.channels)
    if (std::ranges::find(planes, &channel) == planes.end() && is_response(channel.name))
      planes.push_back(&channel);
  return planes;
}

std::optional<Mosaic> mosaic_of(const Image& image, const std::optional<RawScale>& recorded) {
  return recorded && planes_of(image).size() == 1 ? recorded->mosaic : std::nullopt;
}

std::vector<std::string> channels_of(const Image& image, const std::optional<RawScale>& recorded) {
  if (mosaic_of(image, recorded)) return recorded->channels;
  std::vector<std::string> names;
  for (const ImageChannel* plane : planes_of(image)) names.push_back(plane->name);
  return names;
}

// Code of a raw file that counts as clipped, on the straight line that is made of its codes. The listing
// gives a code of the file, or, for DNGs of other programs, one that their table yields.
double full_dn(const Image& image, const Listing& listing, const RawScale& codes) {
  if (!listing.full_scale) return white_dn(image, codes);
  return codes.linear(code_of(static_cast<float>(*listing.full_scale)));
}

// The file's own scale, unless the listing overrides it. `codes` is set for a raw file.
Scale scale_of(const Image& image, const Listing& listing, const std::optional<RawScale>& codes) {
  Scale scale{0, listing.full_scale.value_or(1)};
  if (codes) {
    scale = {codes->offset_dn / kSixteenBits, full_dn(image, listing, *codes) / kSixteenBits};
    scale.rounding = 1 / (std::sqrt(12.0) * kSixteenBits * (scale.full - scale.black));
  }
  if (listing.bits) scale.rounding = CodeNoise{*listing.bits, 0, 0}.deviation(0);
  return scale;
}

// Regular grid of regions, each one pixel, or one pattern of a mosaic.
std::vector<Crop> grid(int width, int height, const Mosaic& cell) {
  std::vector<Crop> pixels;
  for (int row = 0; row < std::min(kGridRows, height); ++row)
    for (int column = 0; column < std::min(kGridColumns, width); ++column) {
      const int x = (2 * column + 1) * width / (2 * std::min(kGridColumns, width));
      const int y = (2 * row + 1) * height / (2 * std::min(kGridRows, height));
      const int left = std::min(x - x % cell.width, width - cell.width);
      const int top = std::min(y - y % cell.height, height - cell.height);
      pixels.push_back({left, top, left + cell.width, top + cell.height});
    }
  return pixels;
}

struct Code {
  double value = 0;
  double deviation = 0;
};

// Standard error of the median of Gaussian noise, in units of a pixel's deviation. The median of two values
// is their mean.
double error_of_median(std::size_t pixels) {
  const double ratio_to_mean = pixels > 2 ? std::sqrt(std::numbers::pi / 2) : 1;
  return ratio_to_mean / std::sqrt(static_cast<double>(pixels));
}

// Median code of a patch and its standard error, which is 0 if it has one pixel. The code is at an end of the
// scale if more pixels than may be defective are there. Noise arises before the response, as that of photons
// and read-out, or after it. A response curve maps the median of the light to the median of the codes, but
// not the mean to the mean.
Code patch_code(const PatchChannel& patch, const Scale& scale) {
  const double range = scale.full - scale.black;
  if (patch.is_black()) return {0, 0};
  if (patch.is_saturated()) return {1, 0};
  const double value = (patch.median - scale.black) / range;
  if (!patch.deviation) return {value, 0};
  return {value, std::hypot(*patch.deviation / range * error_of_median(patch.pixels), scale.rounding)};
}

PatchOutline outline_of(const Crop& r) {
  return {"region",
          {Imath::V2d(r.x0, r.y0), Imath::V2d(r.x1, r.y0), Imath::V2d(r.x1, r.y1), Imath::V2d(r.x0, r.y1)}};
}

bool is_finite(const ImageChannel* channel) {
  return std::ranges::all_of(channel->values, [](float v) { return std::isfinite(v); });
}

// Fault of a photograph in comparison with the first; empty if there is none.
std::string objection(const Image& image, const Image& first, const Listing& listing) {
  if (image.width != first.width || image.height != first.height)
    return fmt::format("has {} x {} pixels, the first {} x {}", image.width, image.height, first.width,
                       first.height);
  if (!std::ranges::equal(planes_of(image), planes_of(first), {}, &ImageChannel::name, &ImageChannel::name))
    return "has other channels than the first";
  if (!std::ranges::all_of(planes_of(image), is_finite)) return "has values that are not finite";
  for (const Crop& r : listing.regions)
    if (r.x1 > image.width || r.y1 > image.height)
      return fmt::format("region [{}, {}, {}, {}] exceeds its {} x {} pixels", r.x0, r.y0, r.x1, r.y1,
                         image.width, image.height);
  return "";
}

std::string full_scale_objection(const Image& image, const Listing& listing, const RawScale& codes) {
  if (!listing.full_scale) return "";
  const double code = code_of(static_cast<float>(*listing.full_scale));
  // other programs record where codes clip, but not where they end
  const bool is_own = raw_scale(image).has_value();
  const double highest = is_own ? std::exp2(codes.bits) - 1 : kSixteenBits;
  if (code <= highest && codes.linear(code) > codes.offset_dn) return "";
  return fmt::format(
      "has codes from {}, its black, to {}, and \"full_scale\" is outside (got {}, which is code {}, allowed "
      "above {:.6g} to {:.6g}, as 65535 is 1)",
      codes.offset_dn, highest, *listing.full_scale, code, codes.offset_dn / kSixteenBits,
      highest / kSixteenBits);
}

// Measures the regions of one photograph, and appends their codes to the series and the statistics to
// `measured`.
void add(const Image& image, const std::optional<RawScale>& recorded, const std::vector<Crop>& regions,
         const Scale& scale, PhotographedSeries& all, std::vector<std::vector<PatchChannel>>& measured) {
  MeasuredPlanes planes{planes_of(image), all.channels, mosaic_of(image, recorded),
                        scale.full * (1 - kRounding)};
  planes.black = scale.black * (1 + kRounding);
  std::vector<PatchOutline> outlines;
  std::ranges::transform(regions, std::back_inserter(outlines), outline_of);
  const std::vector<PatchValues> patches = measure_patches(image, planes, outlines);
  for (std::size_t i = 0; i < patches.size(); ++i)
    for (std::size_t k = 0; k < patches[i].channels.size(); ++k) {
      measured[k].push_back(patches[i].channels[k]);
      const Code code = patch_code(patches[i].channels[k], scale);
      all.series[k].codes[i].push_back(code.value);
      all.series[k].deviations[i].push_back(code.deviation);
    }
}

void start_series(const std::vector<std::string>& channels, std::size_t regions, PhotographedSeries& all) {
  const std::vector<std::vector<double>> none(regions);
  for (const std::string& channel : channels) {
    all.channels.push_back(channel);
    all.series.push_back({{}, none, none});
  }
}

// Warns if regions show that the camera clips below the full scale of the series.
void warn_of_clipping(const std::vector<std::vector<PatchChannel>>& measured, double full,
                      const PhotographedSeries& all, const SourcePosition& where, Diagnostics& diagnostics) {
  const std::vector<std::optional<double>> levels = clipping_levels(measured, full * (1 - kRounding));
  for (std::size_t k = 0; k < levels.size(); ++k)
    if (const auto level = levels[k])
      diagnostics.warning(
          where,
          fmt::format("regions of {} hold the value {:.6g} without any noise, and none is above it: the "
                      "camera clips there, below the full scale of {:.6g}; set \"full_scale\" to {:.6g}",
                      all.channels[k], *level, full, *level));
}

// A deviation of zero would mean certainty. If a channel has one, its noise counts as unknown.
void drop_zero_deviations(ExposureSeries& series) {
  for (std::size_t i = 0; i < series.codes.size(); ++i)
    for (std::size_t j = 0; j < series.codes[i].size(); ++j)
      if (series.codes[i][j] > 0 && series.codes[i][j] < 1 && !(series.deviations[i][j] > 0)) {
        series.deviations.clear();
        return;
      }
}

}  // namespace

PlantedResponse::PlantedResponse(const std::string& description) {
  constexpr std::string_view kGamma = "gamma:";
  if (description == "linear") return;
  if (description == "s-curve") {
    power_ = 1.4;
    shoulder_ = std::pow(0.18, power_);
    return;
  }
  const std::optional<double> gamma =
      description.starts_with(kGamma) ? parse_number(description.substr(kGamma.size())) : std::nullopt;
  if (!gamma || !(*gamma >= 0.2 && *gamma <= 5))
    throw Error(ErrorCode::usage, "--response",
                fmt::format("expected linear, s-curve or gamma:G with G in [0.2, 5] (got {})", description));
  power_ = 1 / *gamma;
}

// z = x^p (1 + s)/(x^p + s) with s = 0 for a pure power.
double PlantedResponse::code(double exposure) const {
  const double p = std::pow(std::clamp(exposure, 0.0, 1.0), power_);
  return shoulder_ > 0 ? p * (1 + shoulder_) / (p + shoulder_) : p;
}

double PlantedResponse::exposure(double code) const {
  const double z = std::clamp(code, 0.0, 1.0);
  const double p = shoulder_ > 0 ? shoulder_ * z / (1 + shoulder_ - z) : z;
  return std::pow(p, 1 / power_);
}

double CodeNoise::deviation(double code) const {
  const double step = bits > 0 ? 1 / (std::ldexp(1.0, bits) - 1) : 0;
  return std::sqrt(read * read + shot * std::max(0.0, code) + step * step / 12);
}

ExposureSeries expose(std::span<const double> values, std::span<const double> times_s,
                      const PlantedResponse& response, const CodeNoise& noise, std::uint64_t seed) {
  const double full_scale = std::ldexp(1.0, noise.bits) - 1;
  const CodeNoise before_rounding{0, noise.read, noise.shot};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  ExposureSeries series{{times_s.begin(), times_s.end()}, {}, {}};
  const bool is_noisy = noise.deviation(1) > 0;
  for (const double value : values) {
    std::vector<double>& codes = series.codes.emplace_back();
    if (is_noisy) series.deviations.emplace_back();
    for (const double time : times_s) {
      const double mean = response.code(value * time);
      double code = std::clamp(mean + before_rounding.deviation(mean) * normal(random), 0.0, 1.0);
      if (noise.bits > 0) code = std::round(code * full_scale) / full_scale;
      codes.push_back(code);
      if (is_noisy) series.deviations.back().push_back(noise.deviation(code));
    }
  }
  return series;
}

std::optional<PhotographedSeries> read_series(const std::filesystem::path& path, Diagnostics& diagnostics,
                                              Inputs* inputs) {
  const std::optional<Listing> parsed = read_listing(path, diagnostics);
  if (!parsed) return std::nullopt;
  const Listing& listing = *parsed;
  if (inputs) {
    inputs->add_file(path);
    for (const Photograph& photograph : listing.photographs) inputs->add_file(photograph.file);
  }
  PhotographedSeries all;
  std::optional<Image> first;
  std::vector<Crop> regions = listing.regions;
  std::vector<std::vector<PatchChannel>> measured;
  double full = 1;
  for (const Photograph& photograph : listing.photographs) {
    const RawImage read = read_raw_image(photograph.file, inputs);
    const auto& [image, recorded, warnings] = read;
    for (const std::string& warning : warnings) diagnostics.warning(photograph.where, warning);
    const std::optional<RawScale> codes = holds_sensor_codes(read) ? recorded : std::nullopt;
    std::string fault = objection(image, first ? *first : image, listing);
    if (fault.empty() && first && codes.has_value() != all.full_scale.dn.has_value())
      fault = codes ? "has codes of its sensor, but the first has other values: was one converted?"
                    : "has no codes of a sensor, but the first has: was it converted?";
    if (fault.empty() && codes) fault = full_scale_objection(image, listing, *codes);
    if (fault.empty() && !photograph.exposure_s && !(recorded && recorded->exposure_s))
      fault = "records no exposure time: \"exposure_s\" is needed here";
    if (!fault.empty()) {
      diagnostics.error(photograph.where, photograph.file + " " + fault, ErrorCode::input);
      return std::nullopt;
    }
    if (!first) {
      if (regions.empty())
        regions = grid(image.width, image.height, recorded ? recorded->mosaic.value_or(Mosaic{}) : Mosaic{});
      start_series(channels_of(image, recorded), regions.size(), all);
      measured.resize(all.channels.size());
      full = scale_of(image, listing, codes).full;
      if (codes) all.full_scale.dn = full_dn(image, listing, *codes) - codes->offset_dn;
      if (!codes) all.full_scale.value = listing.full_scale.value_or(1);
      first = image;
    }
    add(image, recorded, regions, scale_of(image, listing, codes), all, measured);
    if (inputs) inputs->release_memory(image.memory_bytes());
    for (std::size_t k = 0; k < all.series.size(); ++k)
      all.series[k].times_s.push_back(photograph.exposure_s ? *photograph.exposure_s
                                                            : recorded->exposure_of(all.channels[k]).value());
  }
  warn_of_clipping(measured, full, all, listing.photographs.front().where, diagnostics);
  if (listing.regions.empty())
    for (ExposureSeries& series : all.series) series.deviations.clear();
  for (ExposureSeries& series : all.series)
    if (!series.deviations.empty()) drop_zero_deviations(series);
  return all;
}

}  // namespace abbe
