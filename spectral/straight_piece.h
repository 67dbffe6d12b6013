#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "spectral/curve.h"

namespace abbe {

/// The straight piece of a curve that holds from a wavelength on, to walk along the curve.
class StraightPiece {
 public:
  /// The piece that holds from `from_nm` on, within [300, 1100] nm.
  StraightPiece(const Curve& curve, double from_nm) : knots_(curve.knots()) { go_to(from_nm); }

  /// Where it ends [nm]; of a piece that begins below 1100 nm.
  [[nodiscard]] double end_nm() const { return knots_[at_ + 1].wavelength_nm; }
  /// Its value there, at both of its ends those of the knots: at the upper one that on the left of a jump.
  [[nodiscard]] double operator()(double nm) const {
    const Knot& a = knots_[at_];
    const Knot& b = knots_[at_ + 1];
    return std::lerp(a.value, b.value, (nm - a.wavelength_nm) / (b.wavelength_nm - a.wavelength_nm));
  }
  /// Goes up to the piece that holds from `nm` on.
  void go_to(double nm) {
    const auto after = std::upper_bound(knots_.begin() + static_cast<std::ptrdiff_t>(at_), knots_.end(), nm,
                                        [](double x, const Knot& knot) { return x < knot.wavelength_nm; });
    at_ = static_cast<std::size_t>(after - knots_.begin()) - 1;
  }

 private:
  std::span<const Knot> knots_;
  std::size_t at_ = 0;
};

}  // namespace abbe
