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

#include "materials/interface/mueller.h"
#include "materials/interface/snell.h"
#include "materials/material.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"
#include "transport/path/media.h"
#include "transport/path/vertex.h"

namespace abbe {
namespace {

using Kind = TraceEvent::Kind;

// A hit closer than this fraction of the distances involved is the surface from which the ray starts.
constexpr double kSelfIntersection = 1e-11;

// Surface coordinates at a point; nothing on meshes, because a hit does not identify their triangle.
std::optional<SurfaceCoordinates> coordinates_at(const Shape& shape, const Imath::V3d& point) {
  if (plain<Mesh>(shape) != nullptr) return std::nullopt;
  return coordinates(shape, point, 0, 0);
}

// Axis of the event's frame, perpendicular to the ray before and after.
Imath::V3d axis_of(const SmoothMueller& mueller, const Imath::V3d& wo, const Imath::V3d& normal,
                   const std::optional<SurfaceCoordinates>& coordinates) {
  if (!mueller.axis) return across(wo, normal);
  const Basis<double> axes(normal, coordinates->dp_du);
  return axes.to_world(projected_axis(*mueller.axis, axes.to_local(wo)));
}

// Sets the indices of refraction of both sides.
void set_other_side(const Material& material, double wavelength_nm, bool entering, double outside,
                    Passage& passage) {
  if (const RefractiveIndex* glass = interior_index(material)) {
    const double inside = glass->n(wavelength_nm);
    passage.n_from = entering ? outside : inside;
    passage.n_to = entering ? inside : outside;
  } else if (const auto* metal = std::get_if<ConductorMaterial>(&material.model)) {
    passage.n_to = metal->index.n(wavelength_nm);
    passage.k_to = metal->index.k(wavelength_nm);
  } else if (!opaque(material)) {
    passage.n_to = outside;
  }
}

// Ray that leaves a smooth surface.
struct OutgoingRay {
  TraceEvent::Kind kind;  // refract, reflect or total_reflection
  Imath::V3d direction;   // Unit vector.
  double angle_deg;       // Angle with the normal on the side of the ray, in [0, 90].
  // Mueller matrix of the event, including the power of unpolarised light, with `SmoothScattering::axis` as
  // axis.
  FullMueller mueller;
};

// Light that a surface sends in single directions. `OutgoingRay::mueller` has the fractions of its power.
struct SmoothScattering {
  // Specular reflection, and refraction or straight transmission; empty if it carries no power.
  std::optional<OutgoingRay> reflected, through;
  Imath::V3d axis = {};  // First axis of the event's frames, perpendicular to the ray before and after.
  Passage passage = {};  // Complete except for `angle_out_deg`, which depends on the ray that is followed.
  // True if the surface also scatters light into other directions, or if no outgoing ray is known.
  bool ends = true;
};

// Outgoing rays of a ray that arrives at `at`; the unit vector `wo` points back to where it came from.
// `outside` is the index of the medium outside the shape, relative to air. No rays leave a surface without a
// specular lobe, or a mesh whose material needs surface coordinates, because a hit does not have them.
SmoothScattering smooth_scattering_at(const Scene& scene, const ExactHit& at, const Imath::V3d& wo,
                                      double wavelength_nm, double outside) {
  const ShapeInstance& shape = scene.shapes[at.shape];
  const Material& material = scene.materials[shape.material];
  const bool entering = wo.dot(at.hit.normal) > 0;
  const Imath::V3d normal = entering ? at.hit.normal : -at.hit.normal;
  SmoothLookup lookup{wavelength_nm, normal.dot(wo), !entering, outside};
  std::optional<SurfaceCoordinates> surface_coordinates;
  if (needs_coordinates(material)) surface_coordinates = coordinates_at(shape.shape, at.hit.point);
  if (surface_coordinates) lookup.coordinates = Imath::V2f(surface_coordinates->uv);
  const auto power = smooth_power(material, lookup);
  if (!power) return {};
  const SmoothMueller mueller = *smooth_mueller(material, lookup);
  if (mueller.axis && !surface_coordinates) return {};
  SmoothScattering scattering{{},
                              {},
                              axis_of(mueller, wo, at.hit.normal, surface_coordinates),
                              {outside, 0, 0, angle_deg(wo, normal), 0, power->Rs, power->Rp},
                              lobes(material).spread};
  set_other_side(material, wavelength_nm, entering, outside, scattering.passage);
  if (power->transmitted() > 0) {
    const auto through = interior_index(material) != nullptr
                             ? refract(wo, normal, scattering.passage.n_to / scattering.passage.n_from)
                             : std::optional(-wo);
    if (through)
      scattering.through = OutgoingRay{Kind::refract, through->normalized(), angle_deg(*through, -normal),
                                       FullMueller::of(mueller.matrices.through, power->transmitted())};
  }
  if (power->R() > 0) {
    const Imath::V3d direction = reflect(wo, normal);
    const bool total = !scattering.through && !opaque(material);
    scattering.reflected =
        OutgoingRay{total ? Kind::total_reflection : Kind::reflect, direction.normalized(),
                    angle_deg(direction, normal), FullMueller::of(mueller.matrices.reflected, power->R())};
  }
  return scattering;
}

// Crossing of surfaces in a scene without nested media. Materials that depend on the index around them are in
// air. Coincident medium boundaries are crossed together, exits first.
ActingSurface cross_without_nesting(const Scene& scene, std::span<const CrossedSurface> crossed,
                                    const MediumStack& media) {
  ActingSurface surface{0, nullptr, media};
  if (!media.empty() && !depends_on_outside(material_of(scene, crossed.front().shape)))
    surface.outside = interior_index(material_of(scene, media.innermost()));
  for (const bool entering : {false, true})
    for (const CrossedSurface& one : crossed)
      if (one.entering == entering) surface.media_behind.cross(scene, one.shape, entering);
  return surface;
}

// All coincident surfaces that a ray hits, if there may be several, and the one that acts.
struct CoincidentSurfaces {
  ExactHit acting;
  ActingSurface boundary;
  double spread;  // maximum separation along the normal [m]
};

CoincidentSurfaces coincident_surfaces(const Scene& scene, const BasicRay<double>& ray, const ExactHit& first,
                                       double min_distance, const MediumStack& media) {
  const auto crossed_by = [&](const ExactHit& hit) {
    return CrossedSurface{hit.shape, hit.hit.normal.dot(ray.direction) < 0};
  };
  if (!scene.features.nesting && !scene.features.boundaries)
    return {first, cross_without_nesting(scene, std::array{crossed_by(first)}, media), 0};
  const Imath::V3d& normal = first.hit.normal;
  BasicRay<double> rest = ray;
  rest.t_max = first.hit.t + scene.coincidence_tolerance(first.hit.point, first.shape) /
                                 std::abs(normal.dot(ray.direction));
  std::vector<ExactHit> hits{first};
  double spread = 0;
  for (std::uint32_t i = 0; i < scene.shapes.size() && hits.size() < CoincidentHits::kMaxHits; ++i) {
    const auto hit = i == first.shape ? std::nullopt : intersect(scene.shapes[i].shape, rest, min_distance);
    if (!hit || std::abs(hit->normal.dot(normal)) <= CoincidentHits::kParallel) continue;
    const double separation = std::abs((hit->point - first.hit.point).dot(normal));
    if (separation > scene.coincidence_tolerance(first.hit.point, first.shape, i)) continue;
    spread = std::max(spread, separation);
    hits.push_back({*hit, i});
  }
  std::vector<CrossedSurface> crossed;
  for (const ExactHit& hit : hits) crossed.push_back(crossed_by(hit));
  ActingSurface boundary = scene.features.nesting ? acting_surface(scene, crossed, media)
                                                  : cross_without_nesting(scene, crossed, media);
  return {hits[boundary.acting.value_or(0)], boundary, spread};
}

// Media of a ray up to its hit, given the media at its start. A shape that is left without having been
// entered counts as entered before.
MediumStack media_before(const Scene& scene, const BasicRay<double>& ray, const std::optional<ExactHit>& hit,
                         MediumStack media) {
  if (hit && hit->hit.normal.dot(ray.direction) > 0 && !media.entry_of(scene, hit->shape))
    media.cross(scene, hit->shape, true);
  return media;
}

// The fraction of a ray's power that the innermost medium transmits, by Beer's law.
double transmittance(const Scene& scene, const MediumStack& media, const BasicRay<double>& ray,
                     double distance, double wavelength_nm) {
  if (media.empty()) return 1;
  const Material& material = material_of(scene, media.innermost());
  const RefractiveIndex* index = interior_index(material);
  double extinction_per_m = index != nullptr ? index->absorption_per_m(wavelength_nm) : 0;
  const Medium* interior_medium = medium(material);
  if (interior_medium != nullptr)
    extinction_per_m +=
        interior_medium->absorption_per_m(wavelength_nm) + interior_medium->scattering_per_m(wavelength_nm);
  if (!(extinction_per_m > 0)) return 1;
  if (interior_medium != nullptr && interior_medium->grid)
    distance = march_grid_along(*interior_medium->grid, scene.shapes[media.innermost()].shape, ray,
                                static_cast<float>(distance), std::numeric_limits<float>::infinity())
                   .column;
  return std::exp(-extinction_per_m * distance);
}

// A ray that is followed.
struct RayState {
  BasicRay<double> ray;
  MediumStack media;
  double min_distance;
  RayPolarisation polarisation;
  double power_fraction = 1;
  int events = 0;
  std::size_t from = 0, event = 0;
};

class RayFollower {
 public:
  RayFollower(const Scene& scene, double wavelength_nm, Follow follow, const FollowLimits& limits,
              const StokesVector& light)
      : scene_(scene),
        wavelength_nm_(wavelength_nm),
        light_(light),
        follow_(follow),
        limits_(limits),
        size_(scene.bounds.isEmpty() ? 0 : scene.bounds.size().length()) {}

