#pragma once

#include <optional>

#include "io/image.h"

namespace abbe {

/// How differently light is polarised in two films, over the pixels of all channels where the reference's is
/// by more than `kPolarised`: linearly, for the angle.
struct PolarisationDifference {
  double polarised_share = 0;  ///< Of the pixels of all channels, those whose degrees are compared.
  double degree_mean = 0;      ///< Of |degree - reference's|.
  double degree_max = 0;
  double angle_deg_mean = 0;  ///< Between the planes in which the fields swing, in [0, 90].
  double angle_deg_max = 0;
};
inline constexpr double kPolarised = 0.05;

/// Nothing unless both films measure polarisation and have a channel in common. They have the same size.
[[nodiscard]] std::optional<PolarisationDifference> polarisation_difference(const Image& image,
                                                                            const Image& reference);

}  // namespace abbe
