#include "report/color_vector.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "report/svg.h"

namespace abbe {
namespace {

constexpr double kSize = 460;
constexpr double kGraphicTop = 40;  // below the title
constexpr double kCenterX = kSize / 2;
constexpr double kCenterY = kGraphicTop + kSize / 2;
constexpr double kCircleRadius = 150;  // radius of the reference's circle
constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr std::size_t kBins = ColorFidelity::kBins;

using Point = std::pair<double, double>;

// Position of a colour whose chroma is relative to the reference's.
Point placed(double relative_chroma, double hue) {
  return {kCenterX + kCircleRadius * relative_chroma * std::cos(hue),
          kCenterY - kCircleRadius * relative_chroma * std::sin(hue)};
}

double bin_center(std::size_t bin) {
  return (static_cast<double>(bin) + 0.5) * kFullTurn / kBins;
}

// The reference's mean is drawn on the circle at the center of its bin. The light's mean is shifted from
// there.
Point shifted(const HueBin& bin, std::size_t k) {
  const double hue = bin_center(k);
  const double a =
      std::cos(hue) + (bin.test[0] - bin.reference[0]) / std::hypot(bin.reference[0], bin.reference[1]);
  const double b =
      std::sin(hue) + (bin.test[1] - bin.reference[1]) / std::hypot(bin.reference[0], bin.reference[1]);
  return {kCenterX + kCircleRadius * a, kCenterY - kCircleRadius * b};
}

std::string hue_color(std::size_t bin) {
  return fmt::format("hsl({:.1f}, 65%, 45%)", bin_center(bin) * 360 / kFullTurn);
}

std::string arrow(const Point& from, const Point& to, const std::string& color) {
  constexpr double kHead = 9;
  const double dx = to.first - from.first;
  const double dy = to.second - from.second;
  const double length = std::hypot(dx, dy);
  std::string text = svg_line(from.first, from.second, to.first, to.second,
                              fmt::format("stroke=\"{}\" stroke-width=\"3\"", color));
  if (length < kHead) return text;
  const double x = kHead * dx / length;
  const double y = kHead * dy / length;
  return text + svg_polygon({{to.first + x / 3, to.second + y / 3},
                             {to.first - x - y / 2, to.second - y + x / 2},
                             {to.first - x + y / 2, to.second - y - x / 2}},
                            fmt::format("style=\"fill: {}\"", color));
}

// Circles of 80 to 120 % of the chroma, and the borders of the bins.
std::string grid() {
  std::string text;
  for (const int percent : {80, 90, 100, 110, 120})
    text += svg_circle(kCenterX, kCenterY, kCircleRadius * percent / 100,
                       percent == 100 ? "fill=\"none\" stroke=\"#333\" stroke-width=\"2\""
                                      : "fill=\"none\" stroke=\"#ccc\"");
  for (std::size_t k = 0; k < kBins; ++k) {
    const double border = static_cast<double>(k) * kFullTurn / kBins;
    const auto [x0, y0] = placed(0.05, border);
    const auto [x1, y1] = placed(1.3, border);
    text += svg_line(x0, y0, x1, y1, "stroke=\"#ddd\" stroke-dasharray=\"4 3\"");
    const auto [x, y] = placed(1.38, bin_center(k));
    text +=
        svg_text(x, y + 4, std::to_string(k + 1), "font-size=\"12\" fill=\"#666\" text-anchor=\"middle\"");
  }
  return text;
}

}  // namespace

std::string color_vector_graphic(const ColorFidelity& fidelity, const std::string& title) {
  SvgPoints outline;
  std::string arrows;
  for (std::size_t k = 0; k < kBins; ++k) {
    if (!fidelity.bins[k].has_samples()) continue;
    outline.push_back(shifted(fidelity.bins[k], k));
    arrows += arrow(placed(1, bin_center(k)), outline.back(), hue_color(k));
  }
  std::string elements = grid() + svg_polygon(outline, "stroke=\"#c22\" stroke-width=\"2\"") + arrows;
  const auto corner = [](double x, const char* anchor, const std::string& text) {
    return svg_text(x, kGraphicTop + 24, text, fmt::format("font-size=\"18\" text-anchor=\"{}\"", anchor));
  };
  elements += corner(12, "start", fmt::format("Rf {:.0f}", fidelity.fidelity));
  elements += corner(kSize - 12, "end",
                     std::isnan(fidelity.gamut) ? "Rg -" : fmt::format("Rg {:.0f}", fidelity.gamut));
  return svg_document(kSize, kGraphicTop + kSize, title, elements);
}

}  // namespace abbe
