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
#include "transport/path/interface.h"
#include "transport/path/polarised_draw.h"
#include "transport/path/ray_caster.h"
#include "transport/path/roulette.h"
#include "transport/path/vertex.h"
#include "transport/path/walk.h"

namespace abbe {

/// What a technique does with its paths on their way. A path is a `Walk` of its direction; `kMode` says which
/// quantity it carries. `u` are numbers in [0, 1). The calls come in this order: at the end of each ray
/// `escape`, or `meet`; if the path may have another event there and the surface is not black `reach`,
/// `connect` where it scatters, `scatter`, `follows`, and `kept` once packet, ray and surroundings are those
/// after the event. Where matter scatters the path before its ray ends `follows_within`, `connect_within` and
/// `kept_within`. Whatever has to be done when the path has left a vertex, along its new ray, is done in
/// `kept` and `kept_within`.
///
/// A technique may have `split_bits(path)` besides, so that a path goes on in 2^bits where it scatters at a
/// surface, and `split(part, bits)`, told each of these; `joins_directions(path)`, whether it scatters at a
/// matt surface by two numbers alone, so that those left over may draw its next direction; `parts_lanes()`,
/// whether its paths are to go on lane by lane where smooth glass disperses them; and `connects_along()` with
/// `connect_along(path, stretch, u)`, a connection from along matter that scatters evenly, before the event
/// that ends the stretch. `adds_path(path)` returns a random number in [0, 1) for roulette if a
/// second path leaves the current vertex of `path`. `scatter_added(path, vertex)` then turns a copy of `path`
/// into that second one and returns its event there. One that works out by itself with which
/// density each event was drawn makes `kDrawsPolarised` false.
template <typename T>
concept WalkingTechnique = std::derived_from<typename T::Path, Walk> &&
    std::constructible_from<typename T::Path, const Sampler&, std::uint32_t> &&
    requires(T technique, typename T::Path& path, const SurfaceHit& hit, const SurfaceVertex& vertex,
             const PhaseFunction& phase, const BsdfSample& event, const BsdfRandom& random,
             const std::array<float, 4>& u) {
  { T::kMode } -> std::convertible_to<TransportMode>;
  // A path leaves the scene, or comes to a surface.
  technique.escape(path);
  technique.meet(path, hit);
  // It has come to where it may scatter.
  technique.reach(path, vertex);
  // It may be connected to the end of another, from a surface or from within matter.
  technique.connect(path, vertex, u);
  technique.connect_within(path, phase, u);
  // An event there, drawn by the numbers given.
  { technique.scatter(path, vertex, random) } -> std::same_as<std::optional<BsdfSample>>;
  // Whether it may go on after an event.
  { technique.follows(path, event) } -> std::same_as<bool>;
  { technique.follows_within(path) } -> std::same_as<bool>;
  // What roulette goes by, after an event.
  { technique.kept(path, vertex, event) } -> std::same_as<float>;
  { technique.kept_within(path) } -> std::same_as<float>;
  // Its throughput over what it set out with.
  { technique.carried(path) } -> std::same_as<float>;
  // The connections of all paths, at the end of each step.
  technique.resolve_connections();
};

/// Whether a technique balances the lanes of its paths alone, so that its walks may draw events as polarised
/// light has them; the others work out for themselves with which density each event of a path was drawn.
template <typename Technique>
inline constexpr bool kDrawsPolarised = true;

/// How soon long paths of a technique end at surfaces, the `a` of `survival`; within matter all are those
/// of `kEndingOfPaths`.
template <typename Technique>
inline constexpr float kEnding = kEndingOfPaths;

/// Whether a smooth dispersive model refracts each lane its own way, and never reflects one that draws the
/// number `kRefracted` unless all of its light is reflected.
[[nodiscard]] inline bool refracts_each_lane(const Bsdf& bsdf) {
  return is_any_of<DielectricBsdf, CoatedDielectricBsdf>(bsdf);
}
inline constexpr BsdfRandom kRefracted{0x1.fffffep-1F, {0, 0}};

/// Random walks of many paths that take each step together: rays are cast together, and each path goes on by
/// itself. What becomes of a path does not depend on the others.
template <typename Technique>
class RandomWalks {
 public:
  using Path = typename Technique::Path;

