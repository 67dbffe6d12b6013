#pragma once

#include "lens/spot.h"

namespace abbe::lens {

/// Spots of every field (outer vector) at all wavelengths (inner vector) of the system. The rays of a spot
/// pass the centers of `side` x `side` cells of its beam. A field without a beam (`Beam::of`) has a spot
/// without rays and powers.
[[nodiscard]] std::vector<std::vector<Spot>> all_spots(const System& system, double stop_radius_mm, int side);

/// Displacement of the image plane towards +z [mm] that minimises the mean square radius of the spots of all
/// fields. The spots of a field at all wavelengths have a common centroid. Nothing if the rays of every field
/// are parallel or missing. Throws Error{scene} like `stop_radius`.
[[nodiscard]] std::optional<double> best_focus(const System& system);

}  // namespace abbe::lens
