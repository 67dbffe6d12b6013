#pragma once

namespace abbe {

/// Half width of the confidence interval of a mean at the given confidence level, by Student's t distribution
/// [Student1908]. The standard error is estimated with `degrees` degrees of freedom. Infinite for 0 degrees.
[[nodiscard]] double half_interval(double standard_error, double degrees, double level);

}  // namespace abbe
