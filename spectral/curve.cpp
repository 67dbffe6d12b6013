#include "spectral/curve.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

#include "io/error.h"

namespace abbe {
namespace {

constexpr int kCells = kMaxWavelengthNm - kMinWavelengthNm;
constexpr float kLow = kMinWavelengthNm;
constexpr float kHigh = kMaxWavelengthNm;

struct ByWavelength {
  bool operator()(const Knot& knot, double wavelength_nm) const { return knot.wavelength_nm < wavelength_nm; }
  bool operator()(double wavelength_nm, const Knot& knot) const { return wavelength_nm < knot.wavelength_nm; }
};

double between(const Knot& a, const Knot& b, double wavelength_nm) {
  return a.value +
         (b.value - a.value) * ((wavelength_nm - a.wavelength_nm) / (b.wavelength_nm - a.wavelength_nm));
}

double left_limit(std::span<const Knot> knots, double wavelength_nm) {
  const auto at = std::lower_bound(knots.begin(), knots.end(), wavelength_nm, ByWavelength{});
  if (at == knots.end()) return knots.back().value;
  if (at == knots.begin() || at->wavelength_nm == wavelength_nm) return at->value;
  return between(*std::prev(at), *at, wavelength_nm);
}

double right_limit(std::span<const Knot> knots, double wavelength_nm) {
  const auto after = std::upper_bound(knots.begin(), knots.end(), wavelength_nm, ByWavelength{});
  if (after == knots.begin()) return knots.front().value;
  const Knot& before = *std::prev(after);
  if (after == knots.end() || before.wavelength_nm == wavelength_nm) return before.value;
  return between(before, *after, wavelength_nm);
}

void append(std::vector<Knot>& knots, double wavelength_nm, double left, double right) {
  knots.push_back({wavelength_nm, left});
  if (right != left) knots.push_back({wavelength_nm, right});
}

/// The function on exactly [300, 1100] nm.
std::vector<Knot> cut_to_range(std::span<const Knot> knots) {
  std::vector<Knot> cut;
  cut.reserve(knots.size() + 2);
  cut.push_back({kMinWavelengthNm, right_limit(knots, kMinWavelengthNm)});
  for (const Knot& knot : knots) {
    if (knot.wavelength_nm > kMinWavelengthNm && knot.wavelength_nm < kMaxWavelengthNm) cut.push_back(knot);
  }
  append(cut, kMaxWavelengthNm, left_limit(knots, kMaxWavelengthNm), right_limit(knots, kMaxWavelengthNm));
  return cut;
}

void require_valid(std::span<const Knot> knots) {
  const auto finite = [](const Knot& knot) {
    return std::isfinite(knot.wavelength_nm) && std::isfinite(knot.value);
  };
  const auto later = [](const Knot& a, const Knot& b) { return a.wavelength_nm < b.wavelength_nm; };
  if (knots.empty() || !std::all_of(knots.begin(), knots.end(), finite) ||
      !std::is_sorted(knots.begin(), knots.end(), later)) {
    throw Error(ErrorCode::internal, "curve", "knots must be present, finite and sorted by wavelength");
  }
}

/// How far the lanes are from the lower end of the range, those beyond its ends being taken there.
SampledSpectrum offsets(const SampledSpectrum& wavelengths_nm) {
  const auto below = SampledSpectrum::map(wavelengths_nm, [](float nm) { return std::min(kHigh, nm); });
  return SampledSpectrum::map(below, [](float nm) { return std::max(kLow, nm); }) - SampledSpectrum(kLow);
}

/// Wavelengths where either curve bends or jumps, ascending.
std::vector<double> breakpoints(const Curve& a, const Curve& b) {
  std::vector<double> all;
  all.reserve(a.knots().size() + b.knots().size());
  for (const Knot& knot : a.knots()) all.push_back(knot.wavelength_nm);
  for (const Knot& knot : b.knots()) all.push_back(knot.wavelength_nm);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

Curve::Curve() : Curve(0.0) {}

Curve::Curve(double value) : Curve(std::vector<Knot>{{kMinWavelengthNm, value}}) {}

Curve::Curve(std::vector<Knot> knots) {
  require_valid(knots);
  knots_ = cut_to_range(knots);
  const auto [low, high] = std::minmax_element(
      knots_.begin(), knots_.end(), [](const Knot& a, const Knot& b) { return a.value < b.value; });
  min_ = low->value;
  max_ = high->value;
  cells_.reserve(kCells + 1);
  packet_cells_.reserve(kCells + 1);
  std::size_t next = 0;  // first knot beyond the left end of the cell
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
  // Written so that a NaN takes the lower end instead of indexing out of the table.
  const double clamped =
      wavelength_nm > kMinWavelengthNm ? std::min<double>(wavelength_nm, kMaxWavelengthNm) : kMinWavelengthNm;
  const double offset = clamped - kMinWavelengthNm;
  const auto i = static_cast<std::size_t>(offset);
  const Cell& cell = cells_[i];
  if (!cell.searched) return cell.value + cell.slope * (offset - static_cast<double>(i));
  const auto after = std::upper_bound(knots_.begin() + cell.first, knots_.begin() + cells_[i + 1].first + 1,
                                      clamped, ByWavelength{});
  return between(*std::prev(after), *after, clamped);
}

SampledSpectrum Curve::operator()(const SampledSpectrum& wavelengths_nm) const {
  if (is_constant()) return SampledSpectrum(static_cast<float>(knots_.front().value));
  // All but the look-up itself is done on whole vectors.
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

// Few cells have inner knots; out of the others' way.
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

double integral_of_product(const Curve& a, const Curve& b) {
  const std::vector<double> edges = breakpoints(a, b);
  double total = 0;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const double a0 = right_limit(a.knots(), edges[i - 1]);
    const double a1 = left_limit(a.knots(), edges[i]);
    const double b0 = right_limit(b.knots(), edges[i - 1]);
    const double b1 = left_limit(b.knots(), edges[i]);
    // Simpson's rule, exact for the product of two lines.
    total += (edges[i] - edges[i - 1]) / 6 * (a0 * b0 + (a0 + a1) * (b0 + b1) + a1 * b1);
  }
  return total;
}

Curve product(const Curve& a, const Curve& b) {
  if (a.is_constant()) return scaled(b, a.min());
  if (b.is_constant()) return scaled(a, b.min());
  std::vector<double> at = breakpoints(a, b);
  const auto bends = static_cast<std::ptrdiff_t>(at.size());
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm) at.push_back(nm);
  std::inplace_merge(at.begin(), at.begin() + bends, at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  std::vector<Knot> knots;
  knots.reserve(at.size());
  for (const double nm : at) {
    append(knots, nm, left_limit(a.knots(), nm) * left_limit(b.knots(), nm),
           right_limit(a.knots(), nm) * right_limit(b.knots(), nm));
  }
  return Curve(std::move(knots));
}

Curve sum(const Curve& a, const Curve& b) {
  std::vector<Knot> knots;
  for (const double nm : breakpoints(a, b)) {
    append(knots, nm, left_limit(a.knots(), nm) + left_limit(b.knots(), nm),
           right_limit(a.knots(), nm) + right_limit(b.knots(), nm));
  }
  return Curve(std::move(knots));
}

Curve scaled(const Curve& curve, double factor) {
  std::vector<Knot> knots(curve.knots().begin(), curve.knots().end());
  for (Knot& knot : knots) knot.value *= factor;
  return Curve(std::move(knots));
}

Curve table_curve(std::span<const double> wavelengths_nm, std::span<const double> values, Outside outside) {
  const bool ascending = std::adjacent_find(wavelengths_nm.begin(), wavelengths_nm.end(),
                                            std::greater_equal<>{}) == wavelengths_nm.end();
  if (wavelengths_nm.empty() || wavelengths_nm.size() != values.size() || !ascending) {
    throw Error(ErrorCode::internal, "table", "needs one value per wavelength, strictly ascending");
  }
  std::vector<Knot> knots;
  knots.reserve(values.size() + 2);
  if (outside == Outside::zero) knots.push_back({wavelengths_nm.front(), 0});
  for (std::size_t i = 0; i < values.size(); ++i) knots.push_back({wavelengths_nm[i], values[i]});
  if (outside == Outside::zero) {
    // The last row still holds at its own wavelength, so the fall to zero comes at the next representable
    // number.
    knots.push_back({std::nextafter(wavelengths_nm.back(), std::numeric_limits<double>::max()), 0});
  }
  return Curve(std::move(knots));
}

}  // namespace abbe
