#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "materials/index/relative_index.h"
#include "materials/texture/texture_image.h"
#include "spectral/curve.h"

namespace abbe {

/// A quantity in [0, 1] over wavelength and surface: one curve everywhere, or a sum of spectra weighted by
/// the channels of an image.
class SpectralTexture {
 public:
  SpectralTexture(Curve curve) : curve_(std::move(curve)) {}
  /// The sum over channels c of the image of (value of c) * spectra[c]. Throws Error{internal} unless each
  /// channel has a spectrum.
  SpectralTexture(TextureImage image, std::vector<Curve> spectra);

  /// The value at each wavelength. With an image it is clamped to [0, 1] against rounding errors.
  [[nodiscard]] SampledSpectrum operator()(const SurfaceLookup& at) const {
    return image_ ? of_image(at) : curve_(at.wavelengths_nm);
  }

  /// The value at one wavelength [nm]; empty if `textured` and the coordinates are unknown.
  [[nodiscard]] std::optional<double> at(double wavelength_nm, std::optional<Imath::V2f> coordinates) const;

  [[nodiscard]] bool textured() const { return image_ != nullptr; }  ///< True if it varies over the surface.
  /// The uniform value; zero if `textured`.
  [[nodiscard]] const Curve& curve() const { return curve_; }
  /// Size of the image in bytes; 0 without an image.
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
