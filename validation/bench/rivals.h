#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "validation/bench/run.h"

namespace abbe {

/// What another renderer reached on a suite.
struct Rival {
  std::string suite;
  std::string renderer;
  std::string setting;
  int samples;  ///< Per pixel, or passes.
  double cpu_s;
  std::optional<double> nrmse;
  double relrmse;
  double floor;  ///< Of its relRMSE, `kUsualFloor` or `kLowFloor`.

  [[nodiscard]] std::string name() const { return renderer + " " + setting; }
};

/// `data/bench/rivals.csv`. Throws Error{input} when it is missing or malformed.
[[nodiscard]] std::vector<Rival> load_rivals();

/// A point of run time against error.
struct CurvePoint {
  double cpu_s;
  double error;
};

/// The points of one integrator's rows with that floor, one per sample count; those without error left out.
[[nodiscard]] std::vector<CurvePoint> error_curve(const std::vector<BenchRow>& rows, double floor);

/// A time read off a curve.
struct TimeAtError {
  double cpu_s;
  bool extrapolated;  ///< The error lies beyond the curve.
};

/// When a curve, sorted by time, reaches an error: on the line through two neighbours in the logarithms of
/// both; beyond the ends by error ~ 1/sqrt(time) from the nearer one. Nothing without a point.
[[nodiscard]] std::optional<TimeAtError> time_at_error(std::span<const CurvePoint> curve, double error);

/// A rival against Abbe at the rival's error.
struct EqualError {
  Rival rival;
  TimeAtError abbe;

  /// How many times longer the rival takes.
  [[nodiscard]] double ratio() const { return rival.cpu_s / abbe.cpu_s; }
};

/// Compares the first integrator of a run with all rivals of its suite at their errors.
[[nodiscard]] std::vector<EqualError> equal_errors(const SuiteRun& run, std::span<const Rival> rivals);

}  // namespace abbe