  RayTree operator()(const BasicRay<double>& ray) {
    enqueue({ray, enclosing_media(scene_, Imath::V3f(ray.origin)), 0, RayPolarisation(ray.direction)});
    while (!queue_.empty()) {
      const RayState next = queue_.begin()->second;
      queue_.erase(queue_.begin());
      if (tree_.branches.size() < limits_.max_branches)
        follow_branch(next);
      else
        truncate(next);
    }
    return std::move(tree_);
  }

 private:
  void enqueue(const RayState& state) { queue_.emplace(state.power_fraction, state); }

  void truncate(const RayState& state) {
    ++tree_.truncated;
    tree_.truncated_power += state.power_fraction;
  }

  void follow_branch(RayState now) {
    const bool main = tree_.branches.empty();
    tree_.branches.push_back(
        {{{}, now.ray, false, now.polarisation}, now.ray, now.power_fraction, now.from, now.event});
    bool active = true;
    while (active && now.events < limits_.max_events &&
           (main || now.power_fraction >= limits_.min_power_fraction))
      active = step(now);
    RayTrace& trace = tree_.branches.back().trace;
    trace.last = now.ray;
    trace.polarisation = now.polarisation;
    trace.truncated = active && now.events == limits_.max_events;
    if (active) truncate(now);
  }

