#include "materials/texture/spectral_texture.h"

#include <algorithm>

#include "io/error.h"

namespace abbe {

SpectralTexture::SpectralTexture(TextureImage image, std::vector<Curve> spectra)
    : image_(std::make_shared<const Weighted>(Weighted{std::move(image), std::move(spectra)})) {
  if (image_->spectra.size() != image_->image.channels())
    throw Error(ErrorCode::internal, "texture", "a spectrum is needed for each channel");
}

std::optional<double> SpectralTexture::at(double wavelength_nm, std::optional<Imath::V2f> coordinates) const {
  if (!textured()) return curve_(wavelength_nm);
  if (!coordinates) return std::nullopt;
  const SampledSpectrum wavelengths_nm(static_cast<float>(wavelength_nm));
  return of_image({wavelengths_nm, *coordinates})[0];
}

SampledSpectrum SpectralTexture::of_image(const SurfaceLookup& at) const {
  const TextureImage::Blend blend = image_->image.blend(at.uv);
  SampledSpectrum sum;
  for (std::size_t c = 0; c < image_->spectra.size(); ++c)
    sum += image_->spectra[c](at.wavelengths_nm) * image_->image.value(blend, c);
  return SampledSpectrum::map(sum, [](float x) { return std::clamp(x, 0.0F, 1.0F); });
}

}  // namespace abbe
