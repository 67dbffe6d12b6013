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
constexpr double kTurn = 2 * std::numbers::pi;

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
  return std::abs(x) < half_width ? 0.54 + 0.46 * std::cos(kTurn / 2 * x / half_width) : 0;
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
  if (!(spread > 0)) throw Error(ErrorCode::input, "slanted edge", "there is no edge in these pixels");
  const double slope = (n * sxy - sx * sy) / spread;
  return {(sx - slope * sy) / n, slope};
}

// Mean values by distance from the line, which is in the middle.
std::vector<double> edge_spread(const Plane& plane, const EdgeLine& line) {
  const double cosine = 1 / std::hypot(1, line.slope);
  // As far as every row reaches on both sides.
  const double ends[] = {line.at_top, line.at_top + line.slope * (plane.height - 1)};
  const double reach = std::min(std::min(ends[0], ends[1]), plane.width - 1 - std::max(ends[0], ends[1]));
  const int half = static_cast<int>(reach * cosine * kBinsPerPixel) - 1;
  if (half < 2 * kBinsPerPixel)
    throw Error(ErrorCode::input, "slanted edge",
                "the edge leaves these pixels, or runs too near to their border");
  std::vector<double> sums(static_cast<std::size_t>(2 * half), 0);
  std::vector<double> counts(sums.size(), 0);
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const double distance = (x - line.at_top - line.slope * y) * cosine;
      const auto bin = static_cast<int>(std::floor(distance * kBinsPerPixel)) + half;
      if (bin < 0 || bin >= 2 * half) continue;
      sums[static_cast<std::size_t>(bin)] += plane.at(x, y);
      counts[static_cast<std::size_t>(bin)] += 1;
    }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (counts[i] == 0)
      throw Error(ErrorCode::input, "slanted edge",
                  "too few rows for quarters of a pixel: the edge needs to cross four columns or more");
    sums[i] /= counts[i];
  }
  return sums;
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
      sum += spread[i] * std::polar(1.0, -kTurn * frequency * static_cast<double>(i));
    mtf.push_back(std::abs(sum) / kept(frequency));
  }
  const double whole = mtf.front();
  if (!(whole > 0)) throw Error(ErrorCode::input, "slanted edge", "there is no edge in these pixels");
  for (double& m : mtf) m /= whole;
  return mtf;
}

}  // namespace

EdgeResponse slanted_edge(std::span<const double> values, int width, int height) {
  if (width < kLeastEdge || height < kLeastEdge)
    throw Error(
        ErrorCode::input, "slanted edge",
        fmt::format("got {} x {} pixels, allowed from {} x {} on", width, height, kLeastEdge, kLeastEdge));
  Plane plane{{values.begin(), values.end()}, width, height};
  const Plane turned = transposed(plane);
  EdgeResponse response{};
  response.is_horizontal = contrast(turned) > contrast(plane);
  if (response.is_horizontal) plane = turned;
  const double whole = plane.width;
  EdgeLine line = edge_line(plane, {whole / 2, 0}, whole);
  for (const double half_width : {whole / 2, whole / 4}) line = edge_line(plane, line, half_width);
  response.angle_deg = std::atan(line.slope) * 360 / kTurn;
  const double angle = std::abs(response.angle_deg);
  if (angle < kLeastAngle || angle > kMostAngle)
    throw Error(ErrorCode::input, "slanted edge",
                fmt::format("the edge is slanted by {:.2f} degrees (allowed {} to {})", angle, kLeastAngle,
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
