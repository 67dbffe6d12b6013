#pragma once

#include <optional>

#include "io/image.h"

namespace abbe {

/// Difference in polarisation of two films. It covers the pixels of all channels whose reference has a degree
/// of polarisation above `kPolarised`; for the angle, a degree of linear polarisation above it.
struct PolarisationDifference {
  double polarised_fraction = 0;  ///< Fraction of the pixels of all channels whose degrees are compared.
  double degree_mean = 0;         ///< Mean of |degree - reference degree|.
  double degree_max = 0;
  double angle_deg_mean = 0;  ///< Angle between the planes of vibration, in [0, 90].
  double angle_deg_max = 0;
};
inline constexpr double kPolarised = 0.05;

/// Polarisation difference of two films of the same size. Empty unless both record Stokes components of a
/// common channel.
[[nodiscard]] std::optional<PolarisationDifference> polarisation_difference(const Image& image,
                                                                            const Image& reference);

}  // namespace abbe
