#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "materials/bsdf/lookup.h"
#include "materials/texture/texture_image.h"
#include "spectral/curve.h"

namespace abbe {

/// A quantity in [0, 1] over wavelength and the surface: one curve everywhere, or a sum of spectra whose
/// weights are the channels of an image.
class SpectralTexture {
 public:
  /// A quantity that is the same everywhere.
  SpectralTexture(Curve curve) : curve_(std::move(curve)) {}
  /// The sum over channels c of (value of c) * spectra[c]. Throws Error{internal} unless there is a spectrum
  /// for each.
  SpectralTexture(TextureImage image, std::vector<Curve> spectra);

  /// The sum is held in [0, 1], which rounding may leave.
  [[nodiscard]] SampledSpectrum operator()(const SurfaceLookup& at) const {
    return image_ ? of_image(at) : curve_(at.wavelengths_nm);
  }

  /// Whether it differs from place to place.
  [[nodiscard]] bool textured() const { return image_ != nullptr; }
  /// What it is everywhere; zero if it is `textured`.
  [[nodiscard]] const Curve& curve() const { return curve_; }
  /// Bytes of the image, 0 if there is none.
  [[nodiscard]] std::size_t memory_bytes() const { return image_ ? image_->image.memory_bytes() : 0; }

 private:
  struct Weighted {
    TextureImage image;
    std::vector<Curve> spectra;
  };
  [[nodiscard]] SampledSpectrum of_image(const SurfaceLookup& at) const;

  Curve curve_;
  std::shared_ptr<const Weighted> image_;
};

}  // namespace abbe
