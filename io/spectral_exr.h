#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/image.h"

namespace abbe {

/// Attribute of polarised images for the sign of S3: "right" if S3 > 0 is right-handed for the receiver,
/// otherwise "left".
inline constexpr const char* kHandednessKey = "polarisationHandedness";
inline constexpr const char* kRightHanded = "right";

/// One Stokes component in one wavelength band.
struct SpectralBand {
  double center_nm;
  std::vector<float> radiance;  ///< Integral over the band [W/(m^2 sr)], row by row from the top left.
};

/// A spectral image of radiance in bands, as in spectral EXR files [Fichet2021].
struct SpectralImage {
  int width = 0;
  int height = 0;
  std::vector<SpectralBand> bands;   ///< At least two, by ascending wavelength.
  std::vector<ImageChannel> others;  ///< Other channels, such as a preview R, G, B.
  std::map<std::string, std::string> metadata;
  /// Stokes components S1, S2 and S3, in this order. Each has the bands of `bands`, in their unit and order;
  /// all are empty if unpolarised. S3 > 0 is right-handed for the receiver.
  /// S1 > 0 means polarisation along the picture's right, S2 > 0 halfway between right and up.
  std::array<std::vector<SpectralBand>, 3> polarised = {};

  [[nodiscard]] bool is_polarised() const { return !polarised[0].empty(); }
};

/// Channel name of a band with six decimals, such as "S0.550,000000nm". `component` is the Stokes component,
/// 0 to 3.
[[nodiscard]] std::string spectral_channel(double center_nm, int component = 0);

/// A parsed channel name [Fichet2021].
struct SpectralName {
  char kind;         ///< '0' to '3' for the Stokes component S0 (radiance) to S3, 'T' for a reflectance.
  double center_nm;  ///< Converted from a frequency f by c/f if the name states one.
};
/// Parses the name of a spectral channel, in any unit of metres or hertz. Nothing for other channels. Throws
/// Error{input}, which names the file `where`, if a name begins and ends like a spectral one but is
/// malformed.
[[nodiscard]] std::optional<SpectralName> parse_spectral_channel(std::string_view name,
                                                                 const std::string& where);

/// True if the image has the layout's version attribute, or a channel with the name of a radiance or
/// reflectance.
[[nodiscard]] bool is_spectral(const Image& image);

/// Band limits [nm] from at least two bands with ascending centers, one limit more than bands. Inner limits
/// are midpoints between centers. The outer limits are at the same distance outside the first and last
/// center.
[[nodiscard]] std::vector<double> band_edges(const std::vector<SpectralBand>& bands);

/// The image as channels and attributes of an EXR file: first `others`, then S0 by wavelength, then S1, S2
/// and S3. The attributes of the layout and the handedness replace those in `metadata`.
[[nodiscard]] Image spectral_layout(const SpectralImage& image);

/// Inverse of `spectral_layout`, with bands in ascending order. S3 of left-handed images changes its sign.
/// Throws Error{input}, which names the file `where`, if a required attribute is missing or has another
/// value. Throws it for malformed spectral names, reflectances, fewer than two bands, and a band twice. S1,
/// S2 and S3 must be all present or absent, and have the wavelengths of S0.
[[nodiscard]] SpectralImage spectral_image(Image image, const std::string& where);

}  // namespace abbe
