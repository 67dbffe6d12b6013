#include "calibration/judge/slanted_edge.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>

#include "io/error.h"

namespace abbe {
namespace {

constexpr int kLeastEdge = 16;  // pixels on a side
constexpr int kBinsPerPixel = 4;
constexpr double kLeastAngle = 1;  // degrees
constexpr double kMostAngle = 40;

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::input, "slanted edge", what);
}

struct Plane {
  std::vector<double> values;
  int width;
  int height;
  [[nodiscard]] double at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

Plane transposed(const Plane& plane) {
  Plane turned{{}, plane.height, plane.width};
  for (int x = 0; x < plane.width; ++x)
    for (int y = 0; y < plane.height; ++y) turned.values.push_back(plane.at(x, y));
  return turned;
}

// Sum of the squared differences along the rows.
double contrast(const Plane& plane) {
  double total = 0;
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x + 1 < plane.width; ++x) total += std::pow(plane.at(x + 1, y) - plane.at(x, y), 2);
  return total;
}

double hamming(double x, double half_width) {
  return std::abs(x) < half_width ? 0.54 + 0.46 * std::cos(std::numbers::pi * x / half_width) : 0;
}

// x = at_top + slope y.
struct EdgeLine {
  double at_top;
  double slope;
};

// Through the centroids of the rows' derivatives, which are looked for around `near`.
EdgeLine edge_line(const Plane& plane, const EdgeLine& near, double half_width) {
  double n = 0, sy = 0, sx = 0, syy = 0, sxy = 0;
  for (int y = 0; y < plane.height; ++y) {
    double weight = 0;
    double moment = 0;
    for (int x = 0; x + 1 < plane.width; ++x) {
      const double middle = x + 0.5;
      const double w =
          (plane.at(x + 1, y) - plane.at(x, y)) * hamming(middle - near.at_top - near.slope * y, half_width);
      weight += w;
      moment += w * middle;
    }
    if (weight == 0) continue;
    const double x = moment / weight;
    if (!(x > 0 && x < plane.width - 1)) continue;
    n += 1;
    sy += y;
    sx += x;
    syy += double{1} * y * y;
    sxy += x * y;
  }
  const double spread = n * syy - sy * sy;
  if (!(spread > 0)) refuse("there is no edge in these pixels");
  const double slope = (n * sxy - sx * sy) / spread;
  return {(sx - slope * sy) / n, slope};
}

void require_finite(const Plane& plane) {
  const auto bad =
      std::find_if(plane.values.begin(), plane.values.end(), [](double v) { return !std::isfinite(v); });
  if (bad == plane.values.end()) return;
  const auto at = static_cast<int>(bad - plane.values.begin());
  refuse(
      fmt::format("pixel {},{} of these holds no number (got {})", at % plane.width, at / plane.width, *bad));
}

// Values around one straight edge go by the distance from it alone, and rise or fall from one side to the
// other. Those of a chart, a line or a texture do not.
struct Spread {
  double sum = 0;
  double squares = 0;
  double count = 0;
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double deviations() const { return std::max(0.0, squares - sum * sum / count); }
};
void require_edge(const std::vector<Spread>& bins) {
  constexpr double kMostUnexplained = 0.1;  // an edge twelve times as high as the noise has 0.03
  constexpr double kLeastStep = 0.5;        // of the range of means
  Spread all;
  double unexplained = 0;
  double lowest = bins.front().mean();
  double highest = lowest;
  for (const Spread& bin : bins) {
    all = {all.sum + bin.sum, all.squares + bin.squares, all.count + bin.count};
    unexplained += bin.deviations();
    lowest = std::min(lowest, bin.mean());
    highest = std::max(highest, bin.mean());
  }
  const double share = unexplained / all.deviations();
  if (!(share < kMostUnexplained))
    refuse(
        fmt::format("these pixels show no single straight edge: {:.2g} % of their variance is not that of "
                    "the distance from one (allowed {:.2g} %): crop to an edge between two even sides, and "
                    "where it is noise take more light or samples",
                    100 * share, 100 * kMostUnexplained));
  if (!(std::abs(bins.back().mean() - bins.front().mean()) > kLeastStep * (highest - lowest)))
    refuse("both sides of the line that these pixels show are alike: crop to an edge between two even sides");
}

