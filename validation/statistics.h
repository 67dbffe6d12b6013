#pragma once

namespace abbe {

/// A measured mean and its standard error, which is 0 for a value that is not sampled.
struct Estimate {
  double mean;
  double standard_error = 0;
};

/// Half width of an interval in standard errors. A normal variable lies outside it, on either side, with
/// probability 1e-6.
inline constexpr double kInterval = 4.89;

/// Result of `equivalence`, or of a comparison without sampling error, which is never `inconclusive`.
enum class Verdict { pass, fail, inconclusive };

/// Equivalence test of a measurement against a reference. `margin` is a fraction of |reference|. The interval
/// is the mean ± `kInterval` standard errors.
/// - `pass`: the whole interval lies within the margin. A reference of 0 never passes.
/// - `fail`: otherwise, if the interval excludes the reference by more than rounding errors (1e-5 of it), or
/// is not finite.
/// - `inconclusive`: otherwise; more samples are needed.
[[nodiscard]] Verdict equivalence(const Estimate& measured, double reference, double margin);

/// Half width of the two-sided confidence interval of a mean, by Student's t distribution [Student1908].
/// `level` is the confidence in (0, 1), such as 0.95. `standard_error` was estimated with `degrees` degrees
/// of freedom; the result is infinite unless these are positive.
[[nodiscard]] double half_interval(double standard_error, double degrees, double level);

}  // namespace abbe
