#include "report/display_color.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "spectral/rgb.h"

namespace abbe {

LinearRgb linear_rgb_of_xyz(const XYZ& xyz) {
  static const Matrix3 from_xyz = rgb_to_xyz(kRec709).inverse();
  return multiply(from_xyz, xyz);
}

LinearRgb linear_rgb(const Lab& lab) {
  return linear_rgb_of_xyz(lab_to_xyz(lab, unit_xyz(kD65)));
}

DisplayColor display_code(const LinearRgb& linear) {
  DisplayColor color = linear;
  for (double& v : color) {
    v = std::clamp(v, 0.0, 1.0);
    v = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
  }
  return color;
}

std::string css_color(const DisplayColor& color) {
  const auto byte = [](double v) { return static_cast<int>(std::lround(255 * v)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color[0]), byte(color[1]), byte(color[2]));
}

}  // namespace abbe
