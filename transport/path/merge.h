#pragma once

#include <cmath>

#include "transport/path/vertex.h"

namespace abbe {

/// What a surface makes of flux that has come to a place close by, over the area it counts for: f [1/sr]
/// towards where the path of radiance came from, `from` being the unit direction to where the flux did, and
/// `normal` the geometric one of that place. On a relief times its cosine over that of the shape, by which
/// flux arrives. 0 where the place belongs to another side or face.
[[nodiscard]] inline SampledSpectrum merged_scattering(const SurfaceVertex& vertex, const Imath::V3f& from,
                                                       const Imath::V3f& normal) {
  constexpr float kSameFace = 0.5F;  // the least cosine of two normals
  const float arriving = std::abs(from.dot(vertex.hit.normal));
  if (normal.dot(vertex.hit.normal) < kSameFace || !(arriving > 0)) return {};
  const SurfaceVertex::Departure sent = vertex.towards(from, TransportMode::radiance);
  return vertex.relief ? sent.f * (std::abs(sent.wi.z) / arriving) : sent.f;
}

/// What a path of radiance, come to the surface with the packet `eye`, measures of the flux when that has
/// come with the packet `light` from there, over what it would were all unpolarised; nothing if they carry
/// none.
[[nodiscard]] inline std::optional<StokesSpectrum> merged_polarisation(const SurfaceVertex& vertex,
                                                                       const CarriedPolarisation& eye,
                                                                       const Imath::V3f& from,
                                                                       const CarriedPolarisation& light) {
  if (!eye) return std::nullopt;
  return eye
      ->through(vertex.mueller(vertex.frame.to_local(from), false), vertex.frame.to_world(vertex.wo),
                TransportMode::radiance)
      .of(*light, -from);
}

}  // namespace abbe
