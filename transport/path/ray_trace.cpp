#include "transport/path/ray_trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "transport/path/interface.h"
#include "transport/path/medium_at.h"
#include "transport/path/ray_turn.h"

namespace abbe {
namespace {

using Kind = TraceEvent::Kind;

// A hit nearer than this share of the distances involved is the surface the ray starts from.
constexpr double kSelf = 1e-11;

// Where no index lies in another what depends on the index around it is in air. Boundaries of matter that
// touch are crossed together, out of what ends there first.
ActingSurface alone(const Scene& scene, std::span<const CrossedSurface> crossed, const MediumStack& inside) {
  ActingSurface surface{0, nullptr, inside};
  if (!inside.empty() && !depends_on_outside(material_of(scene, crossed.front().shape)))
    surface.outside = interior(material_of(scene, inside.innermost()));
  for (const bool entering : {false, true})
    for (const CrossedSurface& one : crossed)
      if (one.entering == entering) surface.beyond.cross(scene, one.shape, entering);
  return surface;
}

// What a ray meets at once: all surfaces that touch, where matter may.
struct Meeting {
  ExactHit acting;
  ActingSurface boundary;
  double spread;  // how far apart the surfaces are, along the normal
};

Meeting meet(const Scene& scene, const BasicRay<double>& ray, const ExactHit& first, double nearest,
             const MediumStack& inside) {
  const auto crossed_by = [&](const ExactHit& hit) {
    return CrossedSurface{hit.shape, hit.hit.normal.dot(ray.direction) < 0};
  };
  if (!scene.needs.nesting && !scene.needs.boundaries)
    return {first, alone(scene, std::array{crossed_by(first)}, inside), 0};
  const Imath::V3d& normal = first.hit.normal;
  BasicRay<double> rest = ray;
  rest.t_max =
      first.hit.t + scene.touch_distance(first.hit.point, first.shape) / std::abs(normal.dot(ray.direction));
  std::vector<ExactHit> met{first};
  double spread = 0;
  for (std::uint32_t i = 0; i < scene.shapes.size() && met.size() < TouchingSurfaces::kMost; ++i) {
    const auto hit = i == first.shape ? std::nullopt : intersect(scene.shapes[i].shape, rest, nearest);
    if (!hit || std::abs(hit->normal.dot(normal)) <= TouchingSurfaces::kParallel) continue;
    const double apart = std::abs((hit->point - first.hit.point).dot(normal));
    if (apart > scene.touch_distance(first.hit.point, first.shape, i)) continue;
    spread = std::max(spread, apart);
    met.push_back({*hit, i});
  }
  std::vector<CrossedSurface> crossed;
  for (const ExactHit& hit : met) crossed.push_back(crossed_by(hit));
  ActingSurface boundary =
      scene.needs.nesting ? acting_surface(scene, crossed, inside) : alone(scene, crossed, inside);
  return {met[boundary.acting.value_or(0)], boundary, spread};
}

// The media that a ray within `inside` is in up to its hit. A shape left that was never entered counts as
// entered before.
MediumStack media_before(const Scene& scene, const BasicRay<double>& ray, const std::optional<ExactHit>& hit,
                         MediumStack inside) {
  if (hit && hit->hit.normal.dot(ray.direction) > 0 && !inside.entry_of(scene, hit->shape))
    inside.cross(scene, hit->shape, true);
  return inside;
}

// The fraction of a ray's power that the innermost medium transmits, by Beer's law.
double transmittance(const Scene& scene, const MediumStack& inside, const BasicRay<double>& ray,
                     double distance, double wavelength_nm) {
  if (inside.empty()) return 1;
  const Material& material = material_of(scene, inside.innermost());
  const RefractiveIndex* index = interior(material);
  double extinction_per_m = index != nullptr ? index->absorption_per_m(wavelength_nm) : 0;
  const Medium* filling = medium(material);
  if (filling != nullptr)
    extinction_per_m += filling->absorption_per_m(wavelength_nm) + filling->scattering_per_m(wavelength_nm);
  if (!(extinction_per_m > 0)) return 1;
  if (filling != nullptr && filling->grid)
    distance = march_grid(*filling->grid, scene.shapes[inside.innermost()].shape, ray,
                          static_cast<float>(distance), std::numeric_limits<float>::infinity())
                   .column;
  return std::exp(-extinction_per_m * distance);
}

// A ray on its way.
struct Traveller {
  BasicRay<double> ray;
  MediumStack inside;
  double nearest;  // at which it may meet something
  PolarisedWay way;
  double share = 1;  // of the power
  int events = 0;    // so far
  std::size_t from = 0, event = 0;
};

class Follower {
 public:
  Follower(const Scene& scene, double wavelength_nm, Follow follow, const FollowLimits& limits,
           const StokesVector& light)
      : scene_(scene),
        wavelength_nm_(wavelength_nm),
        light_(light),
        follow_(follow),
        limits_(limits),
        size_(scene.bounds.isEmpty() ? 0 : scene.bounds.size().length()) {}

  RayTree operator()(const BasicRay<double>& ray) {
    wait({ray, enclosing(scene_, Imath::V3f(ray.origin)), 0, PolarisedWay(ray.direction)});
    while (!waiting_.empty()) {
      const Traveller next = waiting_.begin()->second;
      waiting_.erase(waiting_.begin());
      if (tree_.branches.size() < limits_.most_branches)
        follow_branch(next);
      else
        cut(next);
    }
    return std::move(tree_);
  }

 private:
  void wait(const Traveller& traveller) { waiting_.emplace(traveller.share, traveller); }

  void cut(const Traveller& traveller) {
    ++tree_.cut;
    tree_.cut_share += traveller.share;
  }

