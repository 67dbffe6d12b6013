#pragma once

#include <span>
#include <vector>

#include "io/spectral_exr.h"
#include "sensor/response/channel.h"

namespace abbe {

/// Adjacent bins of equal width: bin i is [from + i step, from + (i + 1) step) nm.
struct SpectralBins {
  double from_nm = 0;
  double step_nm = 0;
  int count = 0;

  [[nodiscard]] double center_nm(int bin) const { return from_nm + (bin + 0.5) * step_nm; }
};

/// Edges of the bins [nm], one more than bins.
[[nodiscard]] std::vector<double> edges_nm(const SpectralBins& bins);

/// One energy channel for each bin, with weight 1 inside it. Its film value is the radiant exposure in the
/// bin [J/m^2]. The channels are named by their centers, such as "545nm". Throws Error{internal} unless the
/// width of the bins is positive.
[[nodiscard]] std::vector<Channel> spectral_channels(const SpectralBins& bins);

/// Converts a film of `spectral_channels`, with or without their Stokes channels (`with_stokes`), to the
/// radiance integrated over each bin [W/(m^2 sr)]. `exposure_per_radiance` [s sr] has the ratio of radiant
/// exposure to radiance of each pixel; variances are divided by its square. Metadata are copied. Throws
/// Error{internal} if the film lacks a channel of a bin.
[[nodiscard]] SpectralImage spectral_film(const Image& film, const SpectralBins& bins,
                                          std::span<const double> exposure_per_radiance);

/// Film of a sensor exposed to a spectral image of radiances [W/(m^2 sr)] per band: a plane of exposures and
/// one of variances (`Variance.`) for each channel. `exposure_per_radiance` [s sr] is that of each pixel. The
/// light of a band is spread evenly over it; light outside 300-1100 nm is ignored. Variances are upper bounds
/// that assume fully correlated errors of the bands; 0 for an image without variances. Metadata are not
/// copied. Throws
/// - Error{usage} for a channel that depends on the angle of incidence, which an image does not record;
/// - Error{usage} for a channel with an analyser if the image is not polarised;
/// - Error{input} if only some bands have variances.
[[nodiscard]] Image expose(const SpectralImage& image, std::span<const Channel> channels,
                           std::span<const double> exposure_per_radiance);

}  // namespace abbe
