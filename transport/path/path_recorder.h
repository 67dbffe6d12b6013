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
#include "transport/path/path_batch.h"
#include "transport/path/path_vertex.h"
#include "transport/path/polarised_paths.h"

namespace abbe {

/// Emission that a recorded path hit.
struct EmitterHit {
  std::size_t vertex_count;  ///< Number of vertices of the path before the hit.
  PathVertex vertex;         ///< Vertex on the light, which `RecordedPath::vertices` does not contain.
};

/// Path that stores its vertices.
struct RecordedPath : PathState {
  using PathState::PathState;
  std::vector<PathVertex> vertices;  ///< Vertices from the start of the path on; empty if it was not started.
  std::vector<EmitterHit> emitter_hits;  ///< Filled for camera paths only.
  /// Pdf, per wavelength, with which the last vertex sampled the ray: of its direction [1/sr], or of its
  /// position [1/m^2] if that vertex is a light at infinity. For a delta distribution see `PathRecorder`.
  SampledSpectrum direction_pdf{1.0F};
  float initial_throughput = 1;  ///< `PathPacket::throughput_estimate` at the start, for roulette.
  /// Product of `SurfaceVertex::squared_eta` over the events; it undoes the reduction of radiance by
  /// refraction.
  float eta_scale = 1;
  /// True if the path has returned to the position of its last vertex, within float resolution.
  bool is_stuck = false;

  /// Throughput relative to that at the start.
  [[nodiscard]] float throughput_estimate() const {
    return packet.throughput_estimate() * eta_scale / initial_throughput;
  }
};

/// Traces paths and stores their vertices for connection by other techniques: camera paths, which carry
/// radiance, or light paths, which carry power. A path ends if it returns to the position of its last vertex,
/// within float resolution. Such a vertex is not stored, nor one on a black surface or at the maximum depth.
/// One instance per thread.
///
/// The pdfs of a vertex are, per wavelength,
///     pdf_forward(x_i) = p(w_i) dw/dA pass,
///     pdf_reverse(x_i) = p(w_i') dw/dA pass.
/// p(w_i) is the pdf of the direction to it from x_{i-1}, p(w_i') that from x_{i+1}. `pass` is the
/// probability of passing the media between the vertices. At a vertex in a medium it includes the pdf of an
/// event there, e^(-depth) s_k with the extinction s_k. [Veach1997, sec. 10.2]
///
/// A delta event has a Dirac distribution over directions, and p is its factor:
/// - p = `delta_density` of the event for the direction towards the light, which camera paths sample;
/// - p = `delta_density` dw_light/dw_camera for the direction towards the camera, which light paths sample.
/// Here dw_light/dw_camera = (n_c^2 |cos_c|)/(n_l^2 |cos_l|) is the ratio of solid angles that refraction
/// relates. With it the pdfs of all strategies are in one measure.
template <TransportMode mode>
class PathRecorder : public PathCallbacks<mode> {
 public:
  using Path = RecordedPath;
  static constexpr bool kSamplesPolarised = false;
  static constexpr float kRouletteExponent = kJoinedRouletteExponent;

  /// Scene and caster must outlive the recorder.
  PathRecorder(const Scene& scene, RayCaster& caster)
      : scene_(scene), caster_(caster), batch_(scene, caster) {}

  /// All paths. A path to be traced needs its ray, packet, media, first vertex and `direction_pdf`. Paths
  /// without a vertex are not traced.
  [[nodiscard]] std::vector<RecordedPath>& paths() { return batch_.paths(); }
  /// Traces all paths to their ends. Throws as `PathBatch::run`.
  void run() {
    for (std::uint32_t i = 0; i < paths().size(); ++i)
      if (!paths()[i].vertices.empty()) batch_.active().push_back(i);
    batch_.run(*this);
  }

  /// Pdfs [1/sr], per wavelength: `forward` of a sampled direction, `reverse` of the direction to the
  /// previous vertex if the path came from the next one.
  struct DirectionPdfs {
    SampledSpectrum forward, reverse;
  };
  /// Pdfs of a delta event: the factors p of its Dirac distributions (see the class).
  [[nodiscard]] static DirectionPdfs single_direction(const SurfaceVertex& vertex, const BsdfSample& event,
                                                      int hero) {
    const float eta2 = vertex.squared_eta(event, hero);
    const float cosines = std::abs(vertex.wo.z / event.wi.z);
    const SampledSpectrum density = delta_density(vertex.bsdf, event, eta2, mode);
    if constexpr (mode == TransportMode::radiance)
      return {density, density * (cosines / eta2)};
    else
      return {density * (eta2 / cosines), density};
  }

