#include "transport/path/free_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/working_range.h"

namespace abbe {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool is_medium_boundary(const Scene& scene, const SurfaceHit& hit) {
  return is_boundary(scene.materials[scene.shapes[hit.shape].material]);
}

// Rescales the lane pdfs by their maximum so that they neither overflow nor underflow. Quantities in the same
// unit are rescaled with them.
void rescale(PathState& path) {
  PathPacket& packet = path.packet;
  const float max_pdf = packet.lane_pdf.max();
  if (!(max_pdf > 0)) return;
  advance(packet, SampledSpectrum(1 / max_pdf), SampledSpectrum(1 / max_pdf));
  path.nee_path_pdf *= 1 / max_pdf;
  path.segment.path_pdf *= 1 / max_pdf;
}

// e^(-s_k x) in units of the largest lane's value, and the reciprocal of that unit.
struct Passed {
  SampledSpectrum lanes{1.0F};
  float unit = 1;
};
Passed pass(const MediumAt& medium, float distance) {
  const float min_extinction = medium.extinction_per_m.min();
  return {transmittance(medium.extinction_per_m - SampledSpectrum(min_extinction), distance),
          min_extinction > 0 ? std::exp(min_extinction * distance) : 1};
}

// Crosses all coincident medium boundaries at a hit and returns the rest of the ray. The hit's radius grows
// to enclose all of them.
Ray pass_boundaries(const Scene& scene, MediumState& media, const SampledSpectrum& wavelengths_nm,
                    const Ray& ray, SurfaceHit& hit) {
  const CoincidentHits surfaces = scene.coincident(ray, hit);
  MediumStack stack = media.stack;
  for (const bool entering : {false, true})
    for (const SurfaceHit& one : surfaces.all())
      if ((one.normal.dot(ray.direction) < 0) == entering) stack.cross(scene, one.shape, entering);
  media.enter(scene, stack, wavelengths_nm);
  for (const SurfaceHit& one : surfaces.all())
    hit.coincidence_radius =
        std::max(hit.coincidence_radius, std::abs((one.point - hit.point).dot(hit.normal)));
  return spawn(hit, ray.direction, ray.time);
}

// First of the surfaces coincident with a hit that is more than a medium boundary; light interacts with it in
// the medium before the boundary.
std::optional<SurfaceHit> surface_at(const Scene& scene, const Ray& ray, const SurfaceHit& hit) {
  if (!is_medium_boundary(scene, hit)) return hit;
  const CoincidentHits surfaces = scene.coincident(ray, hit);
  for (const SurfaceHit& one : surfaces.all())
    if (!is_medium_boundary(scene, one)) return one;
  return std::nullopt;
}

// Point at `distance` along a ray whose medium ends at `end`. If rounding would return the ray's origin,
// returns a point one float step away.
Imath::V3f other_point_along(const Ray& ray, float distance, float end, const Imath::V3f& end_normal) {
  const Imath::V3f point = point_along(ray, distance, end, end_normal);
  if (point != ray.origin) return point;
  const auto step = static_cast<float>(2 * float_step(largest_coordinate(Imath::V3d(point))));
  return ray.origin + ray.direction * std::min(step, end / 2);
}

// Advances the path through its medium along `ray`, until the medium ends or the hero's optical `depth` is
// used up. Returns true if the path scatters in the medium. Otherwise `depth` is reduced by the depth passed.
// Throughput and pdfs advance by the factors of `pass`, which omit a common factor. Pdfs that were stored
// earlier are multiplied by its reciprocal, so that all have one unit. Only homogeneous media have a segment.
bool scatters_in_medium(PathState& path, const Ray& ray, const std::optional<SurfaceHit>& hit, float& depth,
                        const SegmentVisitor& visitor) {
  const MediumAt& medium = path.media.medium;
  const float distance = hit ? hit->t : kInfinity;
  if (medium.scattering == nullptr) {
    medium.attenuate(path.packet.throughput, medium.march(ray, distance, kInfinity).column);
    return false;
  }
  const Imath::V3f end_normal = hit ? hit->normal : Imath::V3f(0);
  path.segment = {ray, medium.grid == nullptr ? distance : 0, path.packet.lane_pdf.sum(), end_normal};
  if (visitor && path.segment.length > 0) visitor(path.segment);
  const float extinction = medium.extinction_per_m[path.packet.hero];
  const GridSegment march = medium.march(ray, distance, extinction > 0 ? depth / extinction : kInfinity);
  const Passed passed = pass(medium, march.column);
  if (march.reached) {
    advance(path.packet, passed.lanes * medium.scattering_per_m, passed.lanes * medium.extinction_per_m);
    path.segment.path_pdf *= passed.unit;
    rescale(path);
    path.ray.origin = other_point_along(ray, march.distance, distance, end_normal);
    return true;
  }
  advance(path.packet, passed.lanes, passed.lanes);
  path.nee_path_pdf *= passed.unit;
  rescale(path);
  depth -= extinction > 0 ? extinction * march.column : 0;
  return false;
}

struct Interval {
  double from, to;
};

// Interval of t in which the points m + t d lie within a cone around `axis` with its apex at the origin.
// `sin2` is the squared sine of its half angle, which is below 90 degrees: |x_perp|^2 cos^2 <= x_par^2 sin^2
// with x_par > 0.
std::optional<Interval> within_cone(const Imath::V3d& m, const Imath::V3d& d, const Imath::V3d& axis,
                                    double sin2) {
  const double cos2 = 1 - sin2;
  const double m_along = m.dot(axis);
  const double d_along = d.dot(axis);
  const Imath::V3d m_off = m - axis * m_along;
  const Imath::V3d d_off = d - axis * d_along;
  const double a = d_off.length2() * cos2 - d_along * d_along * sin2;
  const double b = m_off.dot(d_off) * cos2 - m_along * d_along * sin2;
  const double c = m_off.length2() * cos2 - m_along * m_along * sin2;
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0) || a == 0) return std::nullopt;
  // The first root adds terms of equal sign; the other follows from the product of both roots.
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const auto [first, second] = std::minmax({q / a, c / q});
  if (a > 0) {
    // within the mirror image of the cone
    if (!(m_along + (first + second) / 2 * d_along > 0)) return std::nullopt;
    return Interval{first, second};
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return d_along > 0 ? Interval{second, kInfinity} : Interval{-kInfinity, first};
}

}  // namespace

