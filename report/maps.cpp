#include "report/maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "report/display_color.h"
#include "report/plot.h"

namespace abbe {
namespace {

constexpr int kBars = 64;
constexpr int kHueWidth = 8;
constexpr int kBarsMargin = 36;
constexpr int kBarsTop = 12;
constexpr int kBarsHeight = 200;
constexpr int kScaleHeight = 40;
constexpr int kPictureWidth = kBars * kHueWidth + 2 * kBarsMargin;
constexpr int kPictureHeight = kBarsTop + kBarsHeight + kScaleHeight;

// A white picture to draw on.
class Canvas {
 public:
  Canvas() {
    for (const char* name : {"R", "G", "B"})
      image_.channels.push_back({name, std::vector<float>(image_.pixels(), 1.0F)});
  }
  void fill(int x0, int y0, int x1, int y1, const DisplayColor& color) {
    for (int y = std::max(y0, 0); y < std::min(y1, kPictureHeight); ++y)
      for (int x = std::max(x0, 0); x < std::min(x1, kPictureWidth); ++x)
        for (std::size_t c = 0; c < 3; ++c)
          image_.channels[c].values[static_cast<std::size_t>(y * kPictureWidth + x)] =
              static_cast<float>(color[c]);
  }
  [[nodiscard]] Image take() { return std::move(image_); }

 private:
  Image image_{kPictureWidth, kPictureHeight, {}, {}};
};

constexpr DisplayColor kInk{0.12, 0.15, 0.2};
constexpr int kStroke = 2;
constexpr int kDigitWidth = 6 * kStroke;  // includes the space after it

// Draws a digit of seven segments, 4 strokes wide and 7 high, or a decimal point.
void draw_digit(Canvas& canvas, char digit, int x, int y) {
  struct Segment {
    int x0, y0, x1, y1;
    const char* digits;  // digits that contain the segment
  };
  constexpr std::array<Segment, 8> kSegments{{{0, 0, 4, 1, "02356789"},
                                              {0, 3, 4, 4, "2345689"},
                                              {0, 6, 4, 7, "0235689"},
                                              {0, 0, 1, 4, "045689"},
                                              {3, 0, 4, 4, "01234789"},
                                              {0, 3, 1, 7, "0268"},
                                              {3, 3, 4, 7, "013456789"},
                                              {1, 6, 2, 7, "."}}};
  for (const Segment& s : kSegments)
    if (std::string_view(s.digits).find(digit) != std::string_view::npos)
      canvas.fill(x + s.x0 * kStroke, y + s.y0 * kStroke, x + s.x1 * kStroke, y + s.y1 * kStroke, kInk);
}

void draw_number(Canvas& canvas, double value, int center_x, int y) {
  const std::string text = fmt::format("{:.6g}", value);
  int x = center_x - static_cast<int>(text.size()) * kDigitWidth / 2;
  for (const char digit : text) {
    draw_digit(canvas, digit, x, y);
    x += kDigitWidth;
  }
}

// End of a scale that covers 99 % of the values.
double scale_end(const std::vector<double>& values) {
  const double max_value = percentile(values, 0.99);
  return max_value > 0 ? std::clamp(log_range({max_value}).second, 1e-3, 1e5) : 1.0;
}

DifferenceMap map_of(const std::string& name, const std::vector<double>& values, int width, int height) {
  const double high = scale_end(values);
  return {name, high, false_color(values, width, height, 0, high), histogram_picture(values, high)};
}

Image degrees(const std::vector<PolarisationFigures>& pixels, double PolarisationFigures::*degree, int width,
              int height) {
  std::vector<double> values;
  values.reserve(pixels.size());
  for (const PolarisationFigures& pixel : pixels) values.push_back(pixel.*degree);
  return false_color(values, width, height, 0, 1);
}

Image angles(const std::vector<PolarisationFigures>& pixels, int width, int height) {
  Image image{width, height, {{"R", {}}, {"G", {}}, {"B", {}}}, {}};
  for (const PolarisationFigures& pixel : pixels) {
    const DisplayColor color = cyclic_color(pixel.angle_deg / 180, pixel.linear_degree);
    for (std::size_t c = 0; c < 3; ++c) image.channels[c].values.push_back(static_cast<float>(color[c]));
  }
  return image;
}

}  // namespace

Image histogram_picture(const std::vector<double>& values, double high) {
  std::array<std::size_t, kBars> counts{};
  for (const double value : values)
    ++counts.at(static_cast<std::size_t>(std::clamp(value / high * kBars, 0.0, kBars - 1.0)));
  const auto max_value = static_cast<double>(*std::max_element(counts.begin(), counts.end()));
  Canvas canvas;
  const int base = kBarsTop + kBarsHeight;
  for (int i = 0; i < kBars; ++i) {
    const double count = static_cast<double>(counts.at(static_cast<std::size_t>(i)));
    const int x = kBarsMargin + i * kHueWidth;
    const DisplayColor color = map_color((i + 0.5) / kBars);
    canvas.fill(x, base - static_cast<int>(std::lround(kBarsHeight * count / max_value)), x + kHueWidth - 1,
                base, color);
    canvas.fill(x, base + 4, x + kHueWidth, base + 12, color);
  }
  canvas.fill(kBarsMargin, base, kPictureWidth - kBarsMargin, base + 1, kInk);
  for (int tick = 0; tick <= 4; ++tick) {
    const int x = kBarsMargin + kBars * kHueWidth * tick / 4;
    canvas.fill(x, base, x + 1, base + 16, kInk);
    draw_number(canvas, high * tick / 4, x, base + 20);
  }
  return canvas.take();
}

std::vector<DifferenceMap> difference_maps(const std::vector<double>& relative_errors,
                                           const std::optional<ColorDifference>& color, int width,
                                           int height) {
  std::vector<DifferenceMap> maps{map_of(kRelativeErrorMap, relative_errors, width, height)};
  if (color) maps.push_back(map_of(kDeltaEMap, color->pixels, width, height));
  return maps;
}

std::vector<PolarisationMap> polarisation_maps(const std::vector<PolarisationFigures>& pixels,
                                               MeasuredStokes measured, int width, int height) {
  std::vector<PolarisationMap> maps;
  if (measured == MeasuredStokes::all)
    maps.push_back({kDegreeMap, degrees(pixels, &PolarisationFigures::degree, width, height)});
  maps.push_back({kLinearDegreeMap, degrees(pixels, &PolarisationFigures::linear_degree, width, height)});
  maps.push_back({kAngleMap, angles(pixels, width, height)});
  return maps;
}

}  // namespace abbe
