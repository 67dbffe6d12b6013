#include "calibration/metrics/itp.h"

#include <algorithm>
#include <cmath>

#include "calibration/metrics/appearance.h"
#include "calibration/output/color_spaces.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

// Code value in [0, 1] of a luminance [cd/m^2]: the inverse of the perceptual quantiser's transfer function
// [BT2100, table 4].
double quantised(double luminance) {
  constexpr double kM1 = 2610.0 / 16384;
  constexpr double kM2 = 2523.0 / 4096 * 128;
  constexpr double kC1 = 3424.0 / 4096;
  constexpr double kC2 = 2413.0 / 4096 * 32;
  constexpr double kC3 = 2392.0 / 4096 * 32;
  const double y = std::pow(std::max(luminance, 0.0) / 10000, kM1);
  return std::pow((kC1 + kC2 * y) / (1 + kC3 * y), kM2);
}

}  // namespace

// L, M, S of Rec.2020 primaries are encoded with the perceptual quantiser's curve, without any rounding. Then
// I = (L + M)/2, T = C_T/2 and P = C_P.
std::array<double, 3> itp(const XYZ& absolute) {
  static const Matrix3 from_xyz = rgb_to_xyz(kRec2020).inverse(true);
  static const Matrix3 to_lms = Matrix3(1688, 2146, 262, 683, 2951, 462, 99, 309, 3688) * (1 / 4096.0);
  std::array<double, 3> lms = multiply(to_lms, multiply(from_xyz, absolute));
  for (double& v : lms) v = quantised(v);
  const auto& [l, m, s] = lms;
  const double intensity = (l + m) / 2;
  const double ct = (6610 * l - 13613 * m + 7003 * s) / 4096;
  const double cp = (17933 * l - 17390 * m - 543 * s) / 4096;
  return {intensity, ct / 2, cp};
}

double delta_e_itp(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return 720 * distance_between(a, b);
}

}  // namespace abbe
