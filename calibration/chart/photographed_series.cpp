#include "calibration/chart/photographed_series.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "io/picture.h"
#include "io/schema/read.h"
#include "io/text.h"

namespace abbe {
namespace {

constexpr int kGridColumns = 16;
constexpr int kGridRows = 12;

// Pixels of one patch, the last column and row excluded.
struct Region {
  int x0, y0, x1, y1;
};

struct Photograph {
  std::string file;  // relative to the listing until that has been read
  double exposure_s = 0;
  SourcePosition where;
};

using Edges = std::array<int, 4>;

struct Listing {
  std::vector<Photograph> photographs;
  std::vector<schema::Located<Edges>> edges;
  std::vector<Region> regions;  // of these edges
  double full_scale = 1;
  int bits = 0;
};

schema::Fields fields(schema::Tag<Photograph>) {
  using namespace schema;
  return describe("photograph", "One photograph of a series.",
                  {field("file", &Photograph::file, "A picture, relative to the listing."),
                   field("exposure_s", &Photograph::exposure_s, Range::positive(), "Its exposure time.")});
}

schema::Fields fields(schema::Tag<Listing>) {
  using namespace schema;
  return describe(
      "series", "Photographs of one still scene.",
      {field("exposures", &Listing::photographs, list<Photograph>("exposures", 1), "The photographs."),
       defaulted("regions", &Listing::edges,
                 list<Located<Edges>>(vector<Edges>({0, kMaxImageEdge}), "regions", 0),
                 "Patches, each as its pixels [x0, y0, x1, y1], the last ones excluded."),
       defaulted("full_scale", &Listing::full_scale, Range::positive(),
                 "The value at which the camera clips."),
       defaulted("bits", &Listing::bits, {0, 16}, "Bits that codes were rounded to, 0 if unknown.")});
}

std::vector<Region> build_regions(const Listing& listing, Diagnostics& diagnostics) {
  std::vector<Region> regions;
  for (const auto& said : listing.edges) {
    const auto& [x0, y0, x1, y1] = said.value;
    regions.push_back({x0, y0, x1, y1});
    if (x0 >= x1 || y0 >= y1)
      diagnostics.error(said.where, "expected pixels x0, y0, x1, y1 with x0 < x1 and y0 < y1");
  }
  return regions;
}

std::optional<Listing> parse_listing(const std::shared_ptr<const SourceText>& source,
                                     Diagnostics& diagnostics) {
  const std::optional<JsonValue> root = parse_json(source, diagnostics);
  auto listing = root ? schema::read<Listing>(*root, diagnostics) : std::nullopt;
  if (listing) listing->regions = build_regions(*listing, diagnostics);
  return diagnostics.has_errors() ? std::nullopt : listing;
}

// Its faults are those of an input, not of a scene.
std::optional<Listing> read_listing(const std::filesystem::path& path, Diagnostics& diagnostics) {
  const auto source = read_text(path, diagnostics);
  if (!source) return std::nullopt;
  Diagnostics faults;
  std::optional<Listing> listing = parse_listing(source, faults);
  for (const Diagnostic& fault : faults.all())
    diagnostics.error(fault.where, fault.message, ErrorCode::input);
  if (listing)
    for (Photograph& photograph : listing->photographs)
      photograph.file = (path.parent_path() / photograph.file).string();
  return listing;
}

// The channels that are responses, neither alpha nor variances: R, G, B, then others in the file's order.
std::vector<const ImageChannel*> responses(const Image& image) {
  std::vector<const ImageChannel*> found;
  for (const char* name : {"R", "G", "B"})
    if (const ImageChannel* channel = image.find(name)) found.push_back(channel);
  for (const ImageChannel& channel : image.channels)
    if (std::find(found.begin(), found.end(), &channel) == found.end() && channel.name != "A" &&
        channel.name.find('.') == std::string::npos)
      found.push_back(&channel);
  return found;
}

std::vector<Region> grid(int width, int height) {
  std::vector<Region> pixels;
  for (int row = 0; row < std::min(kGridRows, height); ++row)
    for (int column = 0; column < std::min(kGridColumns, width); ++column) {
      const int x = (2 * column + 1) * width / (2 * std::min(kGridColumns, width));
      const int y = (2 * row + 1) * height / (2 * std::min(kGridRows, height));
      pixels.push_back({x, y, x + 1, y + 1});
    }
  return pixels;
}

struct Code {
  double value = 0;
  double deviation = 0;
};

// The mean over a region and its standard error; an end of the scale where a pixel has reached it.
Code code_of(const ImageChannel& channel, int width, const Region& r, const Listing& listing) {
  double sum = 0;
  double squares = 0;
  double lowest = 1;
  double highest = 0;
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) {
      const double code =
          static_cast<double>(channel.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                             static_cast<std::size_t>(x)]) /
          listing.full_scale;
      sum += code;
      squares += code * code;
      lowest = std::min(lowest, code);
      highest = std::max(highest, code);
    }
  if (lowest <= 0) return {0, 0};
  if (highest >= 1) return {1, 0};
  const double count = static_cast<double>(r.x1 - r.x0) * static_cast<double>(r.y1 - r.y0);
  const double mean = sum / count;
  const double variance = std::max(0.0, squares / count - mean * mean) / std::max(1.0, count - 1);
  return {mean, std::hypot(std::sqrt(variance), CodeNoise{listing.bits, 0, 0}.deviation(0))};
}

