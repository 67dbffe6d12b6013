#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/spectral_exr.h"
#include "sensor/response/channel.h"

namespace abbe {

/// Bins of one width that cover a range of wavelengths without gaps: bin i is [from + i step, from + (i + 1)
/// step) nm.
struct SpectralBins {
  double from_nm = 0;
  double step_nm = 0;
  int count = 0;

  [[nodiscard]] double center_nm(int bin) const { return from_nm + (bin + 0.5) * step_nm; }
};

/// The ends of the bins, one more than there are [nm].
[[nodiscard]] std::vector<double> edges_nm(const SpectralBins& bins);

/// A channel for each bin that weighs energy by 1 within it: its film value is the radiant exposure that
/// arrives in the bin [J/m^2]. Named by their centres, as "545nm".
[[nodiscard]] std::vector<Channel> spectral_channels(const SpectralBins& bins);

/// The film of those channels, or of theirs `with_stokes`, as radiances. `exposure_per_radiance` [s sr] is,
/// pixel by pixel, what a radiance is multiplied by to give the radiant exposure. `Variance.` channels, where
/// there are any, are divided by its square. Of the film's metadata and channels all others are kept.
[[nodiscard]] SpectralImage spectral_film(const Image& film, const SpectralBins& bins,
                                          std::span<const double> exposure_per_radiance);

/// The film of a sensor that looks at a spectral image: the light of a band is spread evenly over it, and
/// what lies beyond 300-1100 nm is not seen. Variances are upper bounds, as if the errors of all bands were
/// one. Metadata are left out. Throws Error{usage} for a channel whose response depends on the angle, which
/// an image has lost, and for one with an analyser where the image is not polarised, Error{input} for
/// variances of some bands only.
[[nodiscard]] Image expose(const SpectralImage& image, std::span<const Channel> channels,
                           std::span<const double> exposure_per_radiance);

}  // namespace abbe
