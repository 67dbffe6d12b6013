#include "calibration/metrics/slanted_edge.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>

#include "io/error.h"

namespace abbe {
namespace {

constexpr int kMinSide = 16;  // pixels on a side
constexpr int kBinsPerPixel = 4;
constexpr double kMinAngle = 1;  // degrees
constexpr double kMaxAngle = 40;

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
  Plane rotated{{}, plane.height, plane.width};
  for (int x = 0; x < plane.width; ++x)
    for (int y = 0; y < plane.height; ++y) rotated.values.push_back(plane.at(x, y));
  return rotated;
}

double contrast(const Plane& plane) {
  double total = 0;
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x + 1 < plane.width; ++x) total += std::pow(plane.at(x + 1, y) - plane.at(x, y), 2);
  return total;
}

double hamming(double x, double half_width) {
  return std::abs(x) < half_width ? 0.54 + 0.46 * std::cos(std::numbers::pi * x / half_width) : 0;
}

// Line x = at_top + slope y.
struct EdgeLine {
  double at_top;
  double slope;
};

// Line through the centroids of the rows' derivatives, in a window around the line `near`.
EdgeLine edge_line(const Plane& plane, const EdgeLine& near, double half_width) {
  double n = 0, sy = 0, sx = 0, syy = 0, sxy = 0;
  for (int y = 0; y < plane.height; ++y) {
    double weight = 0;
    double moment = 0;
    for (int x = 0; x + 1 < plane.width; ++x) {
      const double center = x + 0.5;
      const double w =
          (plane.at(x + 1, y) - plane.at(x, y)) * hamming(center - near.at_top - near.slope * y, half_width);
      weight += w;
      moment += w * center;
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
  const double denominator = n * syy - sy * sy;
  if (!(denominator > 0)) refuse("there is no edge in these pixels");
  const double slope = (n * sxy - sx * sy) / denominator;
  return {(sx - slope * sy) / n, slope};
}

void require_finite(const Plane& plane) {
  const auto bad = std::ranges::find_if_not(plane.values, [](double v) { return std::isfinite(v); });
  if (bad == plane.values.end()) return;
  const auto at = static_cast<int>(bad - plane.values.begin());
  refuse(fmt::format("pixel {},{} of these is not a finite number (got {})", at % plane.width,
                     at / plane.width, *bad));
}

// Sums over the values at one distance from the edge.
struct BinSums {
  double sum = 0;
  double squares = 0;
  double count = 0;
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double deviations() const { return std::max(0.0, squares - sum * sum / count); }
};
// Rejects pixels whose variance the distance from one edge does not explain, and edges with equal sides.
void require_edge(const std::vector<BinSums>& bins) {
  constexpr double kMaxUnexplained = 0.1;  // an edge of twelve times the noise has 0.03
  constexpr double kMinStep = 0.5;         // fraction of the range of the means
  BinSums all;
  double unexplained = 0;
  double lowest = bins.front().mean();
  double highest = lowest;
  for (const BinSums& bin : bins) {
    all = {all.sum + bin.sum, all.squares + bin.squares, all.count + bin.count};
    unexplained += bin.deviations();
    lowest = std::min(lowest, bin.mean());
    highest = std::max(highest, bin.mean());
  }
  const double fraction = unexplained / all.deviations();
  if (!(fraction < kMaxUnexplained))
    refuse(
        fmt::format("these pixels show no single straight edge: the distance from one does not explain "
                    "{:.2g} % of their variance (allowed {:.2g} %); crop to an edge between two even sides, "
                    "and reduce noise by more light or samples",
                    100 * fraction, 100 * kMaxUnexplained));
  if (!(std::abs(bins.back().mean() - bins.front().mean()) > kMinStep * (highest - lowest)))
    refuse("both sides of the line in these pixels are equal: crop to an edge between two even sides");
}

// Mean values by distance from the line, which is at the center.
std::vector<double> edge_spread(const Plane& plane, const EdgeLine& line) {
  const double cosine = 1 / std::hypot(1, line.slope);
  // The bins extend as far as every row does on both sides.
  const double ends[] = {line.at_top, line.at_top + line.slope * (plane.height - 1)};
  const double margin = std::min(std::min(ends[0], ends[1]), plane.width - 1 - std::max(ends[0], ends[1]));
  const int half = static_cast<int>(margin * cosine * kBinsPerPixel) - 1;
  if (half < 2 * kBinsPerPixel) refuse("the edge leaves these pixels, or runs too near to their border");
  std::vector<BinSums> bins(static_cast<std::size_t>(2 * half));
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const double distance = (x - line.at_top - line.slope * y) * cosine;
      const auto bin = static_cast<int>(std::floor(distance * kBinsPerPixel)) + half;
      if (bin < 0 || bin >= 2 * half) continue;
      BinSums& bin_sums = bins[static_cast<std::size_t>(bin)];
      const double value = plane.at(x, y);
      bin_sums = {bin_sums.sum + value, bin_sums.squares + value * value, bin_sums.count + 1};
    }
  if (std::any_of(bins.begin(), bins.end(), [](const BinSums& bin) { return bin.count == 0; }))
    refuse("too few rows for quarters of a pixel: the edge needs to cross four columns or more");
  require_edge(bins);
  std::vector<double> means;
  for (const BinSums& bin : bins) means.push_back(bin.mean());
  return means;
}

double sinc(double x) {
  return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
}

// Response of binning and of differences over two bins at a frequency [cycles/bin].
double binning_response(double frequency) {
  return sinc(frequency) * sinc(2 * frequency);
}

// Magnitude of the spectrum of the edge's windowed derivative, over the responses of binning and difference,
// relative to that at frequency 0.
std::vector<double> modulation(const std::vector<double>& edge) {
  std::vector<double> line_spread(edge.size(), 0);
  const double center = (static_cast<double>(edge.size()) - 1) / 2;
  for (std::size_t i = 1; i + 1 < edge.size(); ++i)
    line_spread[i] = (edge[i + 1] - edge[i - 1]) / 2 * hamming(static_cast<double>(i) - center, center + 1);
  std::vector<double> mtf;
  // Up to one cycle per pixel, twice the Nyquist frequency.
  const std::size_t count = edge.size() / kBinsPerPixel;
  for (std::size_t k = 0; k <= count; ++k) {
    std::complex<double> sum = 0;
    const double frequency = static_cast<double>(k) / static_cast<double>(edge.size());
    for (std::size_t i = 0; i < line_spread.size(); ++i)
      sum += line_spread[i] * std::polar(1.0, -2 * std::numbers::pi * frequency * static_cast<double>(i));
    mtf.push_back(std::abs(sum) / binning_response(frequency));
  }
  const double whole = mtf.front();
  if (!(whole > 0)) refuse("there is no edge in these pixels");
  for (double& m : mtf) m /= whole;
  return mtf;
}

}  // namespace

