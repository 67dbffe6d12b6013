#include "calibration/fit/series_checks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "calibration/fit/median.h"
#include "calibration/fit/response_noise.h"
#include "io/error.h"

namespace abbe {
namespace {

constexpr double kLeastSpan = 1.02;
constexpr double kLeastFall = 0.01;   // of a code
constexpr double kMostOpen = 0.1;     // of the brightest exposure that codes tell of
constexpr double kMostUnknown = 0.5;  // of full scale, beyond it

// What the codes of each patch that is neither black nor clipped at two times are multiplied by from one to
// the other.
std::vector<double> ratios(const ExposureSeries& series, std::size_t from, std::size_t to) {
  const auto says_something = [](double code) { return code > 0 && code < 1; };
  std::vector<double> all;
  for (const std::vector<double>& codes : series.codes)
    if (says_something(codes[from]) && says_something(codes[to])) all.push_back(codes[to] / codes[from]);
  return all;
}

void require_rise(const ExposureSeries& series, std::size_t from, std::size_t to) {
  constexpr std::size_t kLeastPatches = 4;
  const std::vector<double> found = ratios(series, from, to);
  if (found.size() < kLeastPatches) return;
  const auto falling = std::count_if(found.begin(), found.end(), [](double ratio) { return ratio < 1; });
  const double fall = 1 - median(found);
  require_for_response(
      4 * falling < static_cast<std::ptrdiff_t>(3 * found.size()) || fall < kLeastFall,
      fmt::format("the codes fall by {:.2g} % (median of {} patches) from the photograph of {:.6g} s to that "
                  "of {:.6g} s: are exposure times swapped, or did the light change?",
                  100 * fall, found.size(), series.times_s[from], series.times_s[to]));
}

}  // namespace

void require_for_response(bool condition, const std::string& message) {
  if (!condition) throw Error(ErrorCode::input, "response fit", message);
}

void require_usable_times(const ExposureSeries& series) {
  const std::vector<double>& times = series.times_s;
  require_for_response(times.size() >= 2,
                       fmt::format("an exposure series needs two times or more (got {})", times.size()));
  require_for_response(
      std::all_of(times.begin(), times.end(), [](double t) { return t > 0 && std::isfinite(t); }),
      "exposure times must be positive");
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
  const double span = times[order.back()] / times[order.front()];
  require_for_response(span >= kLeastSpan,
                       fmt::format("the exposure times leave the curve open: the longest is {:.6g} times the "
                                   "shortest (allowed from {} on, 2 is better)",
                                   span, kLeastSpan));
  for (std::size_t i = 0; i + 1 < order.size(); ++i)
    if (times[order[i]] < times[order[i + 1]]) require_rise(series, order[i], order[i + 1]);
}

void require_determined(const ResponseFit& fit, std::span<const ResponseSample> samples) {
  const auto [lowest, highest] =
      std::minmax_element(samples.begin(), samples.end(),
                          [](const ResponseSample& a, const ResponseSample& b) { return a.code < b.code; });
  const double brightest = linearise(fit.linear, highest->code);
  double open = 0;
  double at = 0;
  constexpr int kSteps = 100;
  for (int i = 0; i <= kSteps; ++i) {
    const double code = std::lerp(lowest->code, highest->code, static_cast<double>(i) / kSteps);
    const double half_width = half_width_95(fit, code) / brightest;
    if (half_width > open) {
      open = half_width;
      at = code;
    }
  }
  require_for_response(
      open < kMostOpen,
      fmt::format(
          "these exposures leave the curve open: of the codes {:.3g} to {:.3g} the exposure of {:.3g} "
          "is known to {:.2g} % of the brightest (allowed {:.2g} %): photograph at more times, some of "
          "them a factor of two apart",
          lowest->code, highest->code, at, 100 * open, 100 * kMostOpen));
  const double unknown = largest_uncertainty(fit);
  require_for_response(
      unknown < kMostUnknown,
      fmt::format(
          "no exposure tells of the codes beyond {:.3g}, where the curve is known to {:.2g} % of full "
          "scale (allowed {:.2g} %): photograph longer, until the brightest patches clip",
          highest->code, 100 * unknown, 100 * kMostUnknown));
}

}  // namespace abbe
