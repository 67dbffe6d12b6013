#include "calibration/output/color_spaces.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace abbe {
namespace {

constexpr double kGamutRounding = 1e-5;  // relative error of single precision for a colour on the border

}  // namespace

Matrix3 cone_responses(Adaptation method) {
  switch (method) {
    case Adaptation::bradford:
      break;
    case Adaptation::cat02:
      return {0.7328, 0.4296, -0.1624, -0.7036, 1.6975, 0.0061, 0.0030, 0.0136, 0.9834};
    case Adaptation::cat16:
      return {0.401288, 0.650173, -0.051461, -0.250268, 1.204414, 0.045854, -0.002079, 0.048952, 0.953127};
  }
  return {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
}

std::optional<Matrix3> adaptation(const XYZ& from_white, const XYZ& to_white, Adaptation method) {
  const Matrix3 cones = cone_responses(method);
  const std::array<double, 3> from = multiply(cones, from_white);
  const std::array<double, 3> to = multiply(cones, to_white);
  std::array<double, 3> gain{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(from[i] > 0 && to[i] > 0)) return std::nullopt;
    gain[i] = to[i] / from[i];
  }
  return cones.inverse(true) * diagonal(gain) * cones;
}

bool is_same_white(const Chromaticity& a, const Chromaticity& b) {
  constexpr double kRounded = 5e-4;
  return std::hypot(a[0] - b[0], a[1] - b[1]) < kRounded;
}

Matrix3 rgb_to_xyz_d65(const RgbSpace& space) {
  return adaptation(unit_xyz(space.white), unit_xyz(kD65)).value() * rgb_to_xyz(space);
}

Gamut::Gamut(const RgbSpace& space, double highest)
    : to_xyz_d65(rgb_to_xyz_d65(space)), from_xyz_d65(to_xyz_d65.inverse(true)), top(highest) {
  const Matrix3 own = rgb_to_xyz(space);
  luminance = {own[1][0], own[1][1], own[1][2]};
}

MappedColor map_into(const Gamut& gamut, const std::array<double, 3>& rgb) {
  const auto [low, high] = std::minmax_element(rgb.begin(), rgb.end());
  if (!std::all_of(rgb.begin(), rgb.end(), [](double v) { return std::isfinite(v); }))
    return {{0, 0, 0}, false, true};
  MappedColor mapped{rgb, *low < -kGamutRounding * std::max(*high, -*low), false};
  const double grey = std::max(0.0, std::inner_product(rgb.begin(), rgb.end(), gamut.luminance.begin(), 0.0));
  // Fraction of the distance from grey to the colour at which all primaries stay above zero.
  const double retained = *low < 0 ? grey / (grey - *low) : 1;
  const double brightest = grey + retained * (*high - grey);
  mapped.too_bright = brightest > gamut.top * (1 + kGamutRounding);
  const double dimming = brightest > gamut.top ? gamut.top / brightest : 1;
  for (double& v : mapped.rgb) v = std::max(0.0, dimming * (grey + retained * (v - grey)));
  return mapped;
}

}  // namespace abbe