EdgeResponse slanted_edge(std::span<const double> values, int width, int height) {
  if (width < kMinSide || height < kMinSide)
    refuse(fmt::format("got {} x {} pixels, allowed from {} x {} on", width, height, kMinSide, kMinSide));
  Plane plane{{values.begin(), values.end()}, width, height};
  require_finite(plane);
  const Plane rotated = transposed(plane);
  EdgeResponse response{};
  response.is_horizontal = contrast(rotated) > contrast(plane);
  if (response.is_horizontal) plane = rotated;
  const double whole = plane.width;
  EdgeLine line = edge_line(plane, {whole / 2, 0}, whole);
  for (const double half_width : {whole / 2, whole / 4}) line = edge_line(plane, line, half_width);
  response.angle_deg = std::atan(line.slope) * 180 / std::numbers::pi;
  const double angle = std::abs(response.angle_deg);
  if (angle < kMinAngle || angle > kMaxAngle)
    refuse(
        fmt::format("the edge is slanted by {:.2f} degrees (allowed {} to {})", angle, kMinAngle, kMaxAngle));
  response.edge = edge_spread(plane, line);
  response.mtf = modulation(response.edge);
  for (std::size_t i = 1; i < response.mtf.size() && !response.mtf50; ++i)
    if (response.mtf[i] < 0.5) {
      const double fraction = (response.mtf[i - 1] - 0.5) / (response.mtf[i - 1] - response.mtf[i]);
      response.mtf50 = std::lerp(response.frequency(i - 1), response.frequency(i), fraction);
    }
  return response;
}

}  // namespace abbe