// Mean values by distance from the line, which is in the middle.
std::vector<double> edge_spread(const Plane& plane, const EdgeLine& line) {
  const double cosine = 1 / std::hypot(1, line.slope);
  // As far as every row reaches on both sides.
  const double ends[] = {line.at_top, line.at_top + line.slope * (plane.height - 1)};
  const double reach = std::min(std::min(ends[0], ends[1]), plane.width - 1 - std::max(ends[0], ends[1]));
  const int half = static_cast<int>(reach * cosine * kBinsPerPixel) - 1;
  if (half < 2 * kBinsPerPixel) refuse("the edge leaves these pixels, or runs too near to their border");
  std::vector<Spread> bins(static_cast<std::size_t>(2 * half));
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const double distance = (x - line.at_top - line.slope * y) * cosine;
      const auto bin = static_cast<int>(std::floor(distance * kBinsPerPixel)) + half;
      if (bin < 0 || bin >= 2 * half) continue;
      Spread& here = bins[static_cast<std::size_t>(bin)];
      const double value = plane.at(x, y);
      here = {here.sum + value, here.squares + value * value, here.count + 1};
    }
  if (std::any_of(bins.begin(), bins.end(), [](const Spread& bin) { return bin.count == 0; }))
    refuse("too few rows for quarters of a pixel: the edge needs to cross four columns or more");
  require_edge(bins);
  std::vector<double> means;
  for (const Spread& bin : bins) means.push_back(bin.mean());
  return means;
}

double sinc(double x) {
  return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
}

// What binning and differences over two bins leave of a frequency [cycles a bin].
double kept(double frequency) {
  return sinc(frequency) * sinc(2 * frequency);
}

std::vector<double> modulation(const std::vector<double>& edge) {
  std::vector<double> spread(edge.size(), 0);
  const double middle = (static_cast<double>(edge.size()) - 1) / 2;
  for (std::size_t i = 1; i + 1 < edge.size(); ++i)
    spread[i] = (edge[i + 1] - edge[i - 1]) / 2 * hamming(static_cast<double>(i) - middle, middle + 1);
  std::vector<double> mtf;
  // Up to one cycle a pixel, twice what pixels can hold.
  const std::size_t count = edge.size() / kBinsPerPixel;
  for (std::size_t k = 0; k <= count; ++k) {
    std::complex<double> sum = 0;
    const double frequency = static_cast<double>(k) / static_cast<double>(edge.size());
    for (std::size_t i = 0; i < spread.size(); ++i)
      sum += spread[i] * std::polar(1.0, -2 * std::numbers::pi * frequency * static_cast<double>(i));
    mtf.push_back(std::abs(sum) / kept(frequency));
  }
  const double whole = mtf.front();
  if (!(whole > 0)) refuse("there is no edge in these pixels");
  for (double& m : mtf) m /= whole;
  return mtf;
}

}  // namespace

EdgeResponse slanted_edge(std::span<const double> values, int width, int height) {
  if (width < kLeastEdge || height < kLeastEdge)
    refuse(fmt::format("got {} x {} pixels, allowed from {} x {} on", width, height, kLeastEdge, kLeastEdge));
  Plane plane{{values.begin(), values.end()}, width, height};
  require_finite(plane);
  const Plane turned = transposed(plane);
  EdgeResponse response{};
  response.is_horizontal = contrast(turned) > contrast(plane);
  if (response.is_horizontal) plane = turned;
  const double whole = plane.width;
  EdgeLine line = edge_line(plane, {whole / 2, 0}, whole);
  for (const double half_width : {whole / 2, whole / 4}) line = edge_line(plane, line, half_width);
  response.angle_deg = std::atan(line.slope) * 180 / std::numbers::pi;
  const double angle = std::abs(response.angle_deg);
  if (angle < kLeastAngle || angle > kMostAngle)
    refuse(fmt::format("the edge is slanted by {:.2f} degrees (allowed {} to {})", angle, kLeastAngle,
                       kMostAngle));
  response.edge = edge_spread(plane, line);
  response.mtf = modulation(response.edge);
  for (std::size_t i = 1; i < response.mtf.size() && !response.mtf50; ++i)
    if (response.mtf[i] < 0.5) {
      const double share = (response.mtf[i - 1] - 0.5) / (response.mtf[i - 1] - response.mtf[i]);
      response.mtf50 = std::lerp(response.frequency(i - 1), response.frequency(i), share);
    }
  return response;
}

}  // namespace abbe