  RandomWalks(const Scene& scene, RayCaster& caster)
      : scene_(scene),
        caster_(caster),
        has_free_paths_(abbe::has_free_paths(scene)),
        most_events_(most_events(scene.render)) {}

  /// The paths of the batch, and below the indices of those that go on.
  [[nodiscard]] std::vector<Path>& paths() { return paths_; }
  [[nodiscard]] std::vector<std::uint32_t>& going() { return going_; }
  [[nodiscard]] bool has_free_paths() const { return has_free_paths_; }

  /// Takes the paths that go on to their ends.
  void run(Technique& technique) {
    static_assert(WalkingTechnique<Technique>);
    take_parted();
    while (!going_.empty()) step(technique);
  }

  /// Scatters a path at a vertex; connects it first, where that pays. Whether it goes on.
  bool leave(Technique& technique, Path& path, const SurfaceVertex& vertex) {
    technique.reach(path, vertex);
    const auto [u, v] = path.sampler.two_groups(scattering_group(path.events));
    if (scatters(vertex.bsdf)) {
      technique.connect(path, vertex, v);
      if constexpr (requires { technique.split_bits(path); })
        if (const int bits = technique.split_bits(path); bits > 0) {
          split(technique, path, vertex, bits);
          return false;
        }
    }
    return scatter(technique, path, vertex, u);
  }

 private:
  // Scatters a path at a vertex. Whether it goes on.
  bool scatter(Technique& technique, Path& path, const SurfaceVertex& vertex, std::array<float, 4> u) {
    add_path(technique, path, vertex);
    if constexpr (requires { technique.joins_directions(path); }) join_directions(technique, path, vertex, u);
    const bool drawn = path.packet.polarisation && kDrawsPolarised<Technique> && draws_polarised(vertex.bsdf);
    const float choice =
        drawn ? polarised_choice(path.packet, vertex, path.ray.direction, Technique::kMode, u[2]) : u[2];
    const auto event = technique.scatter(path, vertex, BsdfRandom{choice, {u[0], u[1]}});
    if (!event || !technique.follows(path, *event)) return false;
    if constexpr (requires { technique.parts_lanes(); })
      if (event->dispersive && technique.parts_lanes() && refracts_each_lane(vertex.bsdf) &&
          !path.packet.lone_lane()) {
        part(technique, path, vertex, drawn, u[3]);
        return false;
      }
    return follow(technique, path, vertex, *event, drawn, u[3]);
  }

  // Starts a second path from a vertex if the technique requests one.
  void add_path(Technique& technique, const Path& path, const SurfaceVertex& vertex) {
    if constexpr (requires { technique.adds_path(path); }) {
      const std::optional<float> u = technique.adds_path(path);
      if (!u) return;
      Path added = path;
      const std::optional<BsdfSample> event = technique.scatter_added(added, vertex);
      if (event && follow(technique, added, vertex, *event, false, *u)) parted_.push_back(std::move(added));
    }
  }

  // What two directions after each other lead to is an integrand of four numbers, which the points of one
  // group fill more evenly than those of two. A matt surface chooses no lobe, and early events play no
  // roulette: their other two numbers draw the direction that follows, if that is at a matt surface too.
  // Elsewhere the choice of a lobe would fall apart from the direction that it is for.
  void join_directions(const Technique& technique, Path& path, const SurfaceVertex& vertex,
                       std::array<float, 4>& u) const {
    const std::optional<Imath::V2f> left = std::exchange(path.left_over, std::nullopt);
    if (!std::holds_alternative<DiffuseBsdf>(vertex.bsdf)) return;
    if (left) {
      u[0] = left->x;
      u[1] = left->y;
    } else if (technique.joins_directions(path) && !plays_roulette(scene_.render, path.events + 1)) {
      path.left_over.emplace(u[2], u[3]);
    }
  }

  // Lets 2^bits paths go on from a vertex, each with its share of what that path carries.
  void split(Technique& technique, const Path& path, const SurfaceVertex& vertex, int bits) {
    for (std::uint32_t number = 0; number < 1U << bits; ++number) {
      Path part = path;
      part.sampler = path.sampler.part(number, bits);
      part.packet.throughput *= std::ldexp(1.0F, -bits);
      technique.split(part, bits);
      if (scatter(technique, part, vertex, part.sampler.group(scattering_group(path.events))))
        parted_.push_back(std::move(part));
    }
  }

