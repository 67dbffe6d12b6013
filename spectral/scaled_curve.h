#pragma once

#include <memory>
#include <utility>

#include "spectral/curve.h"

namespace abbe {

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
