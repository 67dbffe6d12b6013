#pragma once

namespace abbe {

/// A measured mean and its standard error.
struct Estimate {
  double mean;
  double standard_error;
};

/// Half width of an interval in standard errors, for the significance 1e-6.
inline constexpr double kInterval = 4.89;

enum class Verdict { pass, fail, inconclusive };

/// Equivalence test of a measurement against a reference; `margin` is relative to the reference.
/// - `pass`: the whole interval of ± 4.89 standard errors lies within the margin.
/// - `fail`: the interval excludes the reference by more than rounding errors.
/// - `inconclusive`: more samples are needed.
[[nodiscard]] Verdict equivalence(const Estimate& measured, double reference, double margin);

}  // namespace abbe
