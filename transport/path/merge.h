#pragma once

#include <cmath>

#include "transport/path/vertex.h"

namespace abbe {

/// BSDF [1/sr] with which a surface scatters photon flux that arrived nearby towards the vertex's own path.
/// `from` is the unit direction to the photon's origin, `normal` the outward geometric normal at the photon.
/// On a relief the value is multiplied by the shading cosine of `from` over the geometric one, by which flux
/// arrives. 0 if the normals differ by more than 60 degrees, because the photon is then on another face.
[[nodiscard]] inline SampledSpectrum merged_scattering(const SurfaceVertex& vertex, const Imath::V3f& from,
                                                       const Imath::V3f& normal) {
  constexpr float kSameFace = 0.5F;  // minimum cosine between two normals
  const float cos_incident = std::abs(from.dot(vertex.hit.normal));
  if (normal.dot(vertex.hit.normal) < kSameFace || !(cos_incident > 0)) return {};
  const SurfaceVertex::OutgoingDirection outgoing = vertex.eval_towards(from, TransportMode::radiance);
  return vertex.relief ? outgoing.f * (std::abs(outgoing.wi.z) / cos_incident) : outgoing.f;
}

/// Stokes vector that a camera path with the polarisation `eye` measures of photon flux that `vertex`
/// scatters, relative to an unpolarised estimate. `light` is the polarisation of the flux, and `from` the
/// unit direction to its origin. Nothing if `eye` is empty; otherwise `light` must not be empty.
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
