#pragma once

namespace abbe {

/// Integral of f from a to b by the midpoint rule with `steps` >= 1 intervals. Swapping a and b changes its
/// sign.
template <typename Function>
[[nodiscard]] double midpoint_integral(const Function& f, double a, double b, int steps) {
  const double step = (b - a) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(a + (i + 0.5) * step);
  return sum * step;
}

}  // namespace abbe
