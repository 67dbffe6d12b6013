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

constexpr double kMinSpan = 1.02;
constexpr double kMinFall = 0.01;                 // relative fall of a code
constexpr double kMaxUncertainty = 0.1;           // relative to the exposure of the highest code
constexpr double kMaxFullScaleUncertainty = 0.5;  // relative to full scale, outside the codes

// Ratios of the codes at two times, for each patch that is neither black nor clipped at either.
std::vector<double> ratios(const ExposureSeries& series, std::size_t from, std::size_t to) {
  const auto is_usable = [](double code) { return code > 0 && code < 1; };
  std::vector<double> all;
  for (const std::vector<double>& codes : series.codes)
    if (is_usable(codes[from]) && is_usable(codes[to])) all.push_back(codes[to] / codes[from]);
  return all;
}

// Throws Error{input} if the codes of most patches fall from one photograph to the next longer one.
void require_rise(const ExposureSeries& series, std::size_t from, std::size_t to) {
  constexpr std::size_t kMinPatches = 4;
  const std::vector<double> code_ratios = ratios(series, from, to);
  if (code_ratios.size() < kMinPatches) return;
  const auto falling =
      std::count_if(code_ratios.begin(), code_ratios.end(), [](double ratio) { return ratio < 1; });
  const double fall = 1 - median(code_ratios);
  require_for_response(
      4 * falling < static_cast<std::ptrdiff_t>(3 * code_ratios.size()) || fall < kMinFall,
      fmt::format("the codes fall by {:.2g} % (median of {} patches) from the photograph of {:.6g} s to that "
                  "of {:.6g} s: are exposure times swapped, or did the light change?",
                  100 * fall, code_ratios.size(), series.times_s[from], series.times_s[to]));
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
  require_for_response(span >= kMinSpan,
                       fmt::format("the exposure times do not determine the curve: the longest is {:.6g} "
                                   "times the shortest (allowed from {} on, 2 is better)",
                                   span, kMinSpan));
  for (std::size_t i = 0; i + 1 < order.size(); ++i)
    if (times[order[i]] < times[order[i + 1]]) require_rise(series, order[i], order[i + 1]);
}

void require_determined(const ResponseFit& fit, std::span<const ResponseSample> samples) {
  const auto [lowest, highest] =
      std::minmax_element(samples.begin(), samples.end(),
                          [](const ResponseSample& a, const ResponseSample& b) { return a.code < b.code; });
  const double brightest = linearise(fit.linear, highest->code);
  double uncertainty = 0;
  double at = 0;
  constexpr int kSteps = 100;
  for (int i = 0; i <= kSteps; ++i) {
    const double code = std::lerp(lowest->code, highest->code, static_cast<double>(i) / kSteps);
    const double half_width = half_width_95(fit, code) / brightest;
    if (half_width > uncertainty) {
      uncertainty = half_width;
      at = code;
    }
  }
  require_for_response(
      uncertainty < kMaxUncertainty,
      fmt::format("these exposures do not determine the curve: of the codes {:.3g} to {:.3g} the exposure of "
                  "{:.3g} is known to {:.2g} % of the brightest (allowed {:.2g} %); add exposure times, some "
                  "of them in a ratio of two",
                  lowest->code, highest->code, at, 100 * uncertainty, 100 * kMaxUncertainty));
  const double unknown = largest_uncertainty(fit);
  require_for_response(
      unknown < kMaxFullScaleUncertainty,
      fmt::format("no exposure determines the curve above code {:.3g}, where it is known to {:.2g} % of full "
                  "scale (allowed {:.2g} %): add longer exposures, until the brightest patches clip",
                  highest->code, 100 * unknown, 100 * kMaxFullScaleUncertainty));
}

}  // namespace abbe
