#include "report/image_difference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calibration/chart/delta_e.h"
#include "calibration/metrics/appearance.h"
#include "calibration/output/display.h"
#include "io/spectral_exr.h"
#include "io/text.h"
#include "sensor/film/crop.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/response/polarised_channels.h"
#include "spectral/colorimetry.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

void require_same_size(const Image& image, const Image& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw Error(ErrorCode::input, "",
                fmt::format("the images differ in size (got {} x {} and {} x {})", image.width, image.height,
                            reference.width, reference.height));
}

struct Pair {
  std::string channel;
  const std::vector<float>& image;
  const std::vector<float>& reference;
  const ImageChannel* variance;  // variance of the reference, or null
};

// Recorded unit of a channel. A film records it as an attribute; channels of a spectral film other than its
// bands are the preview. Empty if it is not recorded, and for bands, which all have one unit.
std::optional<std::string> unit_of(const Image& image, const std::string& channel) {
  if (parse_spectral_channel(channel, "image")) return std::nullopt;
  const auto recorded = image.metadata.find("channel." + channel);
  if (recorded != image.metadata.end()) return recorded->second;
  return is_spectral(image) ? std::optional<std::string>("preview, cd per m^2") : std::nullopt;
}

// Channels of a plane: the plane itself, or the channels of a mosaic.
std::vector<std::string> channels_in(const std::string& plane, const Image& image) {
  const auto mosaic = recorded_mosaic(image.metadata);
  return mosaic && plane == kRawPlane ? mosaic->channels : std::vector{plane};
}

std::vector<std::string> common_planes(const Image& image, const Image& reference) {
  std::vector<std::string> planes = intensities(plane_names(reference));
  std::erase_if(planes, [&](const std::string& plane) {
    return image.find(plane) == nullptr || reference.find(plane) == nullptr;
  });
  return planes;
}

// Appends the planes that only the first image has, without the alpha of pictures.
void append_planes_without(const Image& image, const Image& other, std::vector<std::string>& to) {
  for (const std::string& plane : intensities(plane_names(image)))
    if (plane != "A" && other.find(plane) == nullptr) to.push_back(plane);
}

void require_same_unit(const Image& image, const Image& reference, const std::string& plane) {
  for (const std::string& channel : channels_in(plane, reference)) {
    const auto a = unit_of(image, channel);
    const auto b = unit_of(reference, channel);
    if (a && b && *a != *b)
      throw Error(ErrorCode::input, "",
                  fmt::format("the images differ in the unit of channel {} (got \"{}\" and \"{}\")", channel,
                              *a, *b));
  }
}

std::vector<Pair> common_channels(const Image& image, const Image& reference) {
  require_same_size(image, reference);
  std::vector<Pair> pairs;
  for (const std::string& plane : common_planes(image, reference)) {
    require_same_unit(image, reference, plane);
    pairs.push_back({plane, image.find(plane)->values, reference.find(plane)->values,
                     reference.find(variance_of(plane))});
  }
  if (pairs.empty()) throw Error(ErrorCode::input, "", "the images have no channel in common");
  return pairs;
}

struct Means {
  double image = 0;
  double reference = 0;
};

// `sum` plus the values of a channel. Throws Error{input} with `image_name` if the result is not finite.
double checked_sum(double sum, const std::vector<float>& values, const char* image_name,
                   const std::string& channel) {
  sum = std::accumulate(values.begin(), values.end(), sum);
  if (!std::isfinite(sum))
    throw Error(ErrorCode::input, "",
                fmt::format("{} has a value that is not finite (in channel {})", image_name, channel));
  return sum;
}

Means means(const std::vector<Pair>& pairs) {
  Means sum;
  for (const Pair& pair : pairs) {
    sum.image = checked_sum(sum.image, pair.image, "the image", pair.channel);
    sum.reference = checked_sum(sum.reference, pair.reference, "the reference", pair.channel);
  }
  const double count = static_cast<double>(pairs.size() * pairs.front().reference.size());
  return {sum.image / count, sum.reference / count};
}

// Contribution of a value to the error: `quotient` orders the values for trimming, `added` enters the mean.
struct Term {
  double quotient;
  double added;
};

