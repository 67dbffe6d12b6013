#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "materials/medium/phase.h"
#include "scene/scene.h"
#include "transport/path/medium_stack.h"
#include "transport/path/packet.h"
#include "transport/path/vertex.h"

namespace abbe {

/// Where a path meets the camera: on its lens or its meter.
struct CameraVertex {
  Imath::V3f point;
  LensRoute route = 0;  ///< By which light goes on from there.
};

/// Where a path meets a light: a point of it, with the outward normal of an area light, else (0, 0, 0). Of a
/// light at infinity `point` is the unit direction from the scene to where its light comes from.
struct LightVertex {
  std::uint32_t light;  ///< Index into `Scene::lights`.
  Imath::V3f point;
  Imath::V3f normal{0, 0, 0};
  bool at_infinity = false;
};

/// Where matter turns a path, that came along the unit vector `from`.
struct MediumVertex {
  Imath::V3f point;
  Imath::V3f from;
  PhaseFunction phase;
};

/// A vertex of a path of either direction, with all that it takes to connect it to any other one and to weigh
/// the ways in which the path could have come about. It may be stored: nothing in it points into a path, and
/// indices are those of the scene's lists.
///
/// Densities are those of this vertex, given the one that it would be drawn from, lane by lane, were each
/// lane the hero: per area at surfaces, lights and cameras, per volume in matter, per solid angle of what is
/// at infinity, and 1 for a point that is a light's or a camera's only one.
struct PathVertex {
  std::variant<CameraVertex, LightVertex, SurfaceVertex, MediumVertex> at;
  PathPacket packet = {};             ///< Up to here, before it scatters here.
  SampledSpectrum pdf_forward{1.0F};  ///< Drawn from the vertex before.
  SampledSpectrum pdf_reverse = {};   ///< Drawn from the vertex after; 0 at the end of a path.
  MediumStack inside = {};            ///< Around it, on the side the path came from,
  MediumStack beyond = {};            ///< and on the other.
  /// Density of an event here for what comes this far: in matter the extinction [1/m], over a grid's density,
  /// which is common to all lanes and both ways; else 1.
  SampledSpectrum event_pdf{1.0F};
  bool delta = false;  ///< The path went on in a single direction, which no connection finds.
  float time = 0;      ///< Of the path; see `BasicRay`.

  [[nodiscard]] const SampledSpectrum& lambda_nm() const { return packet.wavelengths.lambda_nm; }
  /// Whether it is a light at infinity.
  [[nodiscard]] bool at_infinity() const {
    const auto* light = std::get_if<LightVertex>(&at);
    return light != nullptr && light->at_infinity;
  }
};

/// Whether it is where light comes into a lens by way of a ghost.
[[nodiscard]] bool on_ghost(const PathVertex& vertex);
/// Where the vertex is; of one at infinity the direction to it.
[[nodiscard]] const Imath::V3f& point_of(const PathVertex& vertex);
/// The geometric normal of what has one.
[[nodiscard]] std::optional<Imath::V3f> normal_of(const Scene& scene, const PathVertex& vertex);

/// The unit vector from `a` to `b`, not both at infinity, and the distance, which may be infinite.
struct Way {
  Imath::V3f direction;
  double distance;
};
[[nodiscard]] Way way_from(const PathVertex& a, const PathVertex& b);

/// What goes on at a vertex towards the unit vector `w`, times the cosine there: f |cos| [1/sr] of a surface,
/// the phase function [1/sr], the importance of a camera times its cosine, the emission of a light times its
/// own, and from infinity the emission alone. `mode` says what the path carries to a scattering vertex.
[[nodiscard]] SampledSpectrum sent_towards(const Scene& scene, const PathVertex& vertex, const Imath::V3f& w,
                                           TransportMode mode);

/// The polarisation with which the packet that the vertex holds leaves it towards the unit vector `w`, by no
/// event of a single direction, relative to what it has come with; that of a lamp's own light, and at a
/// camera the rows that its sensor measures.
[[nodiscard]] Polarisation polarisation_towards(const Scene& scene, const PathVertex& vertex,
                                                const Imath::V3f& w, TransportMode mode);

/// Density [1/sr] with which the vertex would draw the direction `w`, lane by lane, by an event that is not
/// delta: a camera and a light of their own, the others when they are come to along -`before`, that is from
/// the vertex in the direction `before`. Light from infinity draws the place of its way instead [1/m^2]. With
/// `before` and `w` exchanged it is the density the other way.
[[nodiscard]] SampledSpectrum direction_pdf(const Scene& scene, const PathVertex& vertex,
                                            const Imath::V3f& before, const Imath::V3f& w);

/// The factor dω/dA, or dω/dV, that turns the density of a direction at `from` into that of the vertex `to`
/// there: |cos|/d^2 at what has a normal, 1/d^2 elsewhere. 1 for what is at infinity, and where light comes
/// from infinity the cosine alone.
[[nodiscard]] float solid_angle_per_area(const Scene& scene, const PathVertex& from, const PathVertex& to);

}  // namespace abbe
