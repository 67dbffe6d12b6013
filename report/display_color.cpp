#include "report/display_color.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "sampling/angle.h"
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

namespace {

constexpr std::size_t kSteps = 256;

LinearRgb linear_rgb_of(double lightness, double chroma, double hue) {
  return linear_rgb({lightness, chroma * std::cos(hue), chroma * std::sin(hue)});
}

bool displayable(const LinearRgb& rgb) {
  return std::all_of(rgb.begin(), rgb.end(), [](double v) { return v >= 0 && v <= 1; });
}

// Largest chroma of the sRGB gamut at a lightness and hue, by bisection.
double gamut_chroma(double lightness, double hue) {
  double low = 0;
  double high = 200;
  for (int i = 0; i < 40; ++i) {
    const double midpoint = (low + high) / 2;
    (displayable(linear_rgb_of(lightness, midpoint, hue)) ? low : high) = midpoint;
  }
  return low;
}

DisplayColor computed_color(double t) {
  constexpr double kFirstHue = -75 * kDegree;  // blue; hue passes red at 30 degrees
  constexpr double kLastHue = 95 * kDegree;
  constexpr double kGamutFraction = 0.9;
  constexpr double kMaxMapChroma = 70;
  const double lightness = 12 + 80 * t;
  const double hue = kFirstHue + (kLastHue - kFirstHue) * t;
  const double chroma = std::min(kMaxMapChroma, kGamutFraction * gamut_chroma(lightness, hue));
  return display_code(linear_rgb_of(lightness, chroma, hue));
}

}  // namespace

DisplayColor map_color(double t) {
  static const std::vector<DisplayColor> colors = [] {
    std::vector<DisplayColor> all;
    for (std::size_t i = 0; i < kSteps; ++i)
      all.push_back(computed_color(static_cast<double>(i) / (kSteps - 1)));
    return all;
  }();
  return colors[static_cast<std::size_t>(std::lround(std::clamp(t, 0.0, 1.0) * (kSteps - 1)))];
}

DisplayColor cyclic_color(double turn, double strength) {
  constexpr double kLightness = 65;
  constexpr double kRed = 30 * kDegree;
  static const double kMaxChroma = [] {
    double min_chroma = std::numeric_limits<double>::infinity();
    for (int degree = 0; degree < 360; ++degree)
      min_chroma = std::min(min_chroma, gamut_chroma(kLightness, degree * kDegree));
    return min_chroma;
  }();
  const double chroma = kMaxChroma * std::clamp(strength, 0.0, 1.0);
  return display_code(linear_rgb_of(kLightness, chroma, kRed + 2 * std::numbers::pi * turn));
}

Image false_color(std::span<const double> values, int width, int height, double low, double high) {
  constexpr DisplayColor kMissing{0.5, 0.5, 0.5};
  Image image{width, height, {{"R", {}}, {"G", {}}, {"B", {}}}, {}};
  for (const double value : values) {
    const double t = high > low ? (value - low) / (high - low) : 0;
    const DisplayColor color = std::isfinite(t) ? map_color(t) : kMissing;
    for (std::size_t c = 0; c < 3; ++c) image.channels[c].values.push_back(static_cast<float>(color[c]));
  }
  return image;
}

}  // namespace abbe