std::vector<Term> terms(const std::vector<Pair>& pairs, double mean, const ErrorMeasure& measure) {
  std::vector<Term> all;
  for (const Pair& pair : pairs) {
    if (measure.subtract_variance && pair.variance == nullptr)
      throw Error(ErrorCode::input, "", "a channel of the reference has no variance");
    for (std::size_t i = 0; i < pair.reference.size(); ++i) {
      const double r = pair.reference[i];
      const double d2 = std::pow(pair.image[i] - r, 2);
      const double v = measure.subtract_variance ? static_cast<double>(pair.variance->values[i]) : 0.0;
      if (!std::isfinite(v))
        throw Error(
            ErrorCode::input, "",
            fmt::format("the reference has a variance that is not finite (in channel {})", pair.channel));
      const double scale = measure.relative * r * r + measure.floor * mean * mean;
      all.push_back({d2 == 0 ? 0 : d2 / scale, d2 == v ? 0 : (d2 - v) / scale});
    }
  }
  return all;
}

std::vector<XYZ> tristimuli(const Image& image, const FilmColors& colors) {
  const ImageChannel* a = image.find(colors.channels[0]);
  const ImageChannel* b = image.find(colors.channels[1]);
  const ImageChannel* c = image.find(colors.channels[2]);
  if (!colors.to_xyz || a == nullptr || b == nullptr || c == nullptr) return {};
  std::vector<XYZ> pixels(image.pixels());
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = multiply(*colors.to_xyz, {a->values[i], b->values[i], c->values[i]});
  return pixels;
}

// Adapts colours to D65 from `white` instead of the film's own white.
void adapt(FilmColors& colors, const Chromaticity& white) {
  if (!colors.to_xyz) return;
  if (colors.adapted && !colors.white)
    throw Error(ErrorCode::input, "",
                "a camera film does not record the white from which its colours were adapted");
  if (colors.adapted) *colors.to_xyz = white_adaptation(*colors.white).inverse(true) * *colors.to_xyz;
  *colors.to_xyz = white_adaptation(white) * *colors.to_xyz;
}

// Tristimulus values of a colour relative to D65, for a white with this Y.
XYZ d65_xyz(const Lab& lab, double white) {
  XYZ xyz = lab_to_xyz(lab, unit_xyz(kD65));
  for (double& v : xyz) v *= white;
  return xyz;
}

const Appearance& booth() {
  static const Appearance appearance = [] {
    ViewingConditions conditions{unit_xyz(kD65)};
    for (double& v : conditions.white) v *= 100;
    return Appearance(AppearanceModel::cam16, conditions);
  }();
  return appearance;
}

// Colours of a film with sensor channels: the matrix that it records, in the order of the sensor's channels.
FilmColors colors_by_matrix(const Image& image, const std::vector<std::string>& wanted) {
  const auto white = recorded_white(image);
  const auto matrix = image.metadata.find("to_xyz_d65");
  const bool mosaic = image.metadata.contains("mosaic");
  const auto names = image.metadata.find(mosaic ? "mosaic_channels" : "sensor_channels");
  if (matrix == image.metadata.end() || names == image.metadata.end()) return {wanted, {}, false, white};
  const std::vector<std::string> channels = intensities(split(names->second, ','));
  if (!std::is_permutation(channels.begin(), channels.end(), wanted.begin(), wanted.end()))
    return {wanted, {}, false, white};
  return {channels, parse_matrix3(matrix->second), true, white};
}

struct MeanAndMax {
  double sum = 0;
  double max = 0;
  double count = 0;

  void add(double value) {
    sum += value;
    max = std::max(max, value);
    ++count;
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / count : 0; }
};

double between_planes(double a_deg, double b_deg) {
  const double difference = std::abs(a_deg - b_deg);
  return std::min(difference, 180 - difference);
}

}  // namespace

