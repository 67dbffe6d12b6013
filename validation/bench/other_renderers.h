#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "validation/bench/run.h"

namespace abbe {

/// Error and run time of another renderer on a suite.
struct OtherRendererResult {
  std::string suite;
  std::string renderer;
  std::string setting;
  int samples;  ///< Samples per pixel, or passes.
  double cpu_s;
  std::optional<double> nrmse;
  double relrmse;
  double floor;  ///< Floor of `relrmse`: `kUsualFloor` or `kLowFloor`.

  [[nodiscard]] std::string name() const { return renderer + " " + setting; }
};

/// Reads `data/bench/rivals.csv`. Throws Error{input} if it is missing or malformed.
[[nodiscard]] std::vector<OtherRendererResult> load_other_renderers();

/// A point of a curve of error against run time.
struct CurvePoint {
  double cpu_s;
  double error;
};

/// Curve of one integrator's rows, by relRMSE with the given floor: one point per sample count. Points whose
/// error is not positive are omitted.
[[nodiscard]] std::vector<CurvePoint> error_curve(const std::vector<BenchRow>& rows, double floor);

/// A run time interpolated from a curve.
struct TimeAtError {
  double cpu_s;
  bool extrapolated;  ///< True if the error lies outside the curve.
};

/// Run time at which a curve, sorted by time, has the error `error`. Between two points it is interpolated
/// linearly in the logarithms of both axes. Outside the curve it is extrapolated from the nearer end by error
/// ~ 1/sqrt(time). Empty for a curve without points.
[[nodiscard]] std::optional<TimeAtError> time_at_error(std::span<const CurvePoint> curve, double error);

/// Run times of another renderer and of Abbe at the other renderer's error.
struct EqualError {
  OtherRendererResult other;
  TimeAtError abbe;

  /// Run time of the other renderer divided by Abbe's.
  [[nodiscard]] double ratio() const { return other.cpu_s / abbe.cpu_s; }
};

/// Compares the first integrator of a run with all results of other renderers for its suite.
[[nodiscard]] std::vector<EqualError> equal_errors(const SuiteRun& run,
                                                   std::span<const OtherRendererResult> other_renderers);

}  // namespace abbe