  void follow_branch(Traveller now) {
    const bool main = tree_.branches.empty();
    tree_.branches.push_back({{{}, now.ray, false, now.way}, now.ray, now.share, now.from, now.event});
    bool goes_on = true;
    while (goes_on && now.events < limits_.max_events && (main || now.share >= limits_.least_share))
      goes_on = step(now);
    RayTrace& trace = tree_.branches.back().trace;
    trace.last = now.ray;
    trace.way = now.way;
    trace.cut_short = goes_on && now.events == limits_.max_events;
    if (goes_on) cut(now);
  }

  // To what the ray meets next, and past it. Whether it goes on.
  bool step(Traveller& now) {
    std::vector<TraceEvent>& events = tree_.branches.back().trace.events;
    const std::optional<ExactHit> hit = intersect_exact(scene_, now.ray, now.nearest);
    const double left =
        transmittance(scene_, media_before(scene_, now.ray, hit, now.inside), now.ray,
                      hit ? hit->hit.t : std::numeric_limits<double>::infinity(), wavelength_nm_);
    now.share *= left;
    now.way.mueller *= left;
    if (!hit) {
      events.push_back({.kind = Kind::escape, .at = {}, .share = now.share});
      return false;
    }
    const Meeting met = meet(scene_, now.ray, *hit, now.nearest, now.inside);
    now.ray.origin = met.acting.hit.point;
    if (!met.boundary.acting) {
      send(now, met, now.ray.direction, true);
      return true;
    }
    ++now.events;
    const double outside = met.boundary.outside != nullptr ? met.boundary.outside->n(wavelength_nm_) : 1;
    const Turn turn = turn_at(scene_, met.acting, -now.ray.direction, wavelength_nm_, outside);
    const RayWay* way = way_of(turn);
    TraceEvent event{.kind = Kind::hit,
                     .at = met.acting.hit,
                     .shape = met.acting.shape,
                     .passage = {},
                     .share = now.share,
                     .R = turn.reflected ? share_of(now, turn, *turn.reflected) : 0,
                     .T = turn.through ? share_of(now, turn, *turn.through) : 0};
    if (way != nullptr) {
      event.kind = way->kind;
      event.passage = turn.passage;
      event.passage->angle_out_deg = way->angle_deg;
    }
    const Traveller before = now;
    const bool through = turn.through && way == &*turn.through;
    if (way != nullptr) {
      take(now, turn, *way);
      send(now, met, way->direction, through);
      event.polarisation = EventPolarisation{turn.axis, way->mueller, now.way.mueller * light_};
    }
    events.push_back(event);
    if (follow_ == Follow::both) part(before, met, turn, way);
    return way != nullptr;
  }

  // The way of the branch itself, nullptr where it ends.
  [[nodiscard]] const RayWay* way_of(const Turn& turn) const {
    const RayWay* reflected = turn.reflected ? &*turn.reflected : nullptr;
    const RayWay* through = turn.through ? &*turn.through : nullptr;
    if (follow_ == Follow::reflection) return reflected != nullptr ? reflected : through;
    if (turn.ends) return nullptr;
    return through != nullptr ? through : reflected;
  }

  // The light of a ray by a way on, its direction being still that before.
  void take(Traveller& now, const Turn& turn, const RayWay& way) const {
    now.way.turn_to(turn.axis, now.ray.direction);
    now.way.mueller = way.mueller * now.way.mueller;
    now.share = (now.way.mueller * light_)[0];
  }

  // Of the light that arrives, what a way on takes.
  [[nodiscard]] double share_of(const Traveller& now, const Turn& turn, const RayWay& way) const {
    Traveller after = now;
    take(after, turn, way);
    return now.share > 0 ? after.share / now.share : 0;
  }

  // The ways on that the branch does not take itself.
  void part(const Traveller& now, const Meeting& met, const Turn& turn, const RayWay* taken) {
    for (const bool through : {false, true}) {
      const std::optional<RayWay>& way = through ? turn.through : turn.reflected;
      if (!way || taken == &*way) continue;
      Traveller other = now;
      take(other, turn, *way);
      other.from = tree_.branches.size() - 1;
      other.event = tree_.branches.back().trace.events.size() - 1;
      send(other, met, way->direction, through);
      if (other.share >= limits_.least_share)
        wait(other);
      else
        cut(other);
    }
  }

  void send(Traveller& now, const Meeting& met, const Imath::V3d& direction, bool through) const {
    now.ray.direction = direction;
    if (through) now.inside = met.boundary.beyond;
    now.nearest = kSelf * (size_ + now.ray.origin.length()) +
                  met.spread / std::abs(met.acting.hit.normal.dot(direction));
  }

  const Scene& scene_;
  double wavelength_nm_;
  StokesVector light_;  // of I = 1
  Follow follow_;
  const FollowLimits& limits_;
  double size_;
  RayTree tree_;
  std::multimap<double, Traveller, std::greater<>> waiting_;  // of equal shares the earlier one first
};

}  // namespace

double angle_deg(const Imath::V3d& a, const Imath::V3d& b) {
  const Imath::V3d u = a.normalized();
  const Imath::V3d v = b.normalized();
  return 2 * std::atan2((u - v).length(), (u + v).length()) * 180 / std::numbers::pi;
}

RayTree follow_ray(const Scene& scene, const BasicRay<double>& ray, double wavelength_nm, Follow follow,
                   const FollowLimits& limits, const StokesVector& light) {
  return Follower(scene, wavelength_nm, follow, limits, light)(ray);
}

RayTrace trace_ray(const Scene& scene, const BasicRay<double>& ray, double wavelength_nm, int max_events) {
  return follow_ray(scene, ray, wavelength_nm, Follow::refraction, {.max_events = max_events})
      .branches.front()
      .trace;
}

}  // namespace abbe
