#pragma once

#include <ImathVec.h>

#include "scene/scene.h"
#include "scene/shapes/basis.h"

namespace abbe {

/// What scattering at a hit refers to: axes whose z is the outward normal, or the one that a relief says, and
/// the surface coordinates.
struct SurfacePlace {
  Basis<float> frame;
  Imath::V2f uv{0, 0};
  bool relief = false;  ///< z may differ from the normal of the shape.
};

/// Of a hit in a scene that has `needs.textures`. Where the material needs coordinates they are worked out,
/// and the frame's x runs along dp/du.
[[nodiscard]] SurfacePlace textured_place(const Scene& scene, const SurfaceHit& hit);

/// Of any hit; the coordinates are (0, 0) where the material does not ask for them.
[[nodiscard]] inline SurfacePlace place_of(const Scene& scene, const SurfaceHit& hit) {
  return scene.needs.textures ? textured_place(scene, hit) : SurfacePlace{Basis<float>(hit.normal)};
}

}  // namespace abbe
