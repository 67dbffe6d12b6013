#pragma once

#include "lens/spot.h"

namespace abbe::lens {

/// Spots of every field at all wavelengths of the system. A beam that does not arrive has an empty spot.
[[nodiscard]] std::vector<std::vector<Spot>> all_spots(const System& system, double stop_radius_mm, int side);

/// Displacement of the image plane towards +z [mm] that minimises the mean square radius of the spots of all
/// fields. The spots of a field at all wavelengths have a common centroid. Nothing if the rays of every field
/// are parallel or missing.
[[nodiscard]] std::optional<double> best_focus(const System& system);

}  // namespace abbe::lens
