#pragma once

#include <memory>
#include <utility>

#include "spectral/curve.h"

namespace abbe {

/// A curve times a factor >= 0. Proportional ones share their curve, so that each costs no more than its
/// factor.
class ScaledCurve {
 public:
  /// The curve itself, shared with no other.
  ScaledCurve(Curve curve) : ScaledCurve(std::make_shared<const Curve>(std::move(curve)), 1) {}
  ScaledCurve(std::shared_ptr<const Curve> base, double factor) : base_(std::move(base)), factor_(factor) {}

  /// Values as those of a `Curve`. A factor that is a power of two leaves their digits alone.
  [[nodiscard]] double operator()(double wavelength_nm) const { return factor_ * (*base_)(wavelength_nm); }
  [[nodiscard]] SampledSpectrum operator()(const SampledSpectrum& wavelengths_nm) const {
    return (*base_)(wavelengths_nm) * static_cast<float>(factor_);
  }

  /// What is shared: the curve for a factor of 1.
  [[nodiscard]] const Curve& base() const { return *base_; }
  [[nodiscard]] double factor() const { return factor_; }
  [[nodiscard]] double max() const { return factor_ * base_->max(); }
  /// The product as a curve of its own.
  [[nodiscard]] Curve curve() const { return scaled(*base_, factor_); }

 private:
  std::shared_ptr<const Curve> base_;
  double factor_;
};

}  // namespace abbe
