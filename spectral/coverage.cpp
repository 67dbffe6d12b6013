#include "spectral/coverage.h"

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace abbe {
namespace {

// Exact at the knots; between two of different signs it is too large, which no share hangs on.
Curve magnitude(const Curve& curve) {
  std::vector<Knot> knots(curve.knots().begin(), curve.knots().end());
  for (Knot& knot : knots) knot.value = std::abs(knot.value);
  return Curve(std::move(knots));
}

// The last knot in this order up to which the integral is no more than that.
double last_within(std::span<const Knot> knots, double integral) {
  double total = 0;
  std::size_t i = 0;
  for (; i + 1 < knots.size(); ++i) {
    const double width_nm = std::abs(knots[i + 1].wavelength_nm - knots[i].wavelength_nm);
    total += width_nm * (knots[i].value + knots[i + 1].value) / 2;
    if (total > integral) break;
  }
  return knots[i].wavelength_nm;
}

}  // namespace

double share_beyond(const Curve& curve, double low_nm, double high_nm) {
  const Curve all = magnitude(curve);
  return all.max() > 0 ? 1 - all.integral(low_nm, high_nm) / all.integral() : 0;
}

NeededRange main_range(const Curve& curve) {
  const Curve all = magnitude(curve);
  const double negligible = kNegligibleShare * all.integral();
  const std::vector<Knot> upwards(all.knots().begin(), all.knots().end());
  const std::vector<Knot> downwards(upwards.rbegin(), upwards.rend());
  return {std::floor(last_within(upwards, negligible)), std::ceil(last_within(downwards, negligible))};
}

Curve held_beyond(const NamedCurve& table) {
  std::vector<Knot> knots;
  for (const Knot& knot : table.curve.knots()) {
    if (knot.wavelength_nm < table.low_nm || knot.wavelength_nm > table.high_nm) continue;
    if (knot.wavelength_nm == table.low_nm) knots.clear();  // of a rise from 0 the upper end is the first row
    knots.push_back(knot);
  }
  return Curve(std::move(knots));
}

}  // namespace abbe
