#include "calibration/output/dng_profile.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "calibration/output/color_spaces.h"
#include "spectral/color_temperature.h"

namespace abbe {
namespace {

int exif_code(const std::string& light) {
  constexpr int kOther = 255;
  constexpr std::array<std::pair<std::string_view, int>, 7> kCodes{
      {{"A", 17}, {"B", 18}, {"C", 19}, {"D55", 20}, {"D65", 21}, {"D75", 22}, {"D50", 23}}};
  for (const auto& [name, code] : kCodes)
    if (name == light) return code;
  return kOther;
}

}  // namespace

std::optional<DngLight> dng_light(const CameraProfile& profile, const XYZ& white) {
  const auto temperature = color_temperature(white);
  const auto to_d50 = adaptation(white, dng_white());
  if (profile.correction.model != CorrectionModel::linear || !temperature || !to_d50) return std::nullopt;
  const Matrix3 balanced_to_xyz = linear_part(profile.correction);
  Matrix3 color = (balanced_to_xyz * diagonal(profile.gains)).inverse(true);
  const std::array<double, 3> camera_white = multiply(color, white);
  color *= 1 / *std::max_element(camera_white.begin(), camera_white.end());
  return DngLight{profile.light, exif_code(profile.light), temperature->kelvin, color,
                  *to_d50 * balanced_to_xyz};
}

Matrix3 forward_between(const DngLight& first, const DngLight& second, double kelvin) {
  const double span = 1 / first.kelvin - 1 / second.kelvin;
  const double share = span == 0 ? 1 : std::clamp((1 / kelvin - 1 / second.kelvin) / span, 0.0, 1.0);
  return first.forward * share + second.forward * (1 - share);
}

}  // namespace abbe
