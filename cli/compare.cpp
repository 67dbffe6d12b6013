#include "cli/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "calibration/chart/delta_e.h"
#include "calibration/output/color_spaces.h"
#include "cli/answer.h"
#include "io/exr.h"
#include "spectral/colorimetry.h"

namespace abbe::cli {
namespace {

struct Pair {
  const std::vector<float>& image;
  const std::vector<float>& reference;
};

std::vector<Pair> common_channels(const Image& image, const Image& reference) {
  std::vector<Pair> pairs;
  for (const ImageChannel& channel : reference.channels) {
    const ImageChannel* other = image.find(channel.name);
    if (other != nullptr && !channel.name.starts_with("Variance."))
      pairs.push_back({other->values, channel.values});
  }
  if (pairs.empty()) throw Error(ErrorCode::input, "", "the images have no channel in common");
  return pairs;
}

// The smallest value that at least a share `quantile` of `values` does not exceed.
double percentile(std::vector<double> values, double quantile) {
  const double rank = std::ceil(quantile * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// XYZ of every pixel, from X, Y, Z or linear sRGB; nothing for other images.
std::vector<XYZ> tristimuli(const Image& image) {
  const Matrix3 from_rgb = rgb_to_xyz(kRec709);
  for (const auto& names : {std::array{"X", "Y", "Z"}, std::array{"R", "G", "B"}}) {
    const ImageChannel* a = image.find(names[0]);
    const ImageChannel* b = image.find(names[1]);
    const ImageChannel* c = image.find(names[2]);
    if (a == nullptr || b == nullptr || c == nullptr) continue;
    std::vector<XYZ> pixels(image.pixels());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const XYZ value{a->values[i], b->values[i], c->values[i]};
      pixels[i] = *names[0] == 'X' ? value : multiply(from_rgb, value);
    }
    return pixels;
  }
  return {};
}

std::optional<ColorDifference> color_difference(const Image& image, const Image& reference) {
  const std::vector<XYZ> x = tristimuli(image);
  const std::vector<XYZ> r = tristimuli(reference);
  if (x.empty() || r.empty() || (image.find("X") == nullptr) != (reference.find("X") == nullptr))
    return std::nullopt;
  std::vector<double> luminance;
  for (const XYZ& xyz : r) luminance.push_back(xyz[1]);
  const double full = percentile(std::move(luminance), 0.99);
  if (!(full > 0)) return std::nullopt;
  const XYZ white = unit_xyz(kD65);
  const auto lab = [&](XYZ xyz) {
    for (double& v : xyz) v /= full;
    return xyz_to_lab(xyz, white);
  };
  std::vector<double> differences;
  for (std::size_t i = 0; i < x.size(); ++i) differences.push_back(delta_e_2000(lab(r[i]), lab(x[i])));
  const double total = std::accumulate(differences.begin(), differences.end(), 0.0);
  const double largest = *std::max_element(differences.begin(), differences.end());
  const auto count = static_cast<double>(differences.size());
  return ColorDifference{total / count, percentile(std::move(differences), 0.95), largest};
}

}  // namespace

Comparison compare_images(const Image& image, const Image& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw Error(ErrorCode::input, "",
                fmt::format("the images differ in size (got {} x {} and {} x {})", image.width, image.height,
                            reference.width, reference.height));
  const std::vector<Pair> pairs = common_channels(image, reference);
  const double count = static_cast<double>(pairs.size() * reference.pixels());
  double sum_x = 0;
  double sum_r = 0;
  for (const Pair& pair : pairs) {
    sum_x = std::accumulate(pair.image.begin(), pair.image.end(), sum_x);
    sum_r = std::accumulate(pair.reference.begin(), pair.reference.end(), sum_r);
  }
  if (!std::isfinite(sum_x) || !std::isfinite(sum_r))
    throw Error(ErrorCode::input, "", "an image has a value that is not finite");
  const double floor = 0.01 * std::pow(sum_r / count, 2);
  double squares = 0;
  double relative = 0;
  for (const Pair& pair : pairs)
    for (std::size_t i = 0; i < pair.reference.size(); ++i) {
      const double r = pair.reference[i];
      const double d2 = std::pow(pair.image[i] - r, 2);
      squares += d2;
      relative += d2 == 0 ? 0 : d2 / (r * r + floor);
    }
  return {relative / count, std::sqrt(squares / count), sum_x / sum_r, color_difference(image, reference)};
}

int compare(const CompareOptions& options) {
  const Image image = read_exr(options.image);
  const Comparison c = compare_images(image, read_exr(options.reference));
  Json answer;
  answer["relMSE"] = c.rel_mse;
  answer["rmse"] = c.rmse;
  answer["mean_ratio"] = c.mean_ratio;
  answer["dE00_mean"] = c.color ? Json(c.color->mean) : Json();
  answer["dE00_p95"] = c.color ? Json(c.color->p95) : Json();
  answer["dE00_max"] = c.color ? Json(c.color->max) : Json();
  print(answer, options.json);
  return 0;
}

}  // namespace abbe::cli
