#pragma once

#include <ImathVec.h>

#include "scene/scene.h"
#include "scene/shapes/basis.h"

namespace abbe {

/// What scattering at a hit refers to: axes whose z is the outward normal, or the one that vertex normals or
/// a relief say, and the surface coordinates.
struct SurfacePlace {
  Basis<float> frame;
  Imath::V2f uv{0, 0};
  bool relief = false;  ///< z may differ from the normal of the shape.
};

/// The place of a hit at that time, where a scene has `needs.textures`; without it the normal says all. A
/// relief turns the normal that vertex normals give. Where the material needs coordinates they are worked
/// out, and the frame's x runs along dp/du; elsewhere they are (0, 0).
[[nodiscard]] SurfacePlace textured_place(const Scene& scene, const SurfaceHit& hit, float time);

}  // namespace abbe
