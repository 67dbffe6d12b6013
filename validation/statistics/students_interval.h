#pragma once

namespace abbe {

/// Half the width of the interval around a mean that holds the truth with the probability `level`: Student's,
/// of a standard error that is estimated with so many degrees of freedom [Student1908]. Infinite with none.
[[nodiscard]] double half_interval(double standard_error, double degrees, double level);

}  // namespace abbe
