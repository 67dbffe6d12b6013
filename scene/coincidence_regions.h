#pragma once

#include <cstddef>
#include <vector>

#include <ImathBox.h>

#include "scene/scene.h"

namespace abbe {

/// Returns for each shape a conservative box around the region where `Scene::coincident` may find another
/// surface or its own other side. Empty if there is none. Fallbacks:
/// - the overlap of the bounding boxes for moving shapes and ellipsoids, and if comparing the faces would
/// delay the render;
/// - the whole of every shape if comparing the shapes would take seconds.
[[nodiscard]] std::vector<Imath::Box3f> coincidence_regions(const Scene& scene);

}  // namespace abbe
