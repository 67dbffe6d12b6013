#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "io/table.h"
#include "spectral/sampled_spectrum.h"

namespace abbe {

/// Range of wavelengths [nm] of a render. Every curve is defined on all of it.
inline constexpr int kMinWavelengthNm = 300;
inline constexpr int kMaxWavelengthNm = 1100;

/// A point of a piecewise linear curve.
struct Knot {
  double wavelength_nm;
  double value;
};

/// A function of wavelength on [300, 1100] nm, piecewise linear between knots. Two knots at the same
/// wavelength are a jump, where the value is that on its right. Tables and bands are represented exactly,
/// smooth formulas are sampled every 1 nm. Cells of 1 nm make evaluation O(1). The owner of a curve defines
/// the unit of its values. Immutable, so that several threads can use it.
class Curve {
 public:
  /// Zero everywhere.
  Curve();
  /// The constant `value`. Throws Error{internal} unless it is finite.
  explicit Curve(double value);
  /// Interpolates `knots`, which are sorted by wavelength; constant before the first and after the last.
  /// Knots outside [300, 1100] nm are cut, where the curve has its value at the end of the range. Throws
  /// Error{internal} unless the knots are sorted, finite and non-empty.
  explicit Curve(std::vector<Knot> knots);

  /// Value at a wavelength [nm]; a wavelength outside [300, 1100] takes the value at the nearer end, NaN that
  /// at 300 nm.
  [[nodiscard]] double operator()(double wavelength_nm) const;
  /// Values at several wavelengths [nm], which must not be NaN, accurate to a few float ulps of the larger
  /// end of a cell.
  [[nodiscard]] SampledSpectrum operator()(const SampledSpectrum& wavelengths_nm) const;

  /// Knots by ascending wavelength. The first is at 300 nm, the last at 1100 nm.
  [[nodiscard]] std::span<const Knot> knots() const { return knots_; }
  /// Exact integral [value nm] over [low_nm, high_nm], which is cut to [300, 1100] nm; 0 for an empty range.
  [[nodiscard]] double integral(double low_nm = kMinWavelengthNm, double high_nm = kMaxWavelengthNm) const;
  [[nodiscard]] double max() const { return max_; }
  [[nodiscard]] double min() const { return min_; }
  [[nodiscard]] bool is_constant() const { return min_ == max_; }
  [[nodiscard]] std::size_t memory_bytes() const {
    return sizeof(Curve) + knots_.size() * sizeof(Knot) + cells_.size() * sizeof(Cell) +
           packet_cells_.size() * sizeof(PacketCell);
  }

 private:
  // A cell [i, i+1) nm without an inner knot is value + slope (lambda - i). A cell with inner knots is
  // searched from `first`.
  struct Cell {
    double value;
    double slope;
    std::uint32_t first;
    bool searched;
  };
  // Float copy of a cell for packets; NaN for a cell that is searched.
  struct PacketCell {
    float value;
    float slope;
  };
  // Completes `values`, in which wavelengths of searched cells are NaN, by searching those cells.
  [[nodiscard]] SampledSpectrum searched(const SampledSpectrum& values,
                                         const SampledSpectrum& wavelengths_nm) const;

  std::vector<Knot> knots_;
  std::vector<Cell> cells_;
  std::vector<PacketCell> packet_cells_;
  double min_;
  double max_;
};

/// Exact integral [product nm] of two or three curves over [low_nm, high_nm], which is cut to [300, 1100] nm.
/// It is 0 for an empty range.
[[nodiscard]] double integral_of_product(const Curve& a, const Curve& b, double low_nm = kMinWavelengthNm,
                                         double high_nm = kMaxWavelengthNm);
[[nodiscard]] double integral_of_product(const Curve& a, const Curve& b, const Curve& c,
                                         double low_nm = kMinWavelengthNm, double high_nm = kMaxWavelengthNm);

/// Pointwise product, exact at all knots of both curves and at every nanometre. If it deviates from the chord
/// between two of these by more than 1e-4 of its largest magnitude, further knots are added. They limit the
/// deviation to 2e-4 and make the area exact. This happens where the edges of two filters overlap.
[[nodiscard]] Curve product(const Curve& a, const Curve& b);
/// Pointwise sum, or multiple by a finite `factor` of any sign; exact everywhere.
[[nodiscard]] Curve sum(const Curve& a, const Curve& b);
[[nodiscard]] Curve scaled(const Curve& curve, double factor);

/// Curve through a table of samples, linear between them. Outside them it is 0 for Outside::zero, otherwise
/// the value of the nearer end; the caller checks the coverage for Outside::error. The last row still applies
/// at its own wavelength. Throws Error{internal} unless there is one finite value for each of at least one
/// strictly ascending wavelengths.
[[nodiscard]] Curve table_curve(std::span<const double> wavelengths_nm, std::span<const double> values,
                                Outside outside);

/// Cursor on the linear pieces of a curve, which only advances. The curve must outlive it.
class CurveCursor {
 public:
  /// Begins at the piece that starts at or contains `from_nm`, within [300, 1100] nm.
  CurveCursor(const Curve& curve, double from_nm) : knots_(curve.knots()) { advance_to(from_nm); }

  /// End of the current piece [nm]; requires a piece that begins below 1100 nm.
  [[nodiscard]] double end_nm() const { return knots_[at_ + 1].wavelength_nm; }
  /// Value at a wavelength within the current piece. At both ends it is that of the knots: at the upper one
  /// the value to the left of a jump.
  [[nodiscard]] double operator()(double nm) const {
    const Knot& a = knots_[at_];
    const Knot& b = knots_[at_ + 1];
    return std::lerp(a.value, b.value, (nm - a.wavelength_nm) / (b.wavelength_nm - a.wavelength_nm));
  }
  /// Advances to the piece that starts at or contains `nm`, between the current piece and 1100 nm. No piece
  /// remains at 1100 nm.
  void advance_to(double nm) {
    const auto after = std::upper_bound(knots_.begin() + static_cast<std::ptrdiff_t>(at_), knots_.end(), nm,
                                        [](double x, const Knot& knot) { return x < knot.wavelength_nm; });
    at_ = static_cast<std::size_t>(after - knots_.begin()) - 1;
  }

 private:
  std::span<const Knot> knots_;
  std::size_t at_ = 0;
};

/// A curve times a factor >= 0. Proportional curves have a common base, so that each costs only its factor.
class ScaledCurve {
 public:
  /// A curve with factor 1 and a base of its own.
  ScaledCurve(Curve curve) : ScaledCurve(std::make_shared<const Curve>(std::move(curve)), 1) {}
  /// `base`, which must not be null, times `factor`.
  ScaledCurve(std::shared_ptr<const Curve> base, double factor) : base_(std::move(base)), factor_(factor) {}

  /// Value of the product at wavelengths [nm]. A factor that is a power of two changes no digits.
  [[nodiscard]] double operator()(double wavelength_nm) const { return factor_ * (*base_)(wavelength_nm); }
  [[nodiscard]] SampledSpectrum operator()(const SampledSpectrum& wavelengths_nm) const {
    return (*base_)(wavelengths_nm) * static_cast<float>(factor_);
  }

  /// Base curve, for a factor of 1.
  [[nodiscard]] const Curve& base() const { return *base_; }
  [[nodiscard]] double factor() const { return factor_; }
  /// Largest value of the product.
  [[nodiscard]] double max() const { return factor_ * base_->max(); }
  /// Product as a curve of its own.
  [[nodiscard]] Curve curve() const { return scaled(*base_, factor_); }

 private:
  std::shared_ptr<const Curve> base_;
  double factor_;
};

}  // namespace abbe