  // Callbacks (`PathCallbacks`).
  void on_escape(RecordedPath& path) {
    if (mode == TransportMode::power) return;
    visit_escaped_lights(scene_, path, [&](const LightVertex& light) { record_emitter(path, light); });
  }
  void on_hit(RecordedPath& path, const SurfaceHit& hit) {
    if (mode == TransportMode::power) return;
    const std::optional<LightVertex> light = emitter_hit(scene_, hit, path.ray.direction);
    if (light && !is_same_point(path, hit.point)) record_emitter(path, *light);
  }
  void prepare_scatter(RecordedPath& path, const SurfaceVertex& vertex) {
    path.is_stuck = is_same_point(path, vertex.hit.point);
    if (path.is_stuck) return;
    PathVertex here{.at = vertex};
    here.media_behind = vertex.media_behind(scene_, path.media.stack);
    path.vertices.push_back(vertex_at(path, std::move(here)));
  }
  void connect_in_medium(RecordedPath& path, const PhaseFunction& phase, const std::array<float, 4>& /*u*/) {
    path.vertices.push_back(vertex_at(path, {.at = MediumVertex{path.ray.origin, path.ray.direction, phase},
                                             .media_behind = path.media.stack,
                                             .event_pdf = path.media.medium.extinction_per_m}));
  }
  [[nodiscard]] bool continues_after(const RecordedPath& path, const BsdfSample& /*event*/) const {
    return !path.is_stuck;
  }
  [[nodiscard]] bool continues_in_medium(const RecordedPath& path) const {
    return !is_same_point(path, path.ray.origin);
  }
  [[nodiscard]] float survival_weight(RecordedPath& path, const SurfaceVertex& vertex,
                                      const BsdfSample& event) {
    path.vertices.back().delta = event.delta;
    if (mode == TransportMode::radiance) path.eta_scale *= vertex.squared_eta(event, path.packet.hero);
    // The pdf of the event is used, because a lobe may be narrower than the angular resolution of vertex
    // positions.
    set_pdfs(path, event.delta ? single_direction(vertex, event, path.packet.hero)
                               : DirectionPdfs{event.lane_pdf * event.pdf, reverse_direction_pdf(path)});
    return path.throughput_estimate();
  }
  [[nodiscard]] float survival_weight_in_medium(RecordedPath& path) {
    set_pdfs(path, {direction_pdf(scene_, path.vertices.back(), direction_back(path), path.ray.direction),
                    reverse_direction_pdf(path)});
    return path.throughput_estimate();
  }

 private:
  // Two vertices at one position have no pdf of directions per area.
  [[nodiscard]] static bool is_same_point(const RecordedPath& path, const Imath::V3f& point) {
    const PathVertex& last = path.vertices.back();
    return !last.at_infinity() && point_of(last) == point;
  }
  // Probability, per wavelength, of passing all media between two vertices.
  [[nodiscard]] SampledSpectrum passing_pdf(const PathVertex& from, const PathVertex& to) {
    if (!batch_.has_free_paths()) return SampledSpectrum(1.0F);
    if (from.at_infinity()) return passing_pdf(to, from);  // symmetric, and no ray can start at infinity
    const PathSegment segment = segment_between(from, to);
    return transmission_along(scene_, caster_, from, segment).pdf;
  }

  // Completes the vertex at which a path has arrived with the state of the path.
  [[nodiscard]] PathVertex vertex_at(const RecordedPath& path, PathVertex vertex) {
    vertex.packet = path.packet;
    vertex.media_front = path.media.stack;
    vertex.time = path.ray.time;
    const PathVertex& before = path.vertices.back();
    vertex.pdf_forward = path.direction_pdf * solid_angle_per_area(scene_, before, vertex) *
                         passing_pdf(before, vertex) * vertex.event_pdf;
    return vertex;
  }
  void record_emitter(RecordedPath& path, const LightVertex& light) {
    path.emitter_hits.push_back({path.vertices.size(), vertex_at(path, {.at = light})});
  }

  // Unit direction from the last vertex to the one before it.
  [[nodiscard]] static Imath::V3f direction_back(const RecordedPath& path) {
    return segment_between(path.vertices.back(), path.vertices[path.vertices.size() - 2]).direction;
  }
  [[nodiscard]] SampledSpectrum reverse_direction_pdf(const RecordedPath& path) const {
    return direction_pdf(scene_, path.vertices.back(), path.ray.direction, direction_back(path));
  }
  void set_pdfs(RecordedPath& path, const DirectionPdfs& pdfs) {
    const PathVertex& vertex = path.vertices.back();
    PathVertex& before = path.vertices[path.vertices.size() - 2];
    path.direction_pdf = pdfs.forward;
    before.pdf_reverse = pdfs.reverse * solid_angle_per_area(scene_, vertex, before) *
                         passing_pdf(before, vertex) * before.event_pdf;
  }

  const Scene& scene_;
  RayCaster& caster_;
  PathBatch<PathRecorder> batch_;
};

/// Sums of the contributions of several paths to the film, per wavelength: power, or Stokes vectors if the
/// sensor distinguishes polarisation. Paths are numbered from 0.
class PathRadiance {
 public:
  explicit PathRadiance(const Scene& scene) : measures_polarisation_(measures_polarisation(scene)) {}

  /// Sets the sums of `paths` paths to zero.
  void reset(std::size_t paths) {
    if (measures_polarisation_)
      vectors_.assign(paths, {});
    else
      powers_.assign(paths, {});
  }
  /// Adds a contribution to the sum of a path. `stokes` is as for `with_measurement`; it must be given if the
  /// sensor measures polarisation.
  void add(std::size_t path, const SampledSpectrum& contribution, const StokesSpectrum* stokes) {
    with_measurement(measures_polarisation_, contribution, stokes, Adder{*this, path});
  }
  /// Calls `use` with one contribution in the form in which the film takes it: a `SampledSpectrum` or a
  /// `StokesSpectrum`. `stokes` is as for `with_measurement`.
  template <typename Use>
  void visit(const SampledSpectrum& contribution, const StokesSpectrum* stokes, Use use) const {
    with_measurement(measures_polarisation_, contribution, stokes, use);
  }
  /// Calls `use` with the sum of a path, in the same form.
  template <typename Use>
  void visit(std::size_t path, Use use) const {
    if (measures_polarisation_)
      use(vectors_[path]);
    else
      use(powers_[path]);
  }

 private:
  struct Adder {
    PathRadiance& to;
    std::size_t path;
    void operator()(const SampledSpectrum& power) const { to.powers_[path] += power; }
    void operator()(const StokesSpectrum& vector) const { to.vectors_[path] += vector; }
  };

  bool measures_polarisation_;
  std::vector<SampledSpectrum> powers_;
  std::vector<StokesSpectrum> vectors_;
};

}  // namespace abbe
