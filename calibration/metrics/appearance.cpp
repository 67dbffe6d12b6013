#include "calibration/metrics/appearance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calibration/output/color_spaces.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSurround = 0.69;         // c
constexpr double kChromaticInduction = 1;  // N_c
constexpr double kFullAdaptation = 1;      // F
constexpr double kColorfulness = 0.0228;   // c_2 of the uniform space
constexpr double kLightness = 0.007;       // c_1

// Matrix from XYZ to the cones of Hunt, Pointer and Estevez, on which the compression of CIECAM02 acts.
const Matrix3& hunt_cones() {
  static const Matrix3 cones(0.38971, 0.68898, -0.07868, -0.22981, 1.18340, 0.04641, 0, 0, 1);
  return cones;
}

Matrix3 adapting_cones(AppearanceModel model) {
  return cone_responses(model == AppearanceModel::cam16 ? Adaptation::cat16 : Adaptation::cat02);
}

// D = F (1 - exp(-(L_A + 42)/92)/3.6), limited to [0, 1]; 1 for complete adaptation.
double degree_of_adaptation(const ViewingConditions& conditions) {
  if (conditions.complete) return 1;
  const double d = kFullAdaptation * (1 - std::exp(-(conditions.adapting_luminance + 42) / 92) / 3.6);
  return std::clamp(d, 0.0, 1.0);
}

// F_L = 0.2 k^4 (5 L_A) + 0.1 (1 - k^4)^2 (5 L_A)^(1/3) with k = 1/(5 L_A + 1).
double luminance_adaptation(double adapting_luminance) {
  const double k = 1 / (5 * adapting_luminance + 1);
  const double k4 = k * k * k * k;
  return 0.2 * k4 * 5 * adapting_luminance + 0.1 * (1 - k4) * (1 - k4) * std::cbrt(5 * adapting_luminance);
}

// Achromatic response of compressed cones, 2 R' + G' + B'/20 - 0.305.
double achromatic(const std::array<double, 3>& cones) {
  return 2 * cones[0] + cones[1] + cones[2] / 20 - 0.305;
}

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

Appearance::Appearance(AppearanceModel model, const ViewingConditions& conditions)
    : adaptation_(luminance_adaptation(conditions.adapting_luminance)),
      background_(conditions.background / conditions.white[1]),
      induction_(0.725 * std::pow(1 / background_, 0.2)),
      exponent_(1.48 + std::sqrt(background_)) {
  const Matrix3 cones = adapting_cones(model);
  const std::array<double, 3> white = multiply(cones, conditions.white);
  const double d = degree_of_adaptation(conditions);
  std::array<double, 3> gain{};
  for (std::size_t i = 0; i < 3; ++i) gain[i] = d * conditions.white[1] / white[i] + 1 - d;
  to_adapted_ = diagonal(gain) * cones;
  if (model == AppearanceModel::ciecam02) to_adapted_ = hunt_cones() * cones.inverse(true) * to_adapted_;
  white_response_ = achromatic(compressed(conditions.white)) * induction_;
}

// Post-adaptation responses R'a = 400 x/(x + 27.13) + 0.1 with x = (F_L |R'|/100)^0.42; the first term has
// the sign of R'.
std::array<double, 3> Appearance::compressed(const XYZ& xyz) const {
  std::array<double, 3> cones = multiply(to_adapted_, xyz);
  for (double& cone : cones) {
    const double x = std::pow(adaptation_ * std::abs(cone) / 100, 0.42);
    cone = std::copysign(400 * x / (x + 27.13), cone) + 0.1;
  }
  return cones;
}

// J = 100 (A/A_w)^(c z), C = t^0.9 (J/100)^(1/2) (1.64 - 0.29^n)^0.73 and M = C F_L^(1/4). The achromatic
// response is A, the eccentricity e_t, and t = (50000/13) N_c N_cb e_t (a^2 + b^2)^(1/2)/(R'a + G'a + 21
// B'a/20).
ColorAppearance Appearance::operator()(const XYZ& xyz) const {
  const std::array<double, 3> cones = compressed(xyz);
  const auto& [r, g, b] = cones;
  const double red_green = r - 12 * g / 11 + b / 11;
  const double yellow_blue = (r + g - 2 * b) / 9;
  const double hue = std::atan2(yellow_blue, red_green);
  const double eccentricity = (std::cos(hue + 2) + 3.8) / 4;
  const double response = std::max(0.0, achromatic(cones) * induction_ / white_response_);
  const double lightness = 100 * std::pow(response, kSurround * exponent_);
  const double t = 50000.0 / 13 * kChromaticInduction * induction_ * eccentricity *
                   std::hypot(red_green, yellow_blue) / (r + g + 21 * b / 20);
  const double chroma = std::pow(std::max(t, 0.0), 0.9) * std::sqrt(lightness / 100) *
                        std::pow(1.64 - std::pow(0.29, background_), 0.73);
  const double degrees = hue / kDegree;
  return {lightness, chroma, chroma * std::pow(adaptation_, 0.25), degrees < 0 ? degrees + 360 : degrees};
}

std::array<double, 3> Appearance::uniform(const XYZ& xyz) const {
  const ColorAppearance correlates = (*this)(xyz);
  const double lightness =
      (1 + 100 * kLightness) * correlates.lightness / (1 + kLightness * correlates.lightness);
  const double colorfulness = std::log1p(kColorfulness * correlates.colorfulness) / kColorfulness;
  return {lightness, colorfulness * std::cos(correlates.hue_deg * kDegree),
          colorfulness * std::sin(correlates.hue_deg * kDegree)};
}

double distance_between(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

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
