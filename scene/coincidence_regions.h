#pragma once

#include <cstddef>
#include <vector>

#include <ImathBox.h>

#include "scene/scene.h"

namespace abbe {

/// Returns for each shape, by its index in `Scene::shapes`, a box in render coordinates [m]. It contains the
/// region where `Scene::coincident` may find another surface or the shape's own other side. The box is
/// conservative, and empty if there is none. `Scene::commit` calls this after it has measured the shapes.
/// Fallbacks:
/// - the overlap of the bounding boxes for moving shapes and ellipsoids, and if comparing the faces would
/// delay the render;
/// - the whole of every shape if there are more than `kMaxPairs` pairs of shapes.
[[nodiscard]] std::vector<Imath::Box3f> coincidence_regions(const Scene& scene);

}  // namespace abbe
