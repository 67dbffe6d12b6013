#include "calibration/output/dng_profile.h"

#include <algorithm>
#include <array>

#include "calibration/output/color_spaces.h"
#include "calibration/output/exif_light.h"
#include "io/image.h"
#include "spectral/color_temperature.h"

namespace abbe {

// ColorMatrix is the scaled inverse of `to_xyz`. ForwardMatrix undoes the balance, applies `to_xyz` and
// adapts the white to D50.
std::optional<DngMatrices> dng_matrices(const Matrix3& to_xyz, const XYZ& white) {
  const auto to_d50 = adaptation(white, dng_white());
  if (!to_d50 || !is_invertible(to_xyz)) return std::nullopt;
  Matrix3 color = to_xyz.inverse(true);
  const std::array<double, 3> camera_white = multiply(color, white);
  const auto [lowest, highest] = std::minmax_element(camera_white.begin(), camera_white.end());
  if (*lowest <= 0) return std::nullopt;
  color *= 1 / *highest;
  return DngMatrices{color, *to_d50 * to_xyz * diagonal(camera_white), multiply(color, white)};
}

std::optional<DngLight> dng_light(const CameraProfile& profile, const XYZ& white) {
  const auto temperature = color_temperature(white);
  if (profile.correction.model != CorrectionModel::linear || !temperature) return std::nullopt;
  const auto matrices = dng_matrices(linear_part(profile.correction) * diagonal(profile.gains), white);
  if (!matrices) return std::nullopt;
  return DngLight{profile.light, exif_light_source(profile.light), temperature->kelvin, matrices->color,
                  matrices->forward};
}

RawLight light_for(std::span<const std::string> channels, const RawLight& light) {
  RawLight ordered = light;
  const auto order = rgb_order(channels);
  for (std::size_t k = 0; order && k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      ordered.color[3 * (*order)[k] + i] = light.color[3 * k + i];
      ordered.forward[3 * i + (*order)[k]] = light.forward[3 * i + k];
    }
  return ordered;
}

// The weight of the first matrix is (1/T - 1/T_2)/(1/T_1 - 1/T_2).
Matrix3 forward_between(const DngLight& first, const DngLight& second, double kelvin) {
  const double span = 1 / first.kelvin - 1 / second.kelvin;
  const double weight = span == 0 ? 1 : std::clamp((1 / kelvin - 1 / second.kelvin) / span, 0.0, 1.0);
  return first.forward * weight + second.forward * (1 - weight);
}

}  // namespace abbe