  // Traces a ray to its next surface and applies it. Returns true if the ray continues.
  bool step(RayState& now) {
    std::vector<TraceEvent>& events = tree_.branches.back().trace.events;
    const std::optional<ExactHit> hit = intersect_exact(scene_, now.ray, now.min_distance);
    const double transmitted =
        transmittance(scene_, media_before(scene_, now.ray, hit, now.media), now.ray,
                      hit ? hit->hit.t : std::numeric_limits<double>::infinity(), wavelength_nm_);
    now.power_fraction *= transmitted;
    now.polarisation.mueller *= transmitted;
    if (!hit) {
      events.push_back({.kind = Kind::escape, .at = {}, .power_fraction = now.power_fraction});
      return false;
    }
    const CoincidentSurfaces surfaces =
        coincident_surfaces(scene_, now.ray, *hit, now.min_distance, now.media);
    now.ray.origin = surfaces.acting.hit.point;
    if (!surfaces.boundary.acting) {
      send(now, surfaces, now.ray.direction, true);
      return true;
    }
    ++now.events;
    const double outside =
        surfaces.boundary.outside != nullptr ? surfaces.boundary.outside->n(wavelength_nm_) : 1;
    const SmoothScattering scattering =
        smooth_scattering_at(scene_, surfaces.acting, -now.ray.direction, wavelength_nm_, outside);
    const OutgoingRay* outgoing = outgoing_of(scattering);
    TraceEvent event{.kind = Kind::hit,
                     .at = surfaces.acting.hit,
                     .shape = surfaces.acting.shape,
                     .passage = {},
                     .power_fraction = now.power_fraction,
                     .R = scattering.reflected ? fraction_taken(now, scattering, *scattering.reflected) : 0,
                     .T = scattering.through ? fraction_taken(now, scattering, *scattering.through) : 0};
    if (outgoing != nullptr) {
      event.kind = outgoing->kind;
      event.passage = scattering.passage;
      event.passage->angle_out_deg = outgoing->angle_deg;
    }
    const RayState before = now;
    const bool through = scattering.through && outgoing == &*scattering.through;
    if (outgoing != nullptr) {
      take(now, scattering, *outgoing);
      send(now, surfaces, outgoing->direction, through);
      event.polarisation =
          EventPolarisation{scattering.axis, outgoing->mueller, now.polarisation.mueller * light_};
    }
    events.push_back(event);
    if (follow_ == Follow::both) queue_branches(before, surfaces, scattering, outgoing);
    return outgoing != nullptr;
  }

  // Outgoing ray that the current branch follows; nullptr if the branch ends.
  [[nodiscard]] const OutgoingRay* outgoing_of(const SmoothScattering& scattering) const {
    const OutgoingRay* reflected = scattering.reflected ? &*scattering.reflected : nullptr;
    const OutgoingRay* through = scattering.through ? &*scattering.through : nullptr;
    if (follow_ == Follow::reflection) return reflected != nullptr ? reflected : through;
    if (scattering.ends) return nullptr;
    return through != nullptr ? through : reflected;
  }

