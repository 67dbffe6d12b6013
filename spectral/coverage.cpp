#include "spectral/coverage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "spectral/curve_cursor.h"

namespace abbe {
namespace {

// Absolute value of a curve: exact at the knots, too large between two knots of different signs. No result
// depends on these.
Curve magnitude(const Curve& curve) {
  std::vector<Knot> knots(curve.knots().begin(), curve.knots().end());
  for (Knot& knot : knots) knot.value = std::abs(knot.value);
  return Curve(std::move(knots));
}

// Wavelength of the last knot, in the given order, up to which the integral does not exceed `integral`.
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

// Range between the knots that enclose all nonzero values. Its ends are swapped if there are none.
NeededRange support_range(const Curve& curve) {
  const std::span<const Knot> knots = curve.knots();
  const auto is_nonzero = [](const Knot& knot) { return knot.value != 0; };
  const auto first = std::find_if(knots.begin(), knots.end(), is_nonzero);
  if (first == knots.end()) return {kMaxWavelengthNm, kMinWavelengthNm};
  const auto after = std::find_if(knots.rbegin(), knots.rend(), is_nonzero).base();
  return {(first == knots.begin() ? first : std::prev(first))->wavelength_nm,
          (after == knots.end() ? std::prev(after) : after)->wavelength_nm};
}

struct Integral {
  double value = 0;
  std::size_t pieces = 0;
};

// Integral of |a b| over a range; exact unless a factor changes sign between two knots.
Integral magnitude_of_product(const Curve& a, const Curve& b, double low_nm, double high_nm) {
  CurveCursor piece_a(a, low_nm);
  CurveCursor piece_b(b, low_nm);
  const auto magnitude = [&](double nm) { return std::abs(piece_a(nm) * piece_b(nm)); };
  Integral sum;
  for (double from = low_nm; from < high_nm; ++sum.pieces) {
    const double to = std::min({piece_a.end_nm(), piece_b.end_nm(), high_nm});
    // Simpson's rule is exact for the product of two lines.
    sum.value += (to - from) / 6 * (magnitude(from) + 4 * magnitude((from + to) / 2) + magnitude(to));
    piece_a.advance_to(to);
    piece_b.advance_to(to);
    from = to;
  }
  return sum;
}

}  // namespace

FractionOutside fraction_outside(const Curve& weight, const Curve& light, double low_nm, double high_nm) {
  const NeededRange support = support_range(weight);
  if (support.low_nm >= low_nm && support.high_nm <= high_nm) return {};
  const double from = std::clamp(low_nm, support.low_nm, support.high_nm);
  const double to = std::clamp(high_nm, support.low_nm, support.high_nm);
  const Integral below = magnitude_of_product(weight, light, support.low_nm, from);
  const Integral within = magnitude_of_product(weight, light, from, to);
  const Integral above = magnitude_of_product(weight, light, to, support.high_nm);
  const double outside = below.value + above.value;
  return {outside > 0 ? outside / (outside + within.value) : 0, below.pieces + within.pieces + above.pieces};
}

NeededRange main_range(const Curve& curve) {
  const Curve all = magnitude(curve);
  const double negligible = kNegligibleFraction * all.integral();
  const std::vector<Knot> upwards(all.knots().begin(), all.knots().end());
  const std::vector<Knot> downwards(upwards.rbegin(), upwards.rend());
  return {std::floor(last_within(upwards, negligible)), std::ceil(last_within(downwards, negligible))};
}

Curve extrapolated(const NamedCurve& table) {
  std::vector<Knot> knots;
  for (const Knot& knot : table.curve.knots()) {
    if (knot.wavelength_nm < table.low_nm || knot.wavelength_nm > table.high_nm) continue;
    if (knot.wavelength_nm == table.low_nm)
      knots.clear();  // at a rise from 0, the upper knot is the first row
    knots.push_back(knot);
  }
  return Curve(std::move(knots));
}

}  // namespace abbe