double percentile(std::vector<double> values, double quantile) {
  const double rank = std::ceil(quantile * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::optional<std::string> channel_with_undeclared_unit(const Image& image, const Image& reference) {
  for (const std::string& plane : common_planes(image, reference))
    for (const std::string& channel : channels_in(plane, reference))
      if (unit_of(image, channel).has_value() != unit_of(reference, channel).has_value()) return channel;
  return std::nullopt;
}

std::optional<std::string> uncompared_channels(const Image& image, const Image& reference) {
  std::vector<std::string> alone;
  append_planes_without(image, reference, alone);
  append_planes_without(reference, image, alone);
  if (alone.empty()) return std::nullopt;
  return fmt::format("channels that only one of the images has are not compared: {}", fmt::join(alone, ", "));
}

std::vector<XYZ> tristimuli(const Image& image) {
  return tristimuli(image, film_colors(image));
}

double delta_e(DeltaE formula, const Lab& standard, const Lab& sample) {
  const auto is_finite = [](double v) { return std::isfinite(v); };
  if (!std::ranges::all_of(standard, is_finite) || !std::ranges::all_of(sample, is_finite))
    return std::numeric_limits<double>::quiet_NaN();
  switch (formula) {
    case DeltaE::cie94:
      return delta_e_94(standard, sample);
    case DeltaE::cie76:
      return delta_e_76(standard, sample);
    case DeltaE::cam16_ucs:
      return distance_between(booth().uniform(d65_xyz(standard, 100)), booth().uniform(d65_xyz(sample, 100)));
    case DeltaE::itp:
      return delta_e_itp(itp(d65_xyz(standard, kReferenceWhite)), itp(d65_xyz(sample, kReferenceWhite)));
    case DeltaE::cie2000:
      break;
  }
  return delta_e_2000(standard, sample);
}

std::vector<double> relative_errors(const Image& image, const Image& reference) {
  const std::vector<Pair> pairs = common_channels(image, reference);
  const std::vector<Term> all = terms(pairs, means(pairs).reference, {});
  std::vector<double> errors(reference.pixels(), 0);
  for (std::size_t i = 0; i < all.size(); ++i)
    errors[i % errors.size()] += all[i].added / static_cast<double>(pairs.size());
  for (double& error : errors) error = std::sqrt(error);
  return errors;
}

double rel_mse(const Image& image, const Image& reference, const ErrorMeasure& measure) {
  const std::vector<Pair> pairs = common_channels(image, reference);
  std::vector<Term> all = terms(pairs, means(pairs).reference, measure);
  const auto trimmed_begin =
      all.end() - static_cast<std::ptrdiff_t>(measure.trim * static_cast<double>(all.size()));
  if (trimmed_begin != all.end()) std::ranges::nth_element(all, trimmed_begin, {}, &Term::quotient);
  const double sum = std::accumulate(all.begin(), trimmed_begin, 0.0,
                                     [](double total, const Term& t) { return total + t.added; });
  return sum / static_cast<double>(trimmed_begin - all.begin());
}

std::optional<ColorDifference> color_difference(const Image& image, const Image& reference, DeltaE formula,
                                                std::optional<Chromaticity> white) {
  FilmColors of_image = film_colors(image);
  FilmColors of_reference = film_colors(reference);
  const std::optional<Chromaticity> recorded = of_reference.white ? of_reference.white : of_image.white;
  for (FilmColors* colors : {&of_image, &of_reference})
    if (white || colors->white) adapt(*colors, white ? *white : *recorded);
  const std::vector<XYZ> x = tristimuli(image, of_image);
  const std::vector<XYZ> r = tristimuli(reference, of_reference);
  if (x.empty() || r.empty() || (image.find("X") == nullptr) != (reference.find("X") == nullptr))
    return std::nullopt;
  std::vector<double> luminance;
  for (const XYZ& xyz : r) luminance.push_back(xyz[1]);
  const double full = percentile(std::move(luminance), 0.99);
  if (!(full > 0)) return std::nullopt;
  const XYZ d65 = unit_xyz(kD65);
  const auto lab = [&](XYZ xyz) {
    for (double& v : xyz) v /= full;
    return xyz_to_lab(xyz, d65);
  };
  std::vector<double> differences;
  for (std::size_t i = 0; i < x.size(); ++i) differences.push_back(delta_e(formula, lab(r[i]), lab(x[i])));
  const double total = std::accumulate(differences.begin(), differences.end(), 0.0);
  const double largest = std::ranges::max(differences);
  const auto count = static_cast<double>(differences.size());
  const double p95 = percentile(differences, 0.95);
  return ColorDifference{total / count, p95, largest, std::move(differences)};
}

Comparison compare_images(const Image& image, const Image& reference, std::optional<Chromaticity> white) {
  const std::vector<Pair> pairs = common_channels(image, reference);
  const Means mean = means(pairs);
  double squares = 0;
  for (const Pair& pair : pairs)
    for (std::size_t i = 0; i < pair.reference.size(); ++i)
      squares += std::pow(static_cast<double>(pair.image[i]) - pair.reference[i], 2);
  const double count = static_cast<double>(pairs.size() * reference.pixels());
  return {rel_mse(image, reference), std::sqrt(squares / count), mean.image / mean.reference,
          color_difference(image, reference, DeltaE::cie2000, white)};
}

std::vector<Crop> common_areas(const Image& image, const Image& reference) {
  require_same_size(image, reference);
  const std::vector<Crop> a = recorded_areas(image);
  const std::vector<Crop> b = recorded_areas(reference);
  std::vector<Crop> both;
  for (const Crop& of_image : a)
    for (const Crop& of_reference : b)
      if (const auto common = common_pixels(of_image, of_reference)) both.push_back(*common);
  if (both.empty())
    throw Error(
        ErrorCode::input, "",
        fmt::format("the images have no pixel in common (got crops {} and {})", to_text(a), to_text(b)));
  return both;
}

Image extract_areas(const Image& image, std::span<const Crop> areas) {
  Image cut{areas.front().x1 - areas.front().x0, areas.front().y1 - areas.front().y0, {}, image.metadata};
  if (areas.size() > 1) {
    cut.height = 1;
    cut.width = 0;
    for (const Crop& area : areas) cut.width += static_cast<int>(pixel_count(area));
  }
  for (const char* key : {kCropKey, kAreasKey}) cut.metadata.erase(key);
  for (const ImageChannel& channel : image.channels) {
    std::vector<float>& values = cut.channels.emplace_back(ImageChannel{channel.name, {}}).values;
    values.reserve(cut.pixels());
    for (const Crop& area : areas)
      for (int y = area.y0; y < area.y1; ++y) {
        const auto row = channel.values.begin() + static_cast<std::ptrdiff_t>(y) * image.width;
        values.insert(values.end(), row + area.x0, row + area.x1);
      }
  }
  return cut;
}

FilmColors film_colors(const Image& image) {
  const std::vector<std::string> observer{"X", "Y", "Z"};
  const std::vector<std::string> rgb{"R", "G", "B"};
  const auto white = recorded_white(image);
  if (image.find("X") != nullptr && image.find("Y") != nullptr && image.find("Z") != nullptr) {
    if (!may_hold_tristimulus_values(image)) return colors_by_matrix(image, observer);
    return {observer, Matrix3(), false, white};
  }
  if (image.metadata.contains("channel.R")) return colors_by_matrix(image, rgb);
  const auto space = recorded_primaries(image);
  return {rgb, rgb_to_xyz(space.value_or(kRec709)), false,
          white || !space ? white : std::optional(space->white)};
}

std::optional<PolarisationDifference> polarisation_difference(const Image& image, const Image& reference) {
  const std::vector<StokesPlanes> own = stokes_planes(image);
  MeanAndMax degree;
  MeanAndMax angle_deg;
  double compared = 0;
  for (const StokesPlanes& planes : stokes_planes(reference)) {
    const auto same = std::ranges::find(own, planes.channel, &StokesPlanes::channel);
    if (same == own.end()) continue;
    for (std::size_t pixel = 0; pixel < reference.pixels(); ++pixel) {
      const PolarisationFigures x = polarisation_of(same->at(pixel));
      const PolarisationFigures r = polarisation_of(planes.at(pixel));
      if (r.degree > kPolarised) degree.add(std::abs(x.degree - r.degree));
      if (r.linear_degree > kPolarised) angle_deg.add(between_planes(x.angle_deg, r.angle_deg));
    }
    compared += static_cast<double>(reference.pixels());
  }
  if (!(compared > 0)) return std::nullopt;
  return PolarisationDifference{degree.count / compared, degree.mean(), degree.max, angle_deg.mean(),
                                angle_deg.max};
}

}  // namespace abbe