  // Applies an outgoing ray to the light. The ray must still have its incident direction.
  void take(RayState& now, const SmoothScattering& scattering, const OutgoingRay& outgoing) const {
    now.polarisation.turn_to(scattering.axis, now.ray.direction);
    now.polarisation.mueller = outgoing.mueller * now.polarisation.mueller;
    now.power_fraction = (now.polarisation.mueller * light_)[0];
  }

  // Fraction of the incident power that an outgoing ray takes.
  [[nodiscard]] double fraction_taken(const RayState& now, const SmoothScattering& scattering,
                                      const OutgoingRay& outgoing) const {
    RayState after = now;
    take(after, scattering, outgoing);
    return now.power_fraction > 0 ? after.power_fraction / now.power_fraction : 0;
  }

  // Queues the outgoing rays that the current branch does not follow.
  void queue_branches(const RayState& now, const CoincidentSurfaces& surfaces,
                      const SmoothScattering& scattering, const OutgoingRay* taken) {
    for (const bool through : {false, true}) {
      const std::optional<OutgoingRay>& outgoing = through ? scattering.through : scattering.reflected;
      if (!outgoing || taken == &*outgoing) continue;
      RayState other = now;
      take(other, scattering, *outgoing);
      other.from = tree_.branches.size() - 1;
      other.event = tree_.branches.back().trace.events.size() - 1;
      send(other, surfaces, outgoing->direction, through);
      if (other.power_fraction >= limits_.min_power_fraction)
        enqueue(other);
      else
        truncate(other);
    }
  }

  void send(RayState& now, const CoincidentSurfaces& surfaces, const Imath::V3d& direction,
            bool through) const {
    now.ray.direction = direction;
    if (through) now.media = surfaces.boundary.media_behind;
    now.min_distance = kSelfIntersection * (size_ + now.ray.origin.length()) +
                       surfaces.spread / std::abs(surfaces.acting.hit.normal.dot(direction));
  }

  const Scene& scene_;
  double wavelength_nm_;
  StokesVector light_;  // I = 1
  Follow follow_;
  const FollowLimits& limits_;
  double size_;
  RayTree tree_;
  // by falling power, equal ones in order of insertion
  std::multimap<double, RayState, std::greater<>> queue_;
};

using Kind = TraceEvent::Kind;

}  // namespace

FullMueller FullMueller::identity() {
  return of({}, 1);
}

FullMueller FullMueller::of(const MuellerElements<double>& m, double power) {
  FullMueller full{{{{1, m.d, 0, 0}, {m.d, m.p, 0, 0}, {0, 0, m.c, 0 - m.s}, {0, 0, m.s, m.c}}}};
  return full *= power;
}

StokesVector FullMueller::operator*(const StokesVector& light) const {
  StokesVector after{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) after[i] += rows[i][j] * light[j];
  return after;
}

FullMueller FullMueller::operator*(const FullMueller& before) const {
  FullMueller both{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) both.rows[i][j] += rows[i][k] * before.rows[k][j];
  return both;
}

FullMueller& FullMueller::operator*=(double power) {
  for (StokesVector& row : rows)
    for (double& element : row) element *= power;
  return *this;
}

// Rotation by the right-handed angle between both axes about the direction. [Born1999, sec. 10.9]
void RayPolarisation::turn_to(const Imath::V3d& axis, const Imath::V3d& direction) {
  const double cosine = last_axis.dot(axis);
  const double sine = direction.dot(last_axis.cross(axis));
  const double scale = 1 / (cosine * cosine + sine * sine);
  const double cos_twice = (cosine - sine) * (cosine + sine) * scale;
  const double sin_twice = 2 * sine * cosine * scale;
  const FullMueller turn{
      {{{1, 0, 0, 0}, {0, cos_twice, sin_twice, 0}, {0, -sin_twice, cos_twice, 0}, {0, 0, 0, 1}}}};
  mueller = turn * mueller;
  last_axis = axis;
}

double angle_deg(const Imath::V3d& a, const Imath::V3d& b) {
  const Imath::V3d u = a.normalized();
  const Imath::V3d v = b.normalized();
  return 2 * std::atan2((u - v).length(), (u + v).length()) * 180 / std::numbers::pi;
}

RayTree follow_ray(const Scene& scene, const BasicRay<double>& ray, double wavelength_nm, Follow follow,
                   const FollowLimits& limits, const StokesVector& light) {
  return RayFollower(scene, wavelength_nm, follow, limits, light)(ray);
}

RayTrace trace_ray(const Scene& scene, const BasicRay<double>& ray, double wavelength_nm, int max_events) {
  return follow_ray(scene, ray, wavelength_nm, Follow::refraction, {.max_events = max_events})
      .branches.front()
      .trace;
}

}  // namespace abbe
