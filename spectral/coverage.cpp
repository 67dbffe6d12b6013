#include "spectral/coverage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "spectral/straight_piece.h"

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

// The wavelengths between the knots around all values other than 0; its ends are in the other order where
// there are none.
NeededRange support_range(const Curve& curve) {
  const std::span<const Knot> knots = curve.knots();
  const auto is_lit = [](const Knot& knot) { return knot.value != 0; };
  const auto first = std::find_if(knots.begin(), knots.end(), is_lit);
  if (first == knots.end()) return {kMaxWavelengthNm, kMinWavelengthNm};
  const auto after = std::find_if(knots.rbegin(), knots.rend(), is_lit).base();
  return {(first == knots.begin() ? first : std::prev(first))->wavelength_nm,
          (after == knots.end() ? std::prev(after) : after)->wavelength_nm};
}

struct Integral {
  double value = 0;
  std::size_t pieces = 0;
};

// The integral of |a b| over a range, exact but where one of them changes its sign between two knots.
Integral magnitude_of_product(const Curve& a, const Curve& b, double low_nm, double high_nm) {
  StraightPiece piece_a(a, low_nm);
  StraightPiece piece_b(b, low_nm);
  const auto magnitude = [&](double nm) { return std::abs(piece_a(nm) * piece_b(nm)); };
  Integral sum;
  for (double from = low_nm; from < high_nm; ++sum.pieces) {
    const double to = std::min({piece_a.end_nm(), piece_b.end_nm(), high_nm});
    // Simpson's rule, exact for the product of two lines.
    sum.value += (to - from) / 6 * (magnitude(from) + 4 * magnitude((from + to) / 2) + magnitude(to));
    piece_a.go_to(to);
    piece_b.go_to(to);
    from = to;
  }
  return sum;
}

}  // namespace

ShareBeyond share_beyond(const Curve& weight, const Curve& light, double low_nm, double high_nm) {
  const NeededRange seen = support_range(weight);
  if (seen.low_nm >= low_nm && seen.high_nm <= high_nm) return {};
  const double from = std::clamp(low_nm, seen.low_nm, seen.high_nm);
  const double to = std::clamp(high_nm, seen.low_nm, seen.high_nm);
  const Integral below = magnitude_of_product(weight, light, seen.low_nm, from);
  const Integral within = magnitude_of_product(weight, light, from, to);
  const Integral above = magnitude_of_product(weight, light, to, seen.high_nm);
  const double beyond = below.value + above.value;
  return {beyond > 0 ? beyond / (beyond + within.value) : 0, below.pieces + within.pieces + above.pieces};
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
