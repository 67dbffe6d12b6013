#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "materials/medium/phase.h"
#include "transport/path/dimensions.h"
#include "transport/path/free_path.h"
#include "transport/path/path_state.h"
#include "transport/path/polarised_paths.h"
#include "transport/path/ray_caster.h"
#include "transport/path/roulette.h"
#include "transport/path/vertex.h"

namespace abbe {

/// Callbacks by which a technique takes part in the steps of its paths, with their defaults. This is the loop
/// of `PathBatch::run`:
///
///     while paths are active:
///       each path finds its next event.
///         Out of the scene: on_escape.
///         At a surface: on_hit, prepare_scatter, connect, scatter, continues_after, survival_weight.
///         In a medium: continues_in_medium, connect_in_medium, survival_weight_in_medium.
///       Roulette ends paths by their survival weights.
///       resolve_connections.
///
/// A technique derives from this class and hides the callbacks that it needs; none is virtual. Its `Path` is
/// a `PathState`, and `mode` is the quantity that paths carry. `u` are random numbers in [0, 1). No path
/// scatters on a black surface or at the maximum depth: only `on_hit` is then called. Both functions for the
/// survival weight are called after packet, ray and media are updated. Work along the new ray of a path
/// belongs there.
template <TransportMode mode>
class PathCallbacks {
 public:
  static constexpr TransportMode kMode = mode;
  /// True if the technique balances wavelengths only, so that its paths may sample events with polarised
  /// pdfs. Other techniques compute the pdf of each event themselves.
  static constexpr bool kSamplesPolarised = true;
  /// Exponent `a` of `survival` for long paths at surfaces; in media all use `kPathRouletteExponent`.
  static constexpr float kRouletteExponent = kPathRouletteExponent;

  /// The path leaves the scene, or hits a surface.
  static void on_escape(PathState& /*path*/) {}
  static void on_hit(PathState& /*path*/, const SurfaceHit& /*hit*/) {}
  /// The path is at a surface at which it may scatter.
  static void prepare_scatter(PathState& /*path*/, const SurfaceVertex& /*vertex*/) {}
  /// The vertex may be connected to another path or light: on a surface that is not specular, or in a medium.
  static void connect(PathState& /*path*/, const SurfaceVertex& /*vertex*/,
                      const std::array<float, 4>& /*u*/) {}
  static void connect_in_medium(PathState& /*path*/, const PhaseFunction& /*phase*/,
                                const std::array<float, 4>& /*u*/) {}
  /// Samples an event. Nothing ends the path.
  [[nodiscard]] static std::optional<BsdfSample> scatter(const PathState& path, const SurfaceVertex& vertex,
                                                         const BsdfRandom& u) {
    return vertex.scatter(u, path.packet.hero, mode);
  }
  /// True if the path may continue after an event.
  [[nodiscard]] static bool continues_after(const PathState& /*path*/, const BsdfSample& /*event*/) {
    return true;
  }
  [[nodiscard]] static bool continues_in_medium(const PathState& /*path*/) { return true; }
  /// Estimate with which roulette decides. By default it is the throughput of the event, because the power of
  /// a photon does not predict its contribution.
  [[nodiscard]] static float survival_weight(const PathState& /*path*/, const SurfaceVertex& /*vertex*/,
                                             const BsdfSample& event) {
    return event_throughput(event);
  }
  [[nodiscard]] static float survival_weight_in_medium(const PathState& /*path*/) { return 1; }
  /// Adds the queued connections of all paths.
  static void resolve_connections() {}