  // Takes a path on after an event. Whether it goes on.
  bool follow(Technique& technique, Path& path, const SurfaceVertex& vertex, const BsdfSample& event,
              bool drawn, float u) {
    path.connected = event.delta ? 0.0F : path.packet.lane_pdf.sum() / event.pdf;
    path.last = vertex.place();
    advance(path.packet, event);
    if (path.packet.polarisation)
      polarise(path, vertex.mueller(event.wi, event.delta, path.packet.lone_lane()), drawn);
    if (event.transmitted)
      path.around.enter(scene_, vertex.behind(scene_, path.around.inside), path.lambda_nm());
    path.ray = vertex.leave(vertex.frame.to_world(event.wi), path.ray.time);
    const float ending =
        event.delta ? std::max(kEnding<Technique>, kEndingOfSpecularPaths) : kEnding<Technique>;
    return survives(path, technique.kept(path, vertex, event), ending, u);
  }

  // Where a path is refracted by dispersive glass, each of its lanes goes on by itself, along its own
  // refraction and by its own random numbers. With t_k the probability that lane k would have refracted, the
  // path has come there with a density in proportion to sum_k P_k t_k, whichever lane is the hero, and lane j
  // carries f_j over that.
  void part(Technique& technique, const Path& path, const SurfaceVertex& vertex, bool drawn, float u) {
    std::array<std::optional<BsdfSample>, kLanes> ways;
    float density = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(path.packet.lane_pdf[lane] > 0)) continue;
      const auto way = vertex.scatter(kRefracted, lane, Technique::kMode);
      if (!way || !way->transmitted) continue;
      density +=
          path.packet.lane_pdf[lane] *
          (drawn ? 1 - polarised_reflectance(path.packet, vertex, path.ray.direction, Technique::kMode, lane)
                 : way->pdf);
      ways[static_cast<std::size_t>(lane)] = way;
    }
    if (!(density > 0)) return;
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto& way = ways[static_cast<std::size_t>(lane)];
      const float carried = path.packet.throughput[lane];
      if (!way || !(carried > 0)) continue;
      Path& parted = parted_.emplace_back(path);
      parted.sampler = path.sampler.branch(static_cast<std::uint32_t>(lane));
      parted.packet.hero = lane;
      parted.packet.throughput = SampledSpectrum::only(lane, carried * way->pdf / density);
      parted.packet.lane_pdf = SampledSpectrum::only(lane, 1);
      if (!follow(technique, parted, vertex, *way, false, u)) parted_.pop_back();
    }
  }

  void step(Technique& technique) {
    rays_.clear();
    for (const std::uint32_t i : going_) rays_.push_back(paths_[i].ray);
    hits_.resize(rays_.size());
    caster_.intersect(rays_, hits_);
    std::size_t left = 0;
    for (std::size_t k = 0; k < going_.size(); ++k)
      if (advance_path(technique, paths_[going_[k]], hits_[k])) going_[left++] = going_[k];
    going_.resize(left);
    take_parted();
    technique.resolve_connections();
  }

  // Appends the paths split off from others to those under way.
  void take_parted() {
    for (Path& path : parted_) {
      going_.push_back(static_cast<std::uint32_t>(paths_.size()));
      paths_.push_back(std::move(path));
    }
    parted_.clear();
  }

  // Along its ray, the nearest hit of which is `hit`.
  Arrival arrive(Technique& technique, Path& path, std::optional<SurfaceHit>& hit) {
    if (has_free_paths_)
      return propagate(scene_, caster_, free_path(path), path, hit, visitor(technique, path));
    if (!hit) return Arrival::outside;
    path.around.medium.attenuate(path.packet.throughput, hit->t);
    return Arrival::surface;
  }

  // The numbers that draw how far it comes: directions and ways of paths within matter are an integrand of
  // three, which one group fills.
  [[nodiscard]] static Imath::V2f free_path(Path& path) {
    if (const auto left = std::exchange(path.free_path, std::nullopt)) return *left;
    const std::array<float, 4> u = path.sampler.group(free_path_group(path.events));
    return {u[0], u[1]};
  }

  // From its last vertex, its ray's nearest hit being `hit`, to its next one and on. Whether it goes on.
  bool advance_path(Technique& technique, Path& path, std::optional<SurfaceHit>& hit) {
    const Arrival arrival = arrive(technique, path, hit);
    if (arrival == Arrival::matter) return scatter_within(technique, path);
    if (arrival == Arrival::outside) technique.escape(path);
    if (arrival != Arrival::surface) return false;
    std::optional<Interface> met;
    if (scene_.needs.nesting) {
      met = interface_at(scene_, path.ray, *hit, path.around.inside);
      hit = met->hit;
    }
    if (scene_.hides_beyond(*hit, path.ray.direction, path.ray.time)) return false;
    technique.meet(path, *hit);
    const SurfaceVertex vertex(scene_, *hit, met, path);
    return !is_black(vertex.bsdf) && !is_cut(technique, path) && leave(technique, path, vertex);
  }

  // What a technique does along matter that scatters, if anything.
  StretchVisitor visitor(Technique& technique, Path& path) const {
    if constexpr (requires { technique.connects_along(); })
      if (technique.connects_along() && path.events < most_events_)
        return [&technique, &path](const Stretch& stretch) {
          const std::array<float, 4> u = path.sampler.group(free_path_group(path.events));
          technique.connect_along(path, stretch, {u[2], u[3]});
        };
    return {};
  }

  bool scatter_within(Technique& technique, Path& path) {
    if (!technique.follows_within(path) || is_cut(technique, path)) return false;
    const PhaseFunction& phase = path.around.medium.scattering->phase;
    const auto [u, v] = path.sampler.two_groups(scattering_group(path.events));
    technique.connect_within(path, phase, v);
    path.free_path.emplace(u[2], v[3]);  // of the second no more than digits beyond the first's
    path.last = {path.ray.origin, std::nullopt};
    path.ray.direction = turn(path, phase, {u[0], u[1]});
    return survives(path, technique.kept_within(path), kEndingOfPaths, u[3]);
  }

  // A direction drawn within matter, in which the path is connected and polarised as if it went there.
  Imath::V3f turn(Path& path, const PhaseFunction& phase, const Imath::V2f& u) {
    const Imath::V3f& along = path.ray.direction;
    const float lanes = path.packet.lane_pdf.sum();
    if (!path.packet.polarisation) {
      const PhaseSample turned = sample(phase, u);
      path.connected = lanes / turned.pdf;
      return Basis<float>(along).to_world(turned.direction);
    }
    const bool drawn = kDrawsPolarised<Technique> && std::holds_alternative<RayleighPhase>(phase);
    const PhaseSample plain = sample(phase, u);
    const TurnedDirection turned =
        drawn ? polarised_turn(path.packet, phase, along, Technique::kMode, u)
              : TurnedDirection{Basis<float>(along).to_world(plain.direction), plain.pdf};
    path.connected = lanes / (turned.pdf * polarise(path, mueller(phase, along, turned.direction), drawn));
    return turned.direction;
  }

  // Takes the polarisation of a path that carries any through an event to which it has come along its ray.
  // Returns by how much more densely than as of unpolarised light the event was drawn.
  float polarise(Path& path, const std::optional<MuellerMatrix>& matrix, bool drawn) {
    const Imath::V3f travels = light_travels(path.ray.direction, Technique::kMode);
    if (drawn) return polarise_drawn(path.packet, matrix, travels, Technique::kMode);
    abbe::polarise(path.packet, matrix, travels, Technique::kMode);
    return 1;
  }

  // Whether a path may not have another event.
  bool is_cut(const Technique& technique, const Path& path) {
    if (path.events < most_events_) return false;
    caster_.count_cut(technique.carried(path));
    return true;
  }

  bool survives(Path& path, float kept, float ending, float u) const {
    ++path.events;
    if (path.packet.throughput.is_zero()) return false;
    if (!plays_roulette(scene_.render, path.events)) return true;
    const float q = survival(kept, path.events, ending);
    if (u >= q) return false;
    survive(path.packet, q);
    return true;
  }

  const Scene& scene_;
  RayCaster& caster_;
  bool has_free_paths_;
  int most_events_;
  std::vector<Path> paths_;
  std::vector<Path> parted_;  // split off from others, in the current step or before the first
  std::vector<std::uint32_t> going_;
  std::vector<Ray> rays_;  // of those
  std::vector<std::optional<SurfaceHit>> hits_;
};

}  // namespace abbe
