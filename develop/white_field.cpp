#include "develop/white_field.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calibration/chart/delta_e.h"
#include "io/text.h"
#include "spectral/colorimetry.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

constexpr double kVisible = 1;  // CIEDE2000

// Response of a channel at a distance in [0, 1] from the centre, interpolated linearly between rows.
double response(const WhiteField& field, std::size_t channel, double distance) {
  const auto last = static_cast<double>(field.relative.size() - 1);
  const double row = std::clamp(distance, 0.0, 1.0) * last;
  const auto low = static_cast<std::size_t>(std::min(std::floor(row), last - 1));
  const double fraction = row - static_cast<double>(low);
  return (1 - fraction) * field.relative[low][channel] + fraction * field.relative[low + 1][channel];
}

}  // namespace

std::string to_text(const WhiteField& field) {
  std::vector<std::string> rows;
  for (const std::vector<double>& row : field.relative)
    rows.push_back(fmt::format("{}", fmt::join(row, ",")));
  return fmt::format("{}", fmt::join(rows, ";"));
}

std::optional<WhiteField> parse_white_field(const std::string& text, std::size_t channels) {
  WhiteField field;
  for (const std::string& row : split(text, ';')) {
    std::vector<double>& values = field.relative.emplace_back();
    for (const std::string& word : split(row, ',')) {
      const auto number = parse_number(word);
      if (!number || !(*number > 0)) return std::nullopt;
      values.push_back(*number);
    }
    if (values.size() != channels) return std::nullopt;
  }
  return field.relative.size() < 2 ? std::nullopt : std::optional(std::move(field));
}

double neutral_shift(const WhiteField& field, const Matrix3& to_xyz_d65) {
  const XYZ white = unit_xyz(kD65);
  const std::array<double, 3> neutral = multiply(to_xyz_d65.inverse(true), white);
  double largest = 0;
  for (const std::vector<double>& row : field.relative) {
    std::array<double, 3> values = neutral;
    for (std::size_t k = 0; k < values.size(); ++k) values[k] *= row[k];
    XYZ xyz = multiply(to_xyz_d65, values);
    const double luminance = xyz[1];
    for (double& v : xyz) v /= luminance;
    largest = std::max(largest, delta_e_2000(xyz_to_lab(white, white), xyz_to_lab(xyz, white)));
  }
  return largest;
}

std::optional<std::string> field_tint_warning(double neutral_shift, const std::string& remedy) {
  if (!(neutral_shift > kVisible)) return std::nullopt;
  return fmt::format(
      "white is balanced for the centre of the field, and interference filters tint neutrals towards the "
      "corners by up to {:.2g} ΔE00: {}",
      neutral_shift, remedy);
}

void flatten(Image& planes, std::span<const std::string> channels, const WhiteField& field) {
  const double half_width = planes.width / 2.0;
  const double half_height = planes.height / 2.0;
  const double corner = std::hypot(half_width, half_height);
  for (std::size_t k = 0; k < channels.size(); ++k)
    for (ImageChannel& plane : planes.channels) {
      if (plane.name != channels[k]) continue;
      for (std::size_t i = 0; i < plane.values.size(); ++i) {
        const auto width = static_cast<std::size_t>(planes.width);
        const double x = static_cast<double>(i % width) + 0.5 - half_width;
        const double y = static_cast<double>(i / width) + 0.5 - half_height;
        plane.values[i] = static_cast<float>(static_cast<double>(plane.values[i]) /
                                             response(field, k, std::hypot(x, y) / corner));
      }
    }
}

std::vector<double> largest_response(const WhiteField& field) {
  std::vector<double> largest = field.relative.front();
  for (const std::vector<double>& row : field.relative)
    for (std::size_t k = 0; k < row.size(); ++k) largest[k] = std::max(largest[k], row[k]);
  return largest;
}

}  // namespace abbe
