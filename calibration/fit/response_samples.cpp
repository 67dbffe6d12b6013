#include "calibration/fit/response_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abbe {
namespace {

// standard deviations from black; below that the curve would follow the noise
constexpr double kDarkMargin = 8;
constexpr double kBrightMargin = 4;  // standard deviations from full scale

}  // namespace

bool within_margins(double code, double deviation) {
  return code > kDarkMargin * deviation && code < 1 - kBrightMargin * deviation;
}

std::vector<ResponseSample> usable_samples(const ExposureSeries& series, bool with_margins) {
  std::vector<ResponseSample> samples;
  for (std::size_t i = 0; i < series.codes.size(); ++i) {
    double black_s = 0;
    double clipped_s = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < series.times_s.size(); ++j) {
      if (series.codes[i][j] <= 0) black_s = std::max(black_s, series.times_s[j]);
      if (series.codes[i][j] >= 1) clipped_s = std::min(clipped_s, series.times_s[j]);
    }
    for (std::size_t j = 0; j < series.times_s.size(); ++j) {
      const double code = series.codes[i][j];
      const double time = series.times_s[j];
      const double known = series.deviations.empty() ? 0 : series.deviations[i][j];
      if (!(time > black_s && time < clipped_s && code > 0 && code < 1)) continue;
      if (with_margins && !within_margins(code, known)) continue;
      samples.push_back({i, code, series.deviations.empty() ? 1 : known, std::log(time)});
    }
  }
  return samples;
}

}  // namespace abbe
