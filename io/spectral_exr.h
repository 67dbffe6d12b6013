#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/image.h"

namespace abbe {

/// What polarised images say of the sign of S3: "right" where S3 > 0 is right-handed for the receiver.
inline constexpr const char* kHandednessKey = "polarisationHandedness";
inline constexpr const char* kRightHanded = "right";

/// Radiance in one band of wavelengths.
struct SpectralBand {
  double center_nm;
  std::vector<float> radiance;  ///< Integral over the band [W/(m^2 sr)], row by row.
};

/// An image of radiances over wavelength, as spectral EXR files hold it [Fichet2021].
struct SpectralImage {
  int width = 0;
  int height = 0;
  std::vector<SpectralBand> bands;   ///< At least two, by ascending wavelength.
  std::vector<ImageChannel> others;  ///< Such as the preview R, G, B.
  std::map<std::string, std::string> metadata;
  /// The Stokes components S1, S2 and S3 of each band, in the same unit and order; none of unpolarised
  /// images. S3 > 0 is right-handed for the receiver.
  std::array<std::vector<SpectralBand>, 3> polarised = {};

  [[nodiscard]] bool is_polarised() const { return !polarised[0].empty(); }
};

/// Name of the channel of a band, such as "S0.550,000000nm", or of its Stokes component 1 to 3.
[[nodiscard]] std::string spectral_channel(double center_nm, int component = 0);

/// What a channel's name says by the grammar of [Fichet2021].
struct SpectralName {
  char kind;         ///< '0' to '3' for the Stokes component S0 (radiance) to S3, 'T' for a reflectance.
  double center_nm;  ///< Of a frequency, its wavelength c/f.
};
/// Reads the name of a spectral channel; nothing for names of other channels. Throws Error{input} with
/// `where` for a name that begins as a spectral one and is none, such as one without a number.
[[nodiscard]] std::optional<SpectralName> parse_spectral_channel(std::string_view name,
                                                                 const std::string& where);

/// Whether an image announces itself as spectral or holds a radiance or reflectance of a spectral name.
[[nodiscard]] bool is_spectral(const Image& image);

/// Ends of the bands around ascending centres, one more than there are [nm]: halfway to the neighbours, and
/// as far beyond the first and last centre.
[[nodiscard]] std::vector<double> band_edges(const std::vector<SpectralBand>& bands);

/// The image as channels and attributes of an EXR file.
[[nodiscard]] Image spectral_layout(const SpectralImage& image);

/// The reverse. S3 of images whose convention is left-handed is turned. Throws Error{input} with `where` for
/// an image that lacks an attribute the layout requires, names another version or unit, holds reflectances,
/// fewer than two bands, a band twice, or some of the components S1, S2 and S3 only, or at other wavelengths
/// than radiance.
[[nodiscard]] SpectralImage spectral_image(Image image, const std::string& where);

}  // namespace abbe