  /// True if paths split into their wavelengths at smooth dispersive glass.
  [[nodiscard]] static bool splits_wavelengths() { return false; }
  /// Base-2 logarithm of the number of paths that continue from a scattering surface. `on_split` receives
  /// each of them.
  [[nodiscard]] static int log2_splits(const PathState& /*path*/) { return 0; }
  static void on_split(PathState& /*child*/, int /*log2_count*/) {}
  /// True if the random numbers that a matt surface does not use may draw the next direction.
  [[nodiscard]] static bool reuses_spare_dimensions(const PathState& /*path*/) { return false; }
  /// Connection from a point along a homogeneous scattering segment, before the event that ends it, if
  /// `connects_equiangular` is true.
  [[nodiscard]] static bool connects_equiangular() { return false; }
  static void connect_equiangular(PathState& /*path*/, const MediumSegment& /*segment*/,
                                  const Imath::V2f& /*u*/) {}
  /// Random number in [0, 1) for roulette if a second path leaves the current vertex, otherwise nothing.
  /// `scatter_added` turns a copy of the path into the second one and returns its event; nothing ends it.
  [[nodiscard]] static std::optional<float> adds_path(const PathState& /*path*/) { return std::nullopt; }
  [[nodiscard]] static std::optional<BsdfSample> scatter_added(PathState& /*path*/,
                                                               const SurfaceVertex& /*vertex*/) {
    return std::nullopt;
  }
};

/// A technique that traces paths. The concept checks the arguments of the callbacks that it hides.
template <typename T>
concept PathTechnique = std::derived_from<T, PathCallbacks<T::kMode>> &&
    std::derived_from<typename T::Path, PathState> &&
    std::constructible_from<typename T::Path, const Sampler&, std::uint32_t> &&
    requires(T technique, typename T::Path& path, const SurfaceHit& hit, const SurfaceVertex& vertex,
             const PhaseFunction& phase, const BsdfSample& event, const BsdfRandom& random,
             const std::array<float, 4>& u) {
  technique.on_escape(path);
  technique.on_hit(path, hit);
  technique.prepare_scatter(path, vertex);
  technique.connect(path, vertex, u);
  technique.connect_in_medium(path, phase, u);
  { technique.scatter(path, vertex, random) } -> std::same_as<std::optional<BsdfSample>>;
  { technique.continues_after(path, event) } -> std::same_as<bool>;
  { technique.continues_in_medium(path) } -> std::same_as<bool>;
  { technique.survival_weight(path, vertex, event) } -> std::same_as<float>;
  { technique.survival_weight_in_medium(path) } -> std::same_as<float>;
  technique.resolve_connections();
};

/// A model that `refracts_smoothly` reflects with this random number only at total reflection.
inline constexpr BsdfRandom kRefracted{0x1.fffffep-1F, {0, 0}};

/// Batch of paths that take each step together: their rays are traced as a stream, then each path is updated
/// independently of the others. One instance per thread.
template <typename Technique>
class PathBatch {
 public:
  using Path = typename Technique::Path;

  /// Scene and caster must outlive the batch.
  PathBatch(const Scene& scene, RayCaster& caster)
      : scene_(scene),
        caster_(caster),
        has_free_paths_(abbe::has_free_paths(scene)),
        max_depth_(depth_limit(scene.render)) {}

  /// Paths of the batch. The technique starts them with ray, packet and media, before `run`. Paths that split
  /// off are appended.
  [[nodiscard]] std::vector<Path>& paths() { return paths_; }
  /// Indices in `paths()` of those that have not ended; the technique adds those that it starts.
  [[nodiscard]] std::vector<std::uint32_t>& active() { return active_; }
  /// True if paths may have events between surfaces; see the function of that name.
  [[nodiscard]] bool has_free_paths() const { return has_free_paths_; }

  /// Traces all active paths, and those that split off, to their ends. `active()` is then empty. Throws
  /// Error{resource} if more than `MediumStack::kMaxShapes` media nest.
  void run(Technique& technique) {
    static_assert(PathTechnique<Technique>);
    append_children();
    while (!active_.empty()) step(technique);
  }

  /// Scatters a path at a vertex, after connecting it if the surface is not specular. Returns true if the
  /// path continues; paths that split off continue in the next step.
  bool scatter_at(Technique& technique, Path& path, const SurfaceVertex& vertex) {
    technique.prepare_scatter(path, vertex);
    const auto [u, v] = path.sampler.two_groups(scattering_group(path.depth));
    if (scatters(vertex.bsdf)) {
      technique.connect(path, vertex, v);
      if (const int log2_count = technique.log2_splits(path); log2_count > 0) {
        split(technique, path, vertex, log2_count);
        return false;
      }
    }
    return scatter(technique, path, vertex, u);
  }