bool is_finite(const ImageChannel& channel) {
  return std::all_of(channel.values.begin(), channel.values.end(), [](float v) { return std::isfinite(v); });
}

// What is wrong with one photograph beside the first; empty when nothing is.
std::string objection(const Image& image, const Image& first, const Listing& listing) {
  if (image.width != first.width || image.height != first.height)
    return fmt::format("has {} x {} pixels, the first {} x {}", image.width, image.height, first.width,
                       first.height);
  const auto channels = responses(image);
  const auto expected = responses(first);
  if (!std::equal(channels.begin(), channels.end(), expected.begin(), expected.end(),
                  [](const ImageChannel* a, const ImageChannel* b) { return a->name == b->name; }))
    return "has other channels than the first";
  if (!std::all_of(channels.begin(), channels.end(), [](const ImageChannel* c) { return is_finite(*c); }))
    return "has values that are not finite";
  for (const Region& r : listing.regions)
    if (r.x1 > image.width || r.y1 > image.height)
      return fmt::format("region [{}, {}, {}, {}] lies beyond its {} x {} pixels", r.x0, r.y0, r.x1, r.y1,
                         image.width, image.height);
  return "";
}

void add(const Image& image, const std::vector<Region>& regions, const Listing& listing,
         PhotographedSeries& all) {
  const auto channels = responses(image);
  for (std::size_t k = 0; k < channels.size(); ++k)
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const Code code = code_of(*channels[k], image.width, regions[i], listing);
      all.series[k].codes[i].push_back(code.value);
      all.series[k].deviations[i].push_back(code.deviation);
    }
}

// Deviations of zero would be certainty: where one is found, nothing is known.
void forget_certainty(ExposureSeries& series) {
  for (std::size_t i = 0; i < series.codes.size(); ++i)
    for (std::size_t j = 0; j < series.codes[i].size(); ++j)
      if (series.codes[i][j] > 0 && series.codes[i][j] < 1 && !(series.deviations[i][j] > 0)) {
        series.deviations.clear();
        return;
      }
}

}  // namespace

std::optional<PhotographedSeries> read_series(const std::filesystem::path& path, Diagnostics& diagnostics,
                                              Inputs* inputs) {
  const std::optional<Listing> said = read_listing(path, diagnostics);
  if (!said) return std::nullopt;
  const Listing& listing = *said;
  if (inputs) {
    inputs->add_file(path);
    for (const Photograph& photograph : listing.photographs) inputs->add_file(photograph.file);
  }
  PhotographedSeries all;
  std::optional<Image> first;
  std::vector<Region> regions = listing.regions;
  for (const Photograph& photograph : listing.photographs) {
    Image image = read_image(photograph.file, inputs);
    const std::string wrong = objection(image, first ? *first : image, listing);
    if (!wrong.empty()) {
      diagnostics.error(photograph.where, photograph.file + " " + wrong, ErrorCode::input);
      return std::nullopt;
    }
    if (!first) {
      if (regions.empty()) regions = grid(image.width, image.height);
      const std::vector<std::vector<double>> none(regions.size());
      for (const ImageChannel* channel : responses(image)) {
        all.channels.push_back(channel->name);
        all.series.push_back({{}, none, none});
      }
      first = image;
    }
    add(image, regions, listing, all);
    if (inputs) inputs->give_back_memory(image.memory_bytes());
    for (ExposureSeries& series : all.series) series.times_s.push_back(photograph.exposure_s);
  }
  if (listing.regions.empty())
    for (ExposureSeries& series : all.series) series.deviations.clear();
  for (ExposureSeries& series : all.series)
    if (!series.deviations.empty()) forget_certainty(series);
  return all;
}

}  // namespace abbe
