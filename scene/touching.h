#pragma once

#include <cstddef>
#include <vector>

#include <ImathBox.h>

#include "scene/scene.h"

namespace abbe {

/// Where another surface, of another shape or of its own other side, may touch each shape of a scene, by
/// `Scene::touching`: a box around all such places, and perhaps some of the shape beside them; empty for
/// none. It is around all that two shapes may share where either moves or is a ball placed by a matrix, and
/// where so many faces are near each other that comparing them would delay the render.
/// It is around all of every shape where there are so many that comparing them would take seconds.
[[nodiscard]] std::vector<Imath::Box3f> touching_regions(const Scene& scene);

}  // namespace abbe
