#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "spectral/curve.h"

namespace abbe {

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

}  // namespace abbe