 private:
  // Scatters a path at a vertex. Returns true if the path continues.
  bool scatter(Technique& technique, Path& path, const SurfaceVertex& vertex, std::array<float, 4> u) {
    add_second_path(technique, path, vertex);
    reuse_spare_dimensions(technique, path, vertex, u);
    const bool drawn =
        path.packet.polarisation && Technique::kSamplesPolarised && samples_polarised(vertex.bsdf);
    const float choice =
        drawn ? polarised_choice(path.packet, vertex, path.ray.direction, Technique::kMode, u[2]) : u[2];
    const auto event = technique.scatter(path, vertex, BsdfRandom{choice, {u[0], u[1]}});
    if (!event || !technique.continues_after(path, *event)) return false;
    if (event->dispersive && technique.splits_wavelengths() && refracts_smoothly(vertex.bsdf) &&
        !path.packet.lone_lane()) {
      split_wavelengths(technique, path, vertex, drawn, u[3]);
      return false;
    }
    return apply_event(technique, path, vertex, *event, drawn, u[3]);
  }

  // Adds a second path at a vertex if the technique requests one.
  void add_second_path(Technique& technique, const Path& path, const SurfaceVertex& vertex) {
    const std::optional<float> u = technique.adds_path(path);
    if (!u) return;
    Path added = path;
    const std::optional<BsdfSample> event = technique.scatter_added(added, vertex);
    if (event && apply_event(technique, added, vertex, *event, false, *u))
      children_.push_back(std::move(added));
  }

  // Two consecutive directions are an integrand of four dimensions, which the points of one group cover more
  // evenly than those of two groups. A matt surface chooses no lobe, and early events play no roulette. Their
  // other two numbers draw the next direction if that is at a matt surface too. At other surfaces the choice
  // of a lobe and its direction would come from different groups.
  void reuse_spare_dimensions(const Technique& technique, Path& path, const SurfaceVertex& vertex,
                              std::array<float, 4>& u) const {
    const std::optional<Imath::V2f> left = std::exchange(path.spare_u, std::nullopt);
    if (!std::holds_alternative<DiffuseBsdf>(vertex.bsdf)) return;
    if (left) {
      u[0] = left->x;
      u[1] = left->y;
    } else if (technique.reuses_spare_dimensions(path) && !plays_roulette(scene_.render, path.depth + 1)) {
      path.spare_u.emplace(u[2], u[3]);
    }
  }

  // Continues a path as 2^log2_count children, each with an equal fraction of its throughput.
  void split(Technique& technique, const Path& path, const SurfaceVertex& vertex, int log2_count) {
    for (std::uint32_t number = 0; number < 1U << log2_count; ++number) {
      Path child = path;
      child.sampler = path.sampler.split_child(number, log2_count);
      child.packet.throughput *= std::ldexp(1.0F, -log2_count);
      technique.on_split(child, log2_count);
      if (scatter(technique, child, vertex, child.sampler.group(scattering_group(path.depth))))
        children_.push_back(std::move(child));
    }
  }

  // Updates a path after an event. Returns true if the path continues.
  bool apply_event(Technique& technique, Path& path, const SurfaceVertex& vertex, const BsdfSample& event,
                   bool drawn, float u) {
    path.nee_path_pdf = event.delta ? 0.0F : path.packet.lane_pdf.sum() / event.pdf;
    path.prev_context = vertex.light_context();
    advance(path.packet, event);
    if (path.packet.polarisation)
      polarise(path, vertex.mueller(event.wi, event.delta, path.packet.lone_lane()), drawn);
    if (event.transmitted)
      path.media.enter(scene_, vertex.media_behind(scene_, path.media.stack), path.lambda_nm());
    path.ray = vertex.spawn_ray(vertex.frame.to_world(event.wi), path.ray.time);
    const float rr_exponent = event.delta ? std::max(Technique::kRouletteExponent, kSpecularRouletteExponent)
                                          : Technique::kRouletteExponent;
    return survives_roulette(path, technique.survival_weight(path, vertex, event), rr_exponent, u);
  }

