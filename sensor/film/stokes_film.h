#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/image.h"

namespace abbe {

/// A Stokes vector (I, Q, U, V) in the frame of the film.
using StokesVector = std::array<double, 4>;

/// The planes of a film that tell the Stokes vector which one channel, or one band, sees in each pixel.
struct StokesPlanes {
  std::string channel;                           ///< Name of the plane of its intensity.
  std::array<const ImageChannel*, 4> component;  ///< That of V is nullptr where linear polarisers measured.

  [[nodiscard]] bool tells_circular() const { return component[3] != nullptr; }
  /// V is 0 where it is not told.
  [[nodiscard]] StokesVector at(std::size_t pixel) const;
};
/// Those of all channels of a film, which must outlive them; none for a film that does not measure
/// polarisation. Throws Error{input} where Q or U of a channel is missing, or V of some channels alone.
[[nodiscard]] std::vector<StokesPlanes> stokes_planes(const Image& film);

/// How light is polarised. Noise may make the degrees exceed 1.
struct PolarisationFigures {
  double degree;         ///< sqrt(Q^2 + U^2 + V^2)/I; 0 where there is no light.
  double linear_degree;  ///< sqrt(Q^2 + U^2)/I; likewise.
  double angle_deg;      ///< Of the plane in which the field swings, atan2(U, Q)/2 in [0, 180).
};
[[nodiscard]] PolarisationFigures polarisation_of(const StokesVector& stokes);

}  // namespace abbe
