#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/image.h"
#include "spectral/stokes.h"

namespace abbe {

/// Names of the main planes in the image of a film's file, without variances, layers and features. Throws
/// Error{input} for a malformed name of a spectral band. The planes are
/// - of a spectral film its bands, by Stokes component and wavelength;
/// - otherwise those that the attribute `sensor_channels` lists, in its order;
/// - without that attribute all channels except variances, in the order of the file.
[[nodiscard]] std::vector<std::string> plane_names(const Image& film);

/// True unless the film declares a unit of X, Y and Z that is not photometric, so that they are no
/// tristimulus values.
[[nodiscard]] bool may_hold_tristimulus_values(const Image& film);

/// Name of the channel with the variance of another channel.
[[nodiscard]] inline std::string variance_of(const std::string& channel) {
  return "Variance." + channel;
}

/// Attribute with the layers that add up to a film, separated by commas; absent if it has none. Each layer
/// has channels `<layer>.<plane>` in the same file.
inline constexpr const char* kLayersKey = "layers";
inline constexpr const char* kLightLayer = "light.";  ///< Prefix of the names of light-group layers.

/// Planes of a film with the Stokes vectors of one channel or band.
struct StokesPlanes {
  std::string channel;  ///< Name of the intensity plane.
  /// Plane of V is nullptr if only linear polarisation was measured.
  std::array<const ImageChannel*, 4> component;

  [[nodiscard]] bool has_circular() const { return component[3] != nullptr; }
  /// Stokes vector of the pixel with this index, in the unit of the film. The x axis of its frame points to
  /// the right of the picture. V is 0 without its plane.
  [[nodiscard]] StokesVector at(std::size_t pixel) const;
};
/// Stokes planes of all channels of a film, which must outlive them. Empty for a film that does not measure
/// polarisation. Throws Error{input} if Q or U of a channel is missing, or if only some channels have V.
[[nodiscard]] std::vector<StokesPlanes> stokes_planes(const Image& film);

/// State of polarisation. Noise can make the degrees exceed 1.
struct PolarisationFigures {
  double degree;         ///< sqrt(Q^2 + U^2 + V^2)/I; 0 without light.
  double linear_degree;  ///< sqrt(Q^2 + U^2)/I; 0 without light.
  double angle_deg;      ///< Plane of oscillation of the electric field, atan2(U, Q)/2 in [0, 180),
                         ///< counterclockwise from the right of the picture.
};
/// The figures of a Stokes vector.
[[nodiscard]] PolarisationFigures polarisation_of(const StokesVector& stokes);

}  // namespace abbe
