#include "spectral/curve.h"

#include <array>
#include <functional>
#include <iterator>
#include <limits>

#include "io/error.h"

namespace abbe {
namespace {

constexpr int kCells = kMaxWavelengthNm - kMinWavelengthNm;
constexpr float kLow = kMinWavelengthNm;
constexpr float kHigh = kMaxWavelengthNm;

double between(const Knot& a, const Knot& b, double wavelength_nm) {
  return a.value +
         (b.value - a.value) * ((wavelength_nm - a.wavelength_nm) / (b.wavelength_nm - a.wavelength_nm));
}

double left_limit(std::span<const Knot> knots, double wavelength_nm) {
  const auto at = std::ranges::lower_bound(knots, wavelength_nm, {}, &Knot::wavelength_nm);
  if (at == knots.end()) return knots.back().value;
  if (at == knots.begin() || at->wavelength_nm == wavelength_nm) return at->value;
  return between(*std::prev(at), *at, wavelength_nm);
}

double right_limit(std::span<const Knot> knots, double wavelength_nm) {
  const auto after = std::ranges::upper_bound(knots, wavelength_nm, {}, &Knot::wavelength_nm);
  if (after == knots.begin()) return knots.front().value;
  const Knot& before = *std::prev(after);
  if (after == knots.end() || before.wavelength_nm == wavelength_nm) return before.value;
  return between(before, *after, wavelength_nm);
}

void append(std::vector<Knot>& knots, double wavelength_nm, double left, double right) {
  knots.push_back({wavelength_nm, left});
  if (right != left) knots.push_back({wavelength_nm, right});
}

std::vector<Knot> cut_to_range(std::span<const Knot> knots) {
  std::vector<Knot> cut;
  cut.reserve(knots.size() + 2);
  cut.push_back({kMinWavelengthNm, right_limit(knots, kMinWavelengthNm)});
  for (const Knot& knot : knots)
    if (knot.wavelength_nm > kMinWavelengthNm && knot.wavelength_nm < kMaxWavelengthNm) cut.push_back(knot);
  append(cut, kMaxWavelengthNm, left_limit(knots, kMaxWavelengthNm), right_limit(knots, kMaxWavelengthNm));
  return cut;
}

void require_valid(std::span<const Knot> knots) {
  const auto finite = [](const Knot& knot) {
    return std::isfinite(knot.wavelength_nm) && std::isfinite(knot.value);
  };
  if (knots.empty() || !std::ranges::all_of(knots, finite) ||
      !std::ranges::is_sorted(knots, {}, &Knot::wavelength_nm))
    throw Error(ErrorCode::internal, "curve", "knots must be present, finite and sorted by wavelength");
}

/// Distance of the wavelengths from the lower end of the range; wavelengths outside it are clamped.
SampledSpectrum offsets(const SampledSpectrum& wavelengths_nm) {
  const auto below = SampledSpectrum::map(wavelengths_nm, [](float nm) { return std::min(kHigh, nm); });
  return SampledSpectrum::map(below, [](float nm) { return std::max(kLow, nm); }) - SampledSpectrum(kLow);
}

std::vector<double> breakpoints(const Curve& a, const Curve& b) {
  std::vector<double> all;
  all.reserve(a.knots().size() + b.knots().size());
  for (const Knot& knot : a.knots()) all.push_back(knot.wavelength_nm);
  for (const Knot& knot : b.knots()) all.push_back(knot.wavelength_nm);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Largest allowed deviation of a product from the chord between two knots, relative to its largest
/// magnitude. Smooth curves with knots at every nanometre rarely exceed it, so their cells need no search.
constexpr double kLargestBend = 1e-4;

/// Product of two lines between two wavelengths, given by its values at both and at the midpoint.
struct Parabola {
  double from_nm;
  double to_nm;
  double first;
  double midpoint;
  double last;
};

/// Product of two curves between their knots and whole nanometres, ascending.
std::vector<Parabola> parabolas_of(const Curve& a, const Curve& b) {
  CurveCursor piece_a(a, kMinWavelengthNm);
  CurveCursor piece_b(b, kMinWavelengthNm);
  const auto value = [&](double nm) { return piece_a(nm) * piece_b(nm); };
  std::vector<Parabola> parabolas;
  parabolas.reserve(kCells + a.knots().size() + b.knots().size());
  for (double from = kMinWavelengthNm; from < kMaxWavelengthNm;) {
    const double to = std::min({piece_a.end_nm(), piece_b.end_nm(), std::floor(from) + 1});
    parabolas.push_back({from, to, value(from), value((from + to) / 2), value(to)});
    piece_a.advance_to(to);
    piece_b.advance_to(to);
    from = to;
  }
  return parabolas;
}

/// Adds evenly spaced knots inside a parabola that deviates too far from its chord, relative to `greatest`.
void append_between(std::vector<Knot>& knots, const Parabola& p, double greatest) {
  // The parabola lies q t (1 - t) below the chord at the fraction t of its width, q/4 at the midpoint.
  const double q = 2 * (p.first - 2 * p.midpoint + p.last);
  if (q == 0) return;               // common where both factors are 0
  constexpr double kJumpNm = 1e-9;  // a table that is 0 outside falls within this width after its last row
  const double parts = std::ceil(std::sqrt(std::abs(q / greatest) / (4 * kLargestBend)));
  if (!(parts > 1) || p.to_nm - p.from_nm < kJumpNm) return;
  // n chords have an excess area of q / (6 n^2), which lowering the n - 1 inner knots removes.
  const double lower = q / (6 * parts * (parts - 1));
  for (int i = 1; i < static_cast<int>(parts); ++i) {
    const double t = i / parts;
    knots.push_back(
        {std::lerp(p.from_nm, p.to_nm, t), std::lerp(p.first, p.last, t) - q * t * (1 - t) - lower});
  }
}

}  // namespace

Curve::Curve() : Curve(0.0) {}

Curve::Curve(double value) : Curve(std::vector<Knot>{{kMinWavelengthNm, value}}) {}

Curve::Curve(std::vector<Knot> knots) {
  require_valid(knots);
  knots_ = cut_to_range(knots);
  const auto [low, high] = std::ranges::minmax_element(knots_, {}, &Knot::value);
  min_ = low->value;
  max_ = high->value;
  cells_.reserve(kCells + 1);
  packet_cells_.reserve(kCells + 1);
  std::size_t next = 0;  // first knot to the right of the left end of the cell
  for (int i = 0; i <= kCells; ++i) {
    const double left = kMinWavelengthNm + i;
    while (next < knots_.size() && knots_[next].wavelength_nm <= left) ++next;
    const bool last = i == kCells;
    const double value = right_limit(knots_, left);
    const double slope = last ? 0 : left_limit(knots_, left + 1) - value;
    const bool searched = !last && knots_[next].wavelength_nm < left + 1;
    cells_.push_back({value, slope, static_cast<std::uint32_t>(next - 1), searched});
    packet_cells_.push_back({searched ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value),
                             static_cast<float>(slope)});
  }
}

double Curve::operator()(double wavelength_nm) const {
  // The comparison sends a NaN to the lower end, so that it cannot index outside the table.
  const double clamped =
      wavelength_nm > kMinWavelengthNm ? std::min<double>(wavelength_nm, kMaxWavelengthNm) : kMinWavelengthNm;
  const double offset = clamped - kMinWavelengthNm;
  const auto i = static_cast<std::size_t>(offset);
  const Cell& cell = cells_[i];
  if (!cell.searched) return cell.value + cell.slope * (offset - static_cast<double>(i));
  const auto after =
      std::ranges::upper_bound(knots_.begin() + cell.first, knots_.begin() + cells_[i + 1].first + 1, clamped,
                               {}, &Knot::wavelength_nm);
  return between(*std::prev(after), *after, clamped);
}

SampledSpectrum Curve::operator()(const SampledSpectrum& wavelengths_nm) const {
  if (is_constant()) return SampledSpectrum(static_cast<float>(knots_.front().value));
  // All but the look-up operates on whole vectors.
  const SampledSpectrum::Values offset = offsets(wavelengths_nm).values();
  std::array<std::int32_t, kLanes> index;
  SampledSpectrum::Values value;
  SampledSpectrum::Values slope;
  SampledSpectrum::Values within;
  for (std::size_t i = 0; i < kLanes; ++i) index[i] = static_cast<std::int32_t>(offset[i]);
  for (std::size_t i = 0; i < kLanes; ++i) within[i] = offset[i] - static_cast<float>(index[i]);
  for (std::size_t i = 0; i < kLanes; ++i) {
    const PacketCell& cell = packet_cells_[static_cast<std::uint32_t>(index[i])];
    value[i] = cell.value;
    slope[i] = cell.slope;
  }
  const SampledSpectrum values = SampledSpectrum(value) + SampledSpectrum(slope) * SampledSpectrum(within);
  return values.has_nan() ? searched(values, wavelengths_nm) : values;
}

// Not inlined: few cells have inner knots.
[[gnu::noinline]] SampledSpectrum Curve::searched(const SampledSpectrum& values,
                                                  const SampledSpectrum& wavelengths_nm) const {
  return SampledSpectrum::map(values, wavelengths_nm, [this](float value, float nm) {
    return std::isnan(value) ? static_cast<float>((*this)(static_cast<double>(nm))) : value;
  });
}

double Curve::integral(double low_nm, double high_nm) const {
  const double low = std::max<double>(low_nm, kMinWavelengthNm);
  const double high = std::min<double>(high_nm, kMaxWavelengthNm);
  double total = 0;
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const double from = std::max(low, knots_[i - 1].wavelength_nm);
    const double to = std::min(high, knots_[i].wavelength_nm);
    if (from < to) total += (to - from) * between(knots_[i - 1], knots_[i], 0.5 * (from + to));
  }
  return total;
}

