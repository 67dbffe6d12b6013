#pragma once

#include <optional>

#include "io/image.h"

namespace abbe {

/// Difference in polarisation of two films over the pixels of their common channels. Degrees are compared
/// where the reference's degree of polarisation exceeds `kPolarised`, angles where its degree of linear
/// polarisation does. Means and maxima are 0 if nothing is compared.
struct PolarisationDifference {
  double polarised_fraction = 0;  ///< Fraction of the pixels of all channels whose degrees are compared.
  double degree_mean = 0;         ///< Mean of |degree - reference degree|.
  double degree_max = 0;
  double angle_deg_mean = 0;  ///< Mean angle between the planes of vibration, in [0, 90].
  double angle_deg_max = 0;
};
/// Degree of polarisation above which a pixel of the reference counts as polarised.
inline constexpr double kPolarised = 0.05;

/// Polarisation difference of two films of the same size, which is not checked. Nothing unless both record
/// Stokes components of a common channel. Throws the errors of `stokes_planes`.
[[nodiscard]] std::optional<PolarisationDifference> polarisation_difference(const Image& image,
                                                                            const Image& reference);

}  // namespace abbe
