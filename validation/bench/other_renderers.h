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
  std::string renderer;  ///< Name and version, such as "Mitsuba 3.8".
  std::string setting;   ///< Integrator and variant, such as "path llvm_spectral".
  int samples;           ///< Samples per pixel, or passes.
  double cpu_s;
  std::optional<double> nrmse;  ///< RMSE divided by the mean of the reference; nothing if not measured.
  double relrmse;               ///< Square root of relMSE (`rel_mse`) with `floor`.
  double floor;                 ///< `kUsualFloor` or `kLowFloor`.

  /// Renderer and setting, for captions.
  [[nodiscard]] std::string name() const { return renderer + " " + setting; }
};

/// Reads `data/bench/rivals.csv`, row by row. Throws Error{input} if it is missing or malformed, if a number
/// is not positive, or if a floor is neither of the two.
[[nodiscard]] std::vector<OtherRendererResult> load_other_renderers();

struct CurvePoint {
  double cpu_s;
  double error;  ///< relRMSE, > 0.
};

/// Curve of one integrator's rows: one point per sample count, in the order of the rows, with means over the
/// seeds. The error is relRMSE with `floor`, which is `kUsualFloor` or `kLowFloor`. Points whose error is not
/// positive are omitted.
[[nodiscard]] std::vector<CurvePoint> error_curve(const std::vector<BenchRow>& rows, double floor);

struct TimeAtError {
  double cpu_s;
  bool extrapolated;  ///< True if the error lies outside the curve.
};

/// Run time at which a curve, sorted by time, has the error `error` > 0; the first time if there are several.
/// Between two points it is interpolated linearly in the logarithms of both axes. An error above that of the
/// first point is extrapolated from there, a smaller one from the last point, by error ~ 1/sqrt(time).
/// Nothing for a curve without points.
[[nodiscard]] std::optional<TimeAtError> time_at_error(std::span<const CurvePoint> curve, double error);

/// Run times of another renderer and of Abbe at the other renderer's error.
struct EqualError {
  OtherRendererResult other;
  TimeAtError abbe;

  [[nodiscard]] double ratio() const { return other.cpu_s / abbe.cpu_s; }
};

/// Compares the first integrator of a run with the results of other renderers for its suite, in their order.
/// Empty if Abbe's errors are all hidden by noise.
[[nodiscard]] std::vector<EqualError> equal_errors(const SuiteRun& run,
                                                   std::span<const OtherRendererResult> other_renderers);

}  // namespace abbe