Imath::V3f point_along(const Ray& ray, float distance, float end, const Imath::V3f& end_normal) {
  const Imath::V3d direction(ray.direction);
  const Imath::V3d normal(end_normal);
  Imath::V3d point = Imath::V3d(ray.origin) + direction * static_cast<double>(distance);
  const double min_offset = static_cast<double>(offset_length(Imath::V3f(point)));
  if (const double towards = normal.dot(direction); towards != 0) {
    const double off = (static_cast<double>(end) - static_cast<double>(distance)) * std::abs(towards);
    if (off < min_offset) point -= normal * std::copysign(min_offset - off, towards);
  }
  return rounded_back(point, direction);
}

SegmentEnd propagate(const Scene& scene, RayCaster& caster, const Imath::V2f& u, PathState& path,
                     std::optional<SurfaceHit>& hit, const SegmentVisitor& visitor) {
  // A double has enough digits for both numbers, and for their difference from 1.
  constexpr double kDigits = 0x1p-24;
  const double drawn = static_cast<double>(u.x) + (static_cast<double>(u.y) + kDigits / 2) * kDigits;
  auto depth = static_cast<float>(-std::log(1 - drawn));
  Ray ray = path.ray;
  float passed_distance = 0;  // distance to the origin of `ray` [m]
  while (true) {
    if (scatters_in_medium(path, ray, hit, depth, visitor)) return SegmentEnd::medium;
    if (!hit) return SegmentEnd::escape;
    if (const std::optional<SurfaceHit> surface = surface_at(scene, ray, *hit)) {
      hit = surface;
      hit->t += passed_distance;
      return SegmentEnd::surface;
    }
    passed_distance += hit->t;
    ray = pass_boundaries(scene, path.media, path.packet.wavelengths.lambda_nm, ray, *hit);
    if (scene.transmission_may_leak(*hit, ray.direction, ray.time)) return SegmentEnd::hidden;
    hit = caster.intersect(ray);
  }
}

