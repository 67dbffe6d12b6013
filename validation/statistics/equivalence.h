#pragma once

namespace abbe {

/// A measured mean and the standard error of it.
struct Estimate {
  double mean;
  double standard_error;
};

/// Standard errors in half of an interval: significance 1e-6.
inline constexpr double kInterval = 4.89;

enum class Verdict { pass, fail, inconclusive };

/// Whether a measurement equals its reference within `margin` (relative to the reference), decided by
/// equivalence: passing needs the whole interval of 4.89 standard errors (significance 1e-6) within the
/// margin; failing needs it clear of the reference by more than rounding; otherwise more samples are needed.
[[nodiscard]] Verdict equivalence(const Estimate& measured, double reference, double margin);

}  // namespace abbe
