#include "calibration/output/gamut.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibration/output/color_spaces.h"

namespace abbe {
namespace {

constexpr double kRounding = 1e-5;  // relative error of single precision for a colour on the border

}  // namespace

Gamut::Gamut(const RgbSpace& space, double highest)
    : to_xyz_d65(rgb_to_xyz_d65(space)), from_xyz_d65(to_xyz_d65.inverse(true)), top(highest) {
  const Matrix3 own = rgb_to_xyz(space);
  luminance = {own[1][0], own[1][1], own[1][2]};
}

MappedColor map_into(const Gamut& gamut, const std::array<double, 3>& rgb) {
  const auto [low, high] = std::minmax_element(rgb.begin(), rgb.end());
  if (!std::all_of(rgb.begin(), rgb.end(), [](double v) { return std::isfinite(v); }))
    return {{0, 0, 0}, false, true};
  MappedColor mapped{rgb, *low < -kRounding * std::max(*high, -*low), false};
  const double grey = std::max(0.0, std::inner_product(rgb.begin(), rgb.end(), gamut.luminance.begin(), 0.0));
  // Fraction of the distance from grey to the colour at which all primaries stay above zero.
  const double retained = *low < 0 ? grey / (grey - *low) : 1;
  const double brightest = grey + retained * (*high - grey);
  mapped.too_bright = brightest > gamut.top * (1 + kRounding);
  const double dimming = brightest > gamut.top ? gamut.top / brightest : 1;
  for (double& v : mapped.rgb) v = std::max(0.0, dimming * (grey + retained * (v - grey)));
  return mapped;
}

}  // namespace abbe
