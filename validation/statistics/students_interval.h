#pragma once

namespace abbe {

/// Half width of the two-sided confidence interval of a mean, by Student's t distribution [Student1908].
/// `level` is the confidence in (0, 1), such as 0.95. `standard_error` was estimated with `degrees` degrees
/// of freedom; the result is infinite unless these are positive.
[[nodiscard]] double half_interval(double standard_error, double degrees, double level);

}  // namespace abbe
