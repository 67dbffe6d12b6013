#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <variant>

#include "materials/medium/phase.h"
#include "scene/scene.h"
#include "transport/path/media.h"
#include "transport/path/path_state.h"
#include "transport/path/vertex.h"

namespace abbe {

/// Vertex on the camera: a point of its lens or probe.
struct CameraVertex {
  Imath::V3f point;
  LensRoute route = 0;  ///< Route of the light through the lens; above 0 for a ghost.
};

/// Vertex on a light: a point with the outward normal of an area light, otherwise (0, 0, 0). For a light at
/// infinity `point` is the unit direction from the scene to the light.
struct LightVertex {
  std::uint32_t light;  ///< Index into `Scene::lights`.
  Imath::V3f point;
  Imath::V3f normal{0, 0, 0};
  bool at_infinity = false;
};

/// Scattering event in a medium; the path arrived along the unit vector `from`.
struct MediumVertex {
  Imath::V3f point;
  Imath::V3f from;
  PhaseFunction phase;
};

/// Vertex of a camera or light path, with everything needed to connect it to any other vertex and to compute
/// MIS weights. It can be stored: it has no pointers into a path, and its indices refer to the scene's lists.
///
/// Pdfs are those of this vertex given the vertex from which it is sampled, per wavelength as the hero. They
/// are per area on surfaces, lights and cameras, per volume in media, and per solid angle at infinity. The
/// only point of a light or camera has the pdf 1.
struct PathVertex {
  std::variant<CameraVertex, LightVertex, SurfaceVertex, MediumVertex> at;
  PathPacket packet = {};             ///< State before the scattering at this vertex.
  SampledSpectrum pdf_forward{1.0F};  ///< Pdf if sampled from the previous vertex.
  SampledSpectrum pdf_reverse = {};   ///< Pdf if sampled from the next vertex; 0 at the end of a path.
  MediumStack media_front = {};       ///< Media on the side from which the path arrived.
  MediumStack media_behind = {};      ///< Media on the other side.
  /// Pdf, per wavelength, of an event here, given arrival. In a medium this is the extinction [1/m] without a
  /// grid's density, which is common to all wavelengths and both directions; otherwise 1.
  SampledSpectrum event_pdf{1.0F};
  bool delta = false;  ///< True if the path left by a delta distribution, which no connection can sample.
  float time = 0;      ///< Time of the path; see `BasicRay`.

  [[nodiscard]] const SampledSpectrum& lambda_nm() const { return packet.wavelengths.lambda_nm; }
  /// True if the vertex is a light at infinity.
  [[nodiscard]] bool at_infinity() const {
    const auto* light = std::get_if<LightVertex>(&at);
    return light != nullptr && light->at_infinity;
  }
};

/// True for a camera vertex through which light gets to the film by way of a ghost.
[[nodiscard]] bool on_ghost(const PathVertex& vertex);
/// Position of the vertex; for a vertex at infinity, the unit direction to it. Refers to `vertex`.
[[nodiscard]] const Imath::V3f& point_of(const PathVertex& vertex);
/// Unit geometric normal, outward on shapes: of a surface, an area light, a probe or a lens with an axis.
/// Nothing for other vertices.
[[nodiscard]] std::optional<Imath::V3f> normal_of(const Scene& scene, const PathVertex& vertex);

/// Straight line between two vertices.
struct PathSegment {
  Imath::V3f direction;  ///< Unit vector from the first vertex to the second.
  double distance;       ///< Distance [m]; infinite if one vertex is at infinity.
};
/// Segment from `a` to `b`. At most one of both may be at infinity. If they coincide, the distance is 0 and
/// the direction is undefined.
[[nodiscard]] PathSegment segment_between(const PathVertex& a, const PathVertex& b);

/// Quantity that the vertex emits or scatters in the unit direction `w`, including the cosine there:
/// - surface: f |cos| [1/sr];
/// - medium: the phase function [1/sr];
/// - camera: its importance times its cosine;
/// - light: its emission (`emission_from`) times the cosine of an area light; 0 where it does not emit.
///
/// `mode` is the quantity that the path carries to a scattering vertex; others ignore it.
[[nodiscard]] SampledSpectrum eval_towards(const Scene& scene, const PathVertex& vertex, const Imath::V3f& w,
                                           TransportMode mode);

/// Polarisation of the path after it leaves the vertex in the unit direction `w` by an event that is not
/// delta. It includes all events of the path, this one too, and is relative to the throughput on arrival
/// (`Polarisation::through`). For a light it is the polarisation of its emission, for a camera the rows that
/// its sensor measures. Packets of other vertices must carry a polarisation.
[[nodiscard]] Polarisation polarisation_towards(const Scene& scene, const PathVertex& vertex,
                                                const Imath::V3f& w, TransportMode mode);

/// Pdf [1/sr], per wavelength, with which the vertex samples the direction `w` by an event that is not delta.
/// Cameras and lights use their own pdfs and ignore `before`. Other vertices use the pdf for a path that
/// arrives along -`before`, a unit vector. A light at infinity samples the position of the ray instead
/// [1/m^2]. Exchanging `before` and `w` gives the pdf of the reverse direction.
[[nodiscard]] SampledSpectrum direction_pdf(const Scene& scene, const PathVertex& vertex,
                                            const Imath::V3f& before, const Imath::V3f& w);

/// Factor dω/dA or dω/dV that converts the pdf of a direction at `from` into that of the vertex `to`:
/// |cos|/d^2 with a normal at `to`, 1/d^2 without. It is 1 if `to` is at infinity, and the cosine alone if
/// `from` is. The vertices must not coincide.
[[nodiscard]] float solid_angle_per_area(const Scene& scene, const PathVertex& from, const PathVertex& to);

/// Calls `visit` with a `LightVertex` for every environment light and sun visible along the ray of a path
/// that leaves the scene. If the scene has such lights, first attenuates the path's throughput over the rest
/// of the ray, by the medium around it.
template <typename Visit>
void visit_escaped_lights(const Scene& scene, PathState& path, Visit visit) {
  if (scene.background().empty()) return;
  path.media.medium.attenuate(path.packet.throughput, std::numeric_limits<float>::infinity());
  for (const std::uint32_t light : scene.background())
    if (is_visible_along(scene.lights[light], path.ray.direction))
      visit(LightVertex{light, path.ray.direction, Imath::V3f(0), true});
}

/// Light vertex of the surface that a ray with the unit direction `direction` hits; nothing if it is no
/// light, or does not emit towards the ray's origin.
[[nodiscard]] inline std::optional<LightVertex> emitter_hit(const Scene& scene, const SurfaceHit& hit,
                                                            const Imath::V3f& direction) {
  const std::int32_t light = scene.shapes[hit.shape].light;
  if (light < 0) return std::nullopt;
  const auto index = static_cast<std::uint32_t>(light);
  if (!emits_towards(scene.lights[index], hit.normal, -direction)) return std::nullopt;
  return LightVertex{index, hit.point, hit.normal};
}

}  // namespace abbe