double integral_of_product(const Curve& a, const Curve& b, double low_nm, double high_nm) {
  static const Curve one(1.0);
  return integral_of_product(a, b, one, low_nm, high_nm);
}

double integral_of_product(const Curve& a, const Curve& b, const Curve& c, double low_nm, double high_nm) {
  const double low = std::max<double>(low_nm, kMinWavelengthNm);
  const double high = std::min<double>(high_nm, kMaxWavelengthNm);
  std::array<CurveCursor, 3> pieces{{{a, low}, {b, low}, {c, low}}};
  const auto value = [&](double nm) { return pieces[0](nm) * pieces[1](nm) * pieces[2](nm); };
  double total = 0;
  for (double from = low; from < high;) {
    const double to = std::min({pieces[0].end_nm(), pieces[1].end_nm(), pieces[2].end_nm(), high});
    // Simpson's rule is exact for the product of three lines.
    total += (to - from) / 6 * (value(from) + 4 * value((from + to) / 2) + value(to));
    for (CurveCursor& piece : pieces) piece.advance_to(to);
    from = to;
  }
  return total;
}

Curve product(const Curve& a, const Curve& b) {
  if (a.is_constant()) return scaled(b, a.min());
  if (b.is_constant()) return scaled(a, b.min());
  const std::vector<Parabola> parabolas = parabolas_of(a, b);
  double greatest = 0;
  for (const Parabola& p : parabolas)
    greatest = std::max({greatest, std::abs(p.first), std::abs(p.midpoint), std::abs(p.last)});
  std::vector<Knot> knots;
  knots.reserve(parabolas.size() + 2);
  for (const Parabola& p : parabolas) {
    if (knots.empty() || knots.back().value != p.first) knots.push_back({p.from_nm, p.first});
    append_between(knots, p, greatest);
    knots.push_back({p.to_nm, p.last});
  }
  knots.push_back({kMaxWavelengthNm, a(kMaxWavelengthNm) * b(kMaxWavelengthNm)});
  return Curve(std::move(knots));
}