  // Splits a path that dispersive glass refracts into its wavelengths, each with its own refraction and
  // random numbers. With the probability t_k that wavelength k is refracted, the pdf of the path is in
  // proportion to sum_k P_k t_k, whichever wavelength is the hero. Wavelength j carries f_j over that.
  void split_wavelengths(Technique& technique, const Path& path, const SurfaceVertex& vertex, bool drawn,
                         float u) {
    std::array<std::optional<BsdfSample>, kLanes> events;
    float density = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(path.packet.lane_pdf[lane] > 0)) continue;
      const auto event = vertex.scatter(kRefracted, lane, Technique::kMode);
      if (!event || !event->transmitted) continue;
      density +=
          path.packet.lane_pdf[lane] *
          (drawn ? 1 - polarised_reflectance(path.packet, vertex, path.ray.direction, Technique::kMode, lane)
                 : event->pdf);
      events[static_cast<std::size_t>(lane)] = event;
    }
    if (!(density > 0)) return;
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto& event = events[static_cast<std::size_t>(lane)];
      const float throughput = path.packet.throughput[lane];
      if (!event || !(throughput > 0)) continue;
      Path& child = children_.emplace_back(path);
      child.sampler = path.sampler.branch(static_cast<std::uint32_t>(lane));
      child.packet.hero = lane;
      child.packet.throughput = SampledSpectrum::only(lane, throughput * event->pdf / density);
      child.packet.lane_pdf = SampledSpectrum::only(lane, 1);
      if (!apply_event(technique, child, vertex, *event, false, u)) children_.pop_back();
    }
  }

  void step(Technique& technique) {
    rays_.clear();
    for (const std::uint32_t i : active_) rays_.push_back(paths_[i].ray);
    hits_.resize(rays_.size());
    caster_.intersect(rays_, hits_);
    std::size_t count = 0;
    for (std::size_t k = 0; k < active_.size(); ++k)
      if (step_path(technique, paths_[active_[k]], hits_[k])) active_[count++] = active_[k];
    active_.resize(count);
    append_children();
    technique.resolve_connections();
  }

  // Appends the children to the active paths.
  void append_children() {
    for (Path& path : children_) {
      active_.push_back(static_cast<std::uint32_t>(paths_.size()));
      paths_.push_back(std::move(path));
    }
    children_.clear();
  }

  // Advances a path along its ray, whose nearest hit is `hit`.
  SegmentEnd find_segment_end(Technique& technique, Path& path, std::optional<SurfaceHit>& hit) {
    if (has_free_paths_)
      return propagate(scene_, caster_, free_path_numbers(path), path, hit, visitor(technique, path));
    if (!hit) return SegmentEnd::escape;
    path.media.medium.attenuate(path.packet.throughput, hit->t);
    return SegmentEnd::surface;
  }

  // Random numbers of the free path. Direction and free path in a medium are an integrand of three
  // dimensions, which one group covers.
  [[nodiscard]] static Imath::V2f free_path_numbers(Path& path) {
    if (const auto left = std::exchange(path.free_path_u, std::nullopt)) return *left;
    const std::array<float, 4> u = path.sampler.group(free_path_group(path.depth));
    return {u[0], u[1]};
  }

  // Advances a path from its last vertex to the next one, `hit` being the nearest hit of its ray, and
  // scatters it there. Returns true if the path continues.
  bool step_path(Technique& technique, Path& path, std::optional<SurfaceHit>& hit) {
    const SegmentEnd end = find_segment_end(technique, path, hit);
    if (end == SegmentEnd::medium) return scatter_in_medium(technique, path);
    if (end == SegmentEnd::escape) technique.on_escape(path);
    if (end != SegmentEnd::surface) return false;
    std::optional<Interface> interface;
    if (scene_.features.nesting) {
      interface = interface_at(scene_, path.ray, *hit, path.media.stack);
      hit = interface->hit;
    }
    if (scene_.transmission_may_leak(*hit, path.ray.direction, path.ray.time)) return false;
    technique.on_hit(path, *hit);
    const SurfaceVertex vertex(scene_, *hit, interface, path);
    return !is_black(vertex.bsdf) && !is_truncated(path) && scatter_at(technique, path, vertex);
  }

  // Callback of the technique for scattering segments, if it has one.
  SegmentVisitor visitor(Technique& technique, Path& path) const {
    if (!technique.connects_equiangular() || path.depth >= max_depth_) return {};
    return [&technique, &path](const MediumSegment& segment) {
      const std::array<float, 4> u = path.sampler.group(free_path_group(path.depth));
      technique.connect_equiangular(path, segment, {u[2], u[3]});
    };
  }

  bool scatter_in_medium(Technique& technique, Path& path) {
    if (!technique.continues_in_medium(path) || is_truncated(path)) return false;
    const PhaseFunction& phase = path.media.medium.scattering->phase;
    const auto [u, v] = path.sampler.two_groups(scattering_group(path.depth));
    technique.connect_in_medium(path, phase, v);
    path.free_path_u.emplace(u[2], v[3]);  // of v[3] only the digits that extend u[2] are used
    path.prev_context = {path.ray.origin, std::nullopt};
    path.ray.direction = sample_phase_direction(path, phase, {u[0], u[1]});
    return survives_roulette(path, technique.survival_weight_in_medium(path), kPathRouletteExponent, u[3]);
  }

  // Samples a direction in a medium and updates the path's NEE pdf and polarisation for it.
  Imath::V3f sample_phase_direction(Path& path, const PhaseFunction& phase, const Imath::V2f& u) {
    const Imath::V3f& along = path.ray.direction;
    const float lanes = path.packet.lane_pdf.sum();
    if (!path.packet.polarisation) {
      const PhaseSample turned = sample(phase, u);
      path.nee_path_pdf = lanes / turned.pdf;
      return Basis<float>(along).to_world(turned.direction);
    }
    const bool drawn = Technique::kSamplesPolarised && std::holds_alternative<RayleighPhase>(phase);
    const PhaseSample plain = sample(phase, u);
    const PolarisedDirection turned =
        drawn ? sample_polarised_phase(path.packet, phase, along, Technique::kMode, u)
              : PolarisedDirection{Basis<float>(along).to_world(plain.direction), plain.pdf};
    path.nee_path_pdf = lanes / (turned.pdf * polarise(path, mueller(phase, along, turned.direction), drawn));
    return turned.direction;
  }

  // Applies an event to the path's polarisation. Returns the factor between the pdf with which the event was
  // sampled and the unpolarised one.
  float polarise(Path& path, const std::optional<MuellerMatrix>& matrix, bool drawn) {
    const Imath::V3f travels = light_travels(path.ray.direction, Technique::kMode);
    if (drawn) return polarise_sampled(path.packet, matrix, travels, Technique::kMode);
    abbe::polarise(path.packet, matrix, travels, Technique::kMode);
    return 1;
  }

  // True if the path has the maximum depth; counts it as truncated.
  bool is_truncated(const Path& path) {
    if (path.depth < max_depth_) return false;
    caster_.count_truncated(path.throughput_estimate());
    return true;
  }

  bool survives_roulette(Path& path, float weight, float rr_exponent, float u) const {
    ++path.depth;
    if (path.packet.throughput.is_zero()) return false;
    if (!plays_roulette(scene_.render, path.depth)) return true;
    const float q = survival(weight, path.depth, rr_exponent);
    if (u >= q) return false;
    survive(path.packet, q);
    return true;
  }

  const Scene& scene_;
  RayCaster& caster_;
  bool has_free_paths_;
  int max_depth_;
  std::vector<Path> paths_;
  std::vector<Path> children_;  // paths split off in this step, or before the first one
  std::vector<std::uint32_t> active_;
  std::vector<Ray> rays_;  // of the active paths
  std::vector<std::optional<SurfaceHit>> hits_;
};

}  // namespace abbe
