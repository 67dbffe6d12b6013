#pragma once

#include "lens/spot.h"

namespace abbe::lens {

/// The spots of every field, each at all wavelengths of the system; a beam that does not get through has
/// none.
[[nodiscard]] std::vector<std::vector<Spot>> all_spots(const System& system, double stop_radius_mm, int side);

/// How far the image must move towards +z for the least mean square of the spots of all fields, each at all
/// wavelengths about its own centroid [mm]; nothing where the rays of every field are parallel, or none.
[[nodiscard]] std::optional<double> best_focus(const System& system);

}  // namespace abbe::lens