Transmission transmission(const Scene& scene, RayCaster& caster, Ray ray, MediumState media,
                          const SampledSpectrum& wavelengths_nm, float distance) {
  Transmission through;
  while (true) {
    std::optional<SurfaceHit> hit;
    if (scene.features.boundaries) hit = caster.intersect(ray);
    const bool ends = !hit || !(hit->t < distance);
    SampledSpectrum passed(1.0F);
    media.medium.attenuate(passed, media.medium.march(ray, ends ? distance : hit->t, kInfinity).column);
    through.transmittance *= passed;
    if (media.medium.scattering != nullptr) through.pdf *= passed;
    // The segment is unoccluded, so a surface that is no boundary is its end, up to rounding.
    if (ends || !is_medium_boundary(scene, *hit)) return through;
    distance -= hit->t;
    ray = pass_boundaries(scene, media, wavelengths_nm, ray, *hit);
  }
}

std::optional<Transmission> unblocked_transmission(const Scene& scene, RayCaster& caster,
                                                   const BasicRay<double>& shadow_ray, const Ray& ray,
                                                   const MediumState& media,
                                                   const SampledSpectrum& wavelengths_nm, float distance) {
  if (caster.occluded(shadow_ray)) return std::nullopt;
  return transmission(scene, caster, ray, media, wavelengths_nm, distance);
}

Equiangular::Equiangular(double from, double to, double foot, double height)
    : from_(static_cast<float>(from)),
      to_(static_cast<float>(to)),
      foot_(foot),
      height_(height),
      low_(std::atan2(from - foot, height)),
      high_(std::atan2(to - foot, height)) {}

std::optional<Equiangular> Equiangular::along(const Ray& ray, float length, const Light& light) {
  const std::optional<Imath::V3f> position = position_at(light, ray.time);
  if (!position) return std::nullopt;
  const Imath::V3d m = Imath::V3d(ray.origin) - Imath::V3d(*position);
  const Imath::V3d d(ray.direction);
  Interval part{0, length};
  if (const std::optional<DirectionCone> cone = cone_at(light, ray.time); cone && cone->cap < 1) {
    const double cap = cone->cap;
    const auto inside = within_cone(m, d, Imath::V3d(cone->axis), cap * (2 - cap));
    if (!inside) return std::nullopt;
    part = {std::max(part.from, inside->from), std::min(part.to, inside->to)};
  }
  if (!(part.from < part.to)) return std::nullopt;
  const double foot = -m.dot(d);
  // A ray through the light itself would have its entire density at one point.
  constexpr double kMinRelativeHeight = 1e-6;
  const double height = std::max((m + d * foot).length(), kMinRelativeHeight * m.length());
  if (!(height > 0)) return std::nullopt;
  return Equiangular(part.from, part.to, foot, height);
}

float Equiangular::sample(float u) const {
  const double t = foot_ + height_ * std::tan(low_ + (high_ - low_) * static_cast<double>(u));
  return std::clamp(static_cast<float>(t), from_, to_);
}

float Equiangular::pdf(float distance) const {
  if (!(distance >= from_ && distance <= to_)) return 0;
  const double from_foot = static_cast<double>(distance) - foot_;
  return static_cast<float>(height_ / ((high_ - low_) * (height_ * height_ + from_foot * from_foot)));
}

}  // namespace abbe
