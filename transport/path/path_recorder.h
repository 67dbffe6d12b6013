#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "transport/path/connect.h"
#include "transport/path/met_lights.h"
#include "transport/path/path_vertex.h"
#include "transport/path/random_walk.h"

namespace abbe {

/// A light that a path has met by itself.
struct MetLight {
  std::size_t after;  ///< So many of its vertices.
  PathVertex vertex;
};

/// A path under way that keeps its vertices.
struct RecordedPath : Walk {
  using Walk::Walk;
  std::vector<PathVertex> vertices;
  std::vector<MetLight> met;  ///< By one from the camera.
  /// Density [1/sr] with which the last vertex drew the ray, lane by lane; of a single direction, see below.
  SampledSpectrum direction_pdf{1.0F};
  float carried_at_start = 1;  ///< What roulette compares with.
  float eta_scale = 1;         ///< What refraction has taken off radiance, which counts as still there.
  bool stays = false;          ///< It has come to where its last vertex is, as floats tell places.

  /// Its throughput over what it set out with.
  [[nodiscard]] float carried() const { return packet.carried() * eta_scale / carried_at_start; }
};

/// Random walks whose vertices are kept for other techniques to join: of paths from the camera, which carry
/// radiance, or from lights, which carry power. Vertices of matter that nothing leaves are not kept, and a
/// walk ends where it comes to the place of its last vertex, as floats tell places. Each is given, lane by
/// lane,
///     pdf_forward(x_i) = p(w_i) dw/dA pass,      p(w_i) the density of the direction to it from x_{i-1},
///     pdf_reverse(x_i) = p(w_i') dw/dA pass,     p(w_i') that of the direction to it from x_{i+1},
/// `pass` being the density of coming through the matter between, and in matter that of an event there,
/// e^(-depth) s_k with the extinction s_k. [Veach1997, sec. 10.2]
///
/// Of a single direction p is the event's `delta_density`, the same both ways. It is the factor of a Dirac
/// distribution over the directions towards the light. The distribution over those towards the camera, which
/// a path from there would draw back, is as dense times
///     dw_light/dw_camera = (n_c^2 |cos_c|)/(n_l^2 |cos_l|),
/// so that the densities of all ways in which a path may come about are in one measure.
template <TransportMode mode>
class PathRecorder {
 public:
  using Path = RecordedPath;
  static constexpr TransportMode kMode = mode;

  PathRecorder(const Scene& scene, RayCaster& caster)
      : scene_(scene), caster_(caster), walks_(scene, caster) {}

  /// All paths: those to be walked start with their ray, packet, surroundings, first vertex and
  /// `direction_pdf`; the others have no vertex.
  [[nodiscard]] std::vector<RecordedPath>& paths() { return walks_.paths(); }
  /// Walks them to their ends.
  void run() {
    for (std::uint32_t i = 0; i < paths().size(); ++i)
      if (!paths()[i].vertices.empty()) walks_.going().push_back(i);
    walks_.run(*this);
  }

  /// Densities of a direction that a vertex has drawn, and of that back to the vertex before.
  struct BothWays {
    SampledSpectrum forward, back;
  };
  /// Those of a single direction.
  [[nodiscard]] static BothWays single_direction(const SurfaceVertex& vertex, const BsdfSample& event,
                                                 int hero) {
    const float eta2 = vertex.squared_eta(event, hero);
    const float cosines = std::abs(vertex.wo.z / event.wi.z);
    const SampledSpectrum density = delta_density(vertex.bsdf, event, eta2, mode);
    if constexpr (mode == TransportMode::radiance)
      return {density, density * (cosines / eta2)};
    else
      return {density * (eta2 / cosines), density};
  }