Curve sum(const Curve& a, const Curve& b) {
  std::vector<Knot> knots;
  for (const double nm : breakpoints(a, b))
    append(knots, nm, left_limit(a.knots(), nm) + left_limit(b.knots(), nm),
           right_limit(a.knots(), nm) + right_limit(b.knots(), nm));
  return Curve(std::move(knots));
}

Curve scaled(const Curve& curve, double factor) {
  std::vector<Knot> knots(curve.knots().begin(), curve.knots().end());
  for (Knot& knot : knots) knot.value *= factor;
  return Curve(std::move(knots));
}

Curve table_curve(std::span<const double> wavelengths_nm, std::span<const double> values, Outside outside) {
  if (wavelengths_nm.empty() || wavelengths_nm.size() != values.size() ||
      std::ranges::adjacent_find(wavelengths_nm, std::greater_equal<>{}) != wavelengths_nm.end())
    throw Error(ErrorCode::internal, "table", "needs one value per wavelength, strictly ascending");
  std::vector<Knot> knots;
  knots.reserve(values.size() + 2);
  if (outside == Outside::zero) knots.push_back({wavelengths_nm.front(), 0});
  for (std::size_t i = 0; i < values.size(); ++i) knots.push_back({wavelengths_nm[i], values[i]});
  // The last row applies at its own wavelength, so the fall to zero comes at the next representable number.
  if (outside == Outside::zero)
    knots.push_back({std::nextafter(wavelengths_nm.back(), std::numeric_limits<double>::max()), 0});
  return Curve(std::move(knots));
}

}  // namespace abbe
