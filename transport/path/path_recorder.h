#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "transport/path/connect.h"
#include "transport/path/path_vertex.h"
#include "transport/path/random_walk.h"

namespace abbe {

/// A path under way that keeps its vertices.
struct RecordedPath : Walk {
  using Walk::Walk;
  std::vector<PathVertex> vertices;
  /// Density [1/sr] with which the last vertex drew the ray, lane by lane; 0 as one of single directions.
  SampledSpectrum direction_pdf{1.0F};
};

/// Random walks whose vertices are kept for other techniques to join: of paths from the camera, which carry
/// radiance, or from lights, which carry power. Vertices of matter that nothing leaves are not kept. Each is
/// given, lane by lane,
///     pdf_forward(x_i) = p(w_i) dw/dA pass,      p(w_i) the density of the direction to it from x_{i-1},
///     pdf_reverse(x_i) = p(w_i') dw/dA pass,     p(w_i') that of the direction to it from x_{i+1},
/// `pass` being the density of coming through the matter between, and in matter that of an event there,
/// e^(-depth) s_k with the extinction s_k. [Veach1997, sec. 10.2]
template <TransportMode mode>
class PathRecorder {
 public:
  using Path = RecordedPath;
  static constexpr TransportMode kMode = mode;

  PathRecorder(const Scene& scene, RayCaster& caster)
      : scene_(scene), caster_(caster), walks_(scene, caster) {}

  /// All paths: those to be walked start with their ray, packet, surroundings, first vertex and
  /// `direction_pdf`.
  [[nodiscard]] std::vector<RecordedPath>& paths() { return walks_.paths(); }
  /// Walks all of them to their ends.
  void run() {
    walks_.going().resize(paths().size());
    for (std::uint32_t i = 0; i < walks_.going().size(); ++i) walks_.going()[i] = i;
    walks_.run(*this);
  }

  // What RandomWalks asks.
  void escape(RecordedPath& /*path*/) {}
  void meet(RecordedPath& /*path*/, const SurfaceHit& /*hit*/) {}
  void reach(RecordedPath& path, const SurfaceVertex& vertex) {
    keep(path, {.at = vertex, .beyond = vertex.behind(scene_, path.around.inside)}, SampledSpectrum(1.0F));
  }
  void connect(RecordedPath& /*path*/, const SurfaceVertex& /*vertex*/, const std::array<float, 4>& /*u*/) {}
  void connect_within(RecordedPath& path, const PhaseFunction& phase, const std::array<float, 4>& /*u*/) {
    keep(path, {.at = MediumVertex{path.ray.origin, path.ray.direction, phase}, .beyond = path.around.inside},
         path.around.medium.extinction_per_m);
  }
  [[nodiscard]] std::optional<BsdfSample> scatter(const RecordedPath& path, const SurfaceVertex& vertex,
                                                  const BsdfRandom& u) const {
    return vertex.scatter(u, path.packet.hero, mode);
  }
  [[nodiscard]] bool follows(RecordedPath& /*path*/, const BsdfSample& /*event*/) const { return true; }
  [[nodiscard]] bool follows_within(const RecordedPath& /*path*/) const { return true; }
  [[nodiscard]] float kept(RecordedPath& path, const SurfaceVertex& /*vertex*/, const BsdfSample& event) {
    path.vertices.back().delta = event.delta;
    leave(path);
    return carried(path);
  }
  [[nodiscard]] float kept_within(RecordedPath& path) {
    leave(path);
    return carried(path);
  }
  [[nodiscard]] float carried(const RecordedPath& path) const { return path.packet.carried(); }
  void resolve_connections() {}

 private:
  // Of coming from one vertex to the next, whatever stands between them.
  [[nodiscard]] SampledSpectrum passing(const PathVertex& from, const PathVertex& to) {
    if (!walks_.has_free_paths()) return SampledSpectrum(1.0F);
    if (from.at_infinity()) return passing(to, from);  // both ways alike; none can start there
    const Way way = way_from(from, to);
    return transmission_along(scene_, caster_, from, way).density;
  }

  // `event` is the density of an event, given that the way led there.
  void keep(RecordedPath& path, PathVertex vertex, const SampledSpectrum& event) {
    vertex.packet = path.packet;
    vertex.inside = path.around.inside;
    vertex.time = path.ray.time;
    vertex.event_pdf = event;
    const PathVertex& before = path.vertices.back();
    vertex.pdf_forward =
        path.direction_pdf * solid_angle_per_area(scene_, before, vertex) * passing(before, vertex) * event;
    path.vertices.push_back(std::move(vertex));
  }

  // The last vertex has drawn the path's ray: what it would have drawn the other way, and what it did.
  void leave(RecordedPath& path) {
    const PathVertex& vertex = path.vertices.back();
    PathVertex& before = path.vertices[path.vertices.size() - 2];
    if (vertex.delta) {
      path.direction_pdf = SampledSpectrum();
      return;
    }
    const Imath::V3f back = way_from(vertex, before).direction;
    path.direction_pdf = abbe::direction_pdf(scene_, vertex, back, path.ray.direction);
    before.pdf_reverse = abbe::direction_pdf(scene_, vertex, path.ray.direction, back) *
                         solid_angle_per_area(scene_, vertex, before) * passing(before, vertex) *
                         before.event_pdf;
  }

  const Scene& scene_;
  RayCaster& caster_;
  RandomWalks<PathRecorder> walks_;
};

}  // namespace abbe