  // What RandomWalks asks.
  void escape(RecordedPath& path) {
    if (mode == TransportMode::power) return;
    find_background(scene_, path, [&](const LightVertex& light) { keep_light(path, light); });
  }
  void meet(RecordedPath& path, const SurfaceHit& hit) {
    if (mode == TransportMode::power) return;
    const std::optional<LightVertex> light = light_met(scene_, hit, path.ray.direction);
    if (light && !stays_at(path, hit.point)) keep_light(path, *light);
  }
  void reach(RecordedPath& path, const SurfaceVertex& vertex) {
    path.stays = stays_at(path, vertex.hit.point);
    if (path.stays) return;
    PathVertex here{.at = vertex};
    here.beyond = vertex.behind(scene_, path.around.inside);
    path.vertices.push_back(come_to(path, std::move(here)));
  }
  void connect(RecordedPath& /*path*/, const SurfaceVertex& /*vertex*/, const std::array<float, 4>& /*u*/) {}
  void connect_within(RecordedPath& path, const PhaseFunction& phase, const std::array<float, 4>& /*u*/) {
    path.vertices.push_back(come_to(path, {.at = MediumVertex{path.ray.origin, path.ray.direction, phase},
                                           .beyond = path.around.inside,
                                           .event_pdf = path.around.medium.extinction_per_m}));
  }
  [[nodiscard]] std::optional<BsdfSample> scatter(const RecordedPath& path, const SurfaceVertex& vertex,
                                                  const BsdfRandom& u) const {
    return vertex.scatter(u, path.packet.hero, mode);
  }
  [[nodiscard]] bool follows(const RecordedPath& path, const BsdfSample& /*event*/) const {
    return !path.stays;
  }
  [[nodiscard]] bool follows_within(const RecordedPath& path) const {
    return !stays_at(path, path.ray.origin);
  }
  [[nodiscard]] float kept(RecordedPath& path, const SurfaceVertex& vertex, const BsdfSample& event) {
    path.vertices.back().delta = event.delta;
    if (mode == TransportMode::radiance) path.eta_scale *= vertex.squared_eta(event, path.packet.hero);
    // As the event tells it: a lobe may be narrower than the places of vertices tell directions.
    leave(path, event.delta ? single_direction(vertex, event, path.packet.hero)
                            : BothWays{event.lane_pdf * event.pdf, back_again(path)});
    return carried(path);
  }
  [[nodiscard]] float kept_within(RecordedPath& path) {
    leave(path,
          {direction_pdf(scene_, path.vertices.back(), back(path), path.ray.direction), back_again(path)});
    return carried(path);
  }
  [[nodiscard]] float carried(const RecordedPath& path) const { return path.carried(); }
  void resolve_connections() {}

 private:
  // From a place to itself there is no density of directions by area.
  [[nodiscard]] static bool stays_at(const RecordedPath& path, const Imath::V3f& point) {
    const PathVertex& last = path.vertices.back();
    return !last.at_infinity() && point_of(last) == point;
  }
  // Of coming from one vertex to the next, whatever stands between them.
  [[nodiscard]] SampledSpectrum passing(const PathVertex& from, const PathVertex& to) {
    if (!walks_.has_free_paths()) return SampledSpectrum(1.0F);
    if (from.at_infinity()) return passing(to, from);  // both ways alike; none can start there
    const Way way = way_from(from, to);
    return transmission_along(scene_, caster_, from, way).density;
  }

  // The vertex that a path has come to, with all that the path tells of it.
  [[nodiscard]] PathVertex come_to(const RecordedPath& path, PathVertex vertex) {
    vertex.packet = path.packet;
    vertex.inside = path.around.inside;
    vertex.time = path.ray.time;
    const PathVertex& before = path.vertices.back();
    vertex.pdf_forward = path.direction_pdf * solid_angle_per_area(scene_, before, vertex) *
                         passing(before, vertex) * vertex.event_pdf;
    return vertex;
  }
  void keep_light(RecordedPath& path, const LightVertex& light) {
    path.met.push_back({path.vertices.size(), come_to(path, {.at = light})});
  }

  // Towards the vertex before the last.
  [[nodiscard]] static Imath::V3f back(const RecordedPath& path) {
    return way_from(path.vertices.back(), path.vertices[path.vertices.size() - 2]).direction;
  }
  [[nodiscard]] SampledSpectrum back_again(const RecordedPath& path) const {
    return direction_pdf(scene_, path.vertices.back(), path.ray.direction, back(path));
  }
  void leave(RecordedPath& path, const BothWays& drawn) {
    const PathVertex& vertex = path.vertices.back();
    PathVertex& before = path.vertices[path.vertices.size() - 2];
    path.direction_pdf = drawn.forward;
    before.pdf_reverse = drawn.back * solid_angle_per_area(scene_, vertex, before) * passing(before, vertex) *
                         before.event_pdf;
  }

  const Scene& scene_;
  RayCaster& caster_;
  RandomWalks<PathRecorder> walks_;
};

template <TransportMode mode>
inline constexpr bool kDrawsPolarised<PathRecorder<mode>> = false;

template <TransportMode mode>
inline constexpr float kEnding<PathRecorder<mode>> = kEndingOfJoinedPaths;

}  // namespace abbe
