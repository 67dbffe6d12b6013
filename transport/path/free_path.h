#pragma once

#include <array>
#include <optional>

#include "transport/path/medium.h"
#include "transport/path/packet.h"
#include "transport/path/ray_caster.h"
#include "transport/path/vertex.h"

namespace abbe {

/// Where a path has come to: the ray it leaves on, what it carries, and what is around it.
struct PathEnd {
  Ray ray;
  PathPacket packet;
  MediumStack inside;
  Medium medium;  ///< Within them.

  /// Comes through a surface, to where it is within `beyond`.
  void enter(const Scene& scene, const MediumStack& beyond) {
    inside = beyond;
    medium = medium_within(scene, inside, packet.wavelengths.lambda_nm);
  }
};

/// Whether events may lie between surfaces: matter scatters, or begins without an interface.
[[nodiscard]] inline bool has_free_paths(const Scene& scene) {
  return scene.needs.scattering || scene.needs.boundaries;
}

/// How a path came to its next event.
struct FreePath {
  bool scattered = false;  ///< Within matter, at the origin of its ray, before it met a surface.
  /// The lane densities of the packet were multiplied by this, beyond the density of the way itself, to keep
  /// them within floats: so must be whatever they are added to.
  float density_scale = 1;
};

/// Takes a path along its ray, whose nearest hit is `hit`, to its next event: at a surface, which `hit` then
/// is, out of the scene, or in matter that scatters it. Boundaries of matter are passed. The ray goes on
/// starting where it does unless matter scatters.
///
/// The hero draws its optical depth to the next scattering from e^-depth by `u` in [0, 1)^2, the second
/// number being the digits beyond the first. With extinction s_k of lane k and the way x through it, the
/// density of scattering there is s_k e^(-s_k x), that of passing e^(-s_k x), and the lanes are balanced over
/// these as over densities of directions. [Wilkie2014, sec. 4.2]
[[nodiscard]] FreePath propagate(const Scene& scene, RayCaster& caster, const Imath::V2f& u, PathEnd& end,
                                 std::optional<SurfaceHit>& hit);

/// `from` as it is before it sets out from a vertex on `ray`, to the local direction `w`.
[[nodiscard]] inline PathEnd leaving(const Scene& scene, PathEnd from, const Vertex& vertex,
                                     const Imath::V3f& w, const Ray& ray) {
  from.ray = ray;
  if (w.z * vertex.wo.z < 0) from.enter(scene, vertex.behind(scene, from.inside));
  return from;
}

/// What is left of light on a straight way that nothing blocks, and with which density `propagate` would have
/// come that way, lane by lane.
struct Transmission {
  SampledSpectrum transmittance{1.0F};
  SampledSpectrum density{1.0F};
};
/// Along the first `distance` [m], perhaps infinite, of the ray of `start`.
[[nodiscard]] Transmission transmission(const Scene& scene, RayCaster& caster, PathEnd start, float distance);

}  // namespace abbe
