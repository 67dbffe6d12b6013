#include "validation/goniometer/lobe_plot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "report/display_color.h"
#include "report/svg.h"
#include "sampling/angle.h"

namespace abbe {
namespace {

constexpr double kPanel = 220;  // edge of a panel [pixels]
constexpr double kRadius = 92;
constexpr double kPanelTop = 40;
constexpr double kSwatch = 24;

// Colour of a line: that of its wavelength, within the display's gamut.
std::string line_color(double nm, Observer observer) {
  const ColorMatching& eye = color_matching(observer);
  LinearRgb linear = linear_rgb_of_xyz({eye.x(nm), eye.y(nm), eye.z(nm)});
  const double max_value = std::max({linear[0], linear[1], linear[2]});
  if (!(max_value > 0.02)) return "#555555";  // invisible wavelength
  for (double& v : linear) v /= max_value;
  return css_color(display_code(linear));
}

// Values of f cos around the plane of incidence, by wavelength.
struct Slice {
  static constexpr int kSteps = 720;
  std::vector<std::vector<double>> values;
  double max_value = 0;
};
Slice slice(const Material& material, const GoniometerSettings& settings, const Imath::V3f& wo) {
  Slice all;
  for (std::size_t i = 0; i < settings.wavelengths_nm.size(); ++i) {
    const SampledSpectrum packet = packet_of(settings.wavelengths_nm, i);
    const Bsdf bsdf = make_bsdf(material, {packet});
    std::vector<double>& line = all.values.emplace_back();
    for (int step = 0; step < Slice::kSteps; ++step) {
      const double angle = 360 * kDegree * (step + 0.5) / Slice::kSteps;
      const Imath::V3f wi = direction_at(std::cos(angle), angle < 180 * kDegree ? 0 : std::numbers::pi);
      line.push_back(static_cast<double>(eval(bsdf, wo, wi, TransportMode::power)[0] * std::abs(wi.z)));
      all.max_value = std::max(all.max_value, line.back());
    }
  }
  return all;
}

std::string lobe(const std::vector<double>& line, double max_value, double x, double y,
                 const std::string& color) {
  SvgPoints points;
  for (std::size_t step = 0; step < line.size(); ++step) {
    const double angle = 360 * kDegree * (static_cast<double>(step) + 0.5) / static_cast<double>(line.size());
    const double radius = kRadius * std::sqrt(line[step] / max_value);
    points.emplace_back(x + radius * std::sin(angle), y - radius * std::cos(angle));
  }
  return svg_polygon(points, fmt::format("stroke=\"{}\" stroke-width=\"1.5\"", color));
}

// Arrows for the delta events of the first wavelength; the length is the square root of the fraction of
// power.
std::string arrows(const Material& material, const GoniometerSettings& settings, const Imath::V3f& wo,
                   double x, double y) {
  const SampledSpectrum packet = packet_of(settings.wavelengths_nm, 0);
  std::string all;
  for (const BsdfSample& event : delta_events(make_bsdf(material, {packet}), wo, 0, TransportMode::power)) {
    const double length = kRadius * std::sqrt(static_cast<double>(event.pdf * event.weight[0]));
    all += svg_line(x, y, x + length * static_cast<double>(event.wi.x),
                    y - length * static_cast<double>(event.wi.z), "stroke=\"#333333\" stroke-width=\"2.5\"");
  }
  return all;
}

std::string panel(const Material& material, const GoniometerSettings& settings, const GoniometerAngle& at,
                  double left) {
  const double x = left + kPanel / 2;
  const double y = kPanelTop + kPanel / 2;
  const Imath::V3f wo = incidence(settings, at.angle_deg);
  std::string all = svg_circle(x, y, kRadius, "fill=\"none\" stroke=\"#dddddd\"");
  all += svg_line(x - kRadius, y, x + kRadius, y, "stroke=\"#888888\"");
  all +=
      svg_line(x + (kRadius + 12) * static_cast<double>(wo.x), y - (kRadius + 12) * static_cast<double>(wo.z),
               x, y, "stroke=\"#bbbbbb\" stroke-dasharray=\"4 3\"");
  const Slice lines = slice(material, settings, wo);
  if (lines.max_value > 0)
    for (std::size_t i = 0; i < lines.values.size(); ++i)
      all += lobe(lines.values[i], lines.max_value, x, y,
                  line_color(settings.wavelengths_nm[i], settings.observer));
  all += arrows(material, settings, wo, x, y);
  const double bottom = kPanelTop + kPanel;
  all += svg_rect(x - kSwatch, bottom, 2 * kSwatch, kSwatch,
                  fmt::format("fill=\"{}\" stroke=\"#888888\"",
                              css_color(display_code(linear_rgb(at.reflected_color.lab)))));
  const std::string centered = "text-anchor=\"middle\"";
  all += svg_text(x, kPanelTop, fmt::format("{:g}\u00b0", at.angle_deg), centered);
  return all + svg_text(x, bottom + kSwatch + 16,
                        lines.max_value > 0 ? fmt::format("largest f cos {:.3g}/sr", lines.max_value) : "",
                        centered);
}

}  // namespace

std::string lobe_plot(const Material& material, const GoniometerSettings& settings,
                      const GoniometerReport& report, const std::string& title) {
  const double width = kPanel * static_cast<double>(report.angles.size());
  const double height = kPanelTop + kPanel + kSwatch + 50;
  std::string all;
  double legend = 10;
  for (const double nm : settings.wavelengths_nm) {
    all += svg_line(legend, height - 14, legend + 20, height - 14,
                    fmt::format("stroke=\"{}\" stroke-width=\"2\"", line_color(nm, settings.observer)));
    all += svg_text(legend + 24, height - 10, fmt::format("{:g} nm", nm), "");
    legend += 90;
  }
  for (std::size_t i = 0; i < report.angles.size(); ++i)
    all += panel(material, settings, report.angles[i], kPanel * static_cast<double>(i));
  return svg_document(width, height, title, all);
}

}  // namespace abbe
