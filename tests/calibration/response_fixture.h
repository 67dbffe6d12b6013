#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "calibration/fit/response.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe::test {

/// Exposure times of 2^low to 2^high seconds.
inline std::vector<double> stops(double low, double high, double step) {
  std::vector<double> times;
  for (int i = 0; low + i * step <= high; ++i) times.push_back(std::exp2(low + i * step));
  return times;
}

/// Green values of the chart's patches for a measured camera.
inline std::vector<double> chart_values() {
  std::vector<double> values;
  const Curve light = illuminant("D65");
  const std::vector<Channel> nikon = camera();
  for (const Patch& patch : chart().patches) values.push_back(camera_raw(nikon, light, patch.reflectance)[1]);
  return values;
}

/// Ratio of the planted to the recovered exposure of a code, each relative to mid-scale.
inline double exposure_ratio(const ResponseFit& fit, const PlantedResponse& planted, double code) {
  return linearise(fit.linear, code) / linearise(fit.linear, 0.5) * planted.exposure(0.5) /
         planted.exposure(code);
}

/// Largest error between 1 % and 99 % of the code range, as a fraction of full scale.
inline double worst_error(const ResponseFit& fit, const PlantedResponse& planted) {
  double worst = 0;
  for (int i = 10; i <= 990; ++i)
    worst = std::max(worst,
                     std::abs(exposure_ratio(fit, planted, i / 1000.0) - 1) * planted.exposure(i / 1000.0));
  return worst;
}

/// Fraction of the codes between 1 % and 99 % at which the reported interval contains the planted exposure.
inline double coverage(const ResponseFit& fit, const PlantedResponse& planted) {
  int inside = 0;
  for (int i = 10; i <= 990; ++i) {
    const double code = i / 1000.0;
    const double error = std::abs(std::log(exposure_ratio(fit, planted, code)));
    inside += error <= 1.96 * linearise(fit.log_deviation, code) ? 1 : 0;
  }
  return inside / 981.0;
}

/// Noise of a 12-bit camera whose patches are means of several pixels: half a step in the dark, one and a
/// half steps at full scale.
inline constexpr CodeNoise kNoisyCamera{12, 1.2e-4, 1.2e-7};

/// Noise of a single pixel of such a camera: 14 000 electrons at full scale, and a read noise of one step.
inline constexpr CodeNoise kSinglePixels{12, 3e-4, 7e-5};

/// Result of recovering a planted curve from many noisy series.
struct Recovery {
  double worst = 0;     ///< Error over all seeds.
  double coverage = 0;  ///< Mean over all seeds.
};
inline Recovery recover_often(const std::string& response, int seeds, const CodeNoise& noise = kNoisyCamera,
                              bool is_stated = true) {
  const PlantedResponse planted(response);
  const std::vector<double> values = chart_values();
  Recovery all;
  for (int seed = 1; seed <= seeds; ++seed) {
    ExposureSeries series =
        expose(values, stops(-9, 6, 1.0 / 3), planted, noise, static_cast<std::uint64_t>(seed));
    if (!is_stated) series.deviations.clear();
    const ResponseFit fit = recover_response(series);
    all.worst = std::max(all.worst, worst_error(fit, planted));
    all.coverage += coverage(fit, planted) / seeds;
  }
  return all;
}

}  // namespace abbe::test
