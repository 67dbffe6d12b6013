#include "lens/trace.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "materials/interface/fresnel.h"
#include "materials/interface/snell.h"

namespace abbe::lens {
namespace {

using Imath::Vec3;

template <typename Real>
BasicRay<Real> to_local(const SystemAt::Frame& frame, const BasicRay<Real>& ray) {
  const Vec3<Real> from = ray.origin - Vec3<Real>(frame.vertex);
  if (!frame.tilted) return {from, ray.direction};
  return {from * frame.to_local, ray.direction * frame.to_local};
}

template <typename Real>
void to_world(const SystemAt::Frame& frame, BasicRayHit<Real>& hit) {
  if (frame.tilted) {
    hit.point = hit.point * frame.to_world;
    hit.normal = hit.normal * frame.to_world;
    hit.direction = hit.direction * frame.to_world;
  }
  hit.point += Vec3<Real>(frame.vertex);
  // The length is 1 except for rounding; one Newton step prevents errors from accumulating over the surfaces.
  hit.direction *= Real(1.5) - 0.5 * hit.direction.dot(hit.direction);
}

template <typename Real>
Mask<Real> within_aperture(const Surface& surface, const Vec3<Real>& point) {
  if (!surface.semi_aperture_mm) return true;
  const double radius = *surface.semi_aperture_mm;
  const Mask<Real> round = point.x * point.x + point.y * point.y <= Real(radius * radius);
  if (!surface.iris) return round;
  const Real between_blades = by_lane<Real>([&](int j) {
    return surface.iris->contains(Imath::V2d(lane_of(point.x, j), lane_of(point.y, j)) / radius) ? 1.0 : 0.0;
  });
  return round && between_blades > 0;
}

// Intersects a ray that travels towards +z with a surface, in the coordinates of the surface.
template <typename Real>
Crossing<Real> intersect_local(const Surface& surface, const BasicRay<Real>& ray) {
  const auto [intersects, length_mm] = surface.profile.find_intersection(ray);
  Crossing<Real> crossing{
      {ray.origin + ray.direction * length_mm, {}, {}, length_mm}, intersects, true, true};
  crossing.within = within_aperture(surface, crossing.hit.point);
  crossing.hit.normal = surface.profile.normal(crossing.hit.point);
  return crossing;
}

// Refracts light at the intersection of a ray that travels towards +z. The light travels along the ray
// (`sense` 1) or against it (`sense` -1), and so does the direction in the hit. `eta` is n_t/n_i of the
// light.
template <typename Real>
Crossing<Real> cross_local(const Surface& surface, const BasicRay<Real>& ray, double sense, const Real& eta) {
  auto crossing = intersect_local(surface, ray);
  BasicRayHit<Real>& hit = crossing.hit;
  crossing.refracted = refraction_radicand(Real(hit.normal.dot(ray.direction)), eta) > 0;
  const auto onwards = refract<Real>(-ray.direction * sense, -hit.normal * sense, eta);
  hit.direction = onwards.value_or(ray.direction);
  return crossing;
}

template <typename Real>
Crossing<Real> reflect_local(const Surface& surface, const BasicRay<Real>& ray, double sense) {
  auto crossing = intersect_local(surface, ray);
  BasicRayHit<Real>& hit = crossing.hit;
  hit.direction = (ray.direction - hit.normal * Real(2 * ray.direction.dot(hit.normal))) * sense;
  return crossing;
}

// Amplitudes of unit fields along s and p after a surface.
template <typename Real>
struct Amplitudes {
  Real s, p;
};

template <typename Real>
Amplitudes<Real> transmitted(const FresnelPower<Real>& power) {
  using std::sqrt;
  return {sqrt(power.Ts), sqrt(power.Tp)};
}

// The ratio of the reflected p amplitude to that of s is negative below Brewster's angle, where the refracted
// and the reflected ray form an obtuse angle.
template <typename Real>
Amplitudes<Real> reflected(const FresnelPower<Real>& power, const Real& cos_i, const Real& eta) {
  using abbe::refracted_cosine;
  using std::sqrt;
  const Real cos_t = refracted_cosine(cos_i, eta);
  const Real p = sqrt(power.Rp);
  return {sqrt(power.Rs), select(cos_i * cos_i + cos_t * cos_t < 1, p, -p)};
}

using V3d = Imath::V3d;

RayEnd end_at(const Crossing<double>& crossing, Apertures apertures) {
  if (!crossing.intersects) return RayEnd::missed;
  if (apertures == Apertures::obeyed && !crossing.within) return RayEnd::stopped;
  return crossing.refracted ? RayEnd::image : RayEnd::total_reflection;
}

SurfaceBetween<double> surface_between(const SystemAt& at, std::size_t i) {
  return {at.surface(i), at.frames[i], at.n[i], at.n[i + 1]};
}

}  // namespace

// Flattened: the callees are mostly a few instructions, whose values would otherwise pass through memory.
template <typename Real>
[[gnu::flatten]] Crossing<Real> cross(const SurfaceBetween<Real>& at, const BasicRay<Real>& ray) {
  auto crossing = cross_local<Real>(at.surface, to_local(at.frame, ray), 1, at.n_behind / at.n_before);
  to_world(at.frame, crossing.hit);
  return crossing;
}

template <typename Real>
[[gnu::flatten]] Crossing<Real> cross_back(const SurfaceBetween<Real>& at, const BasicRay<Real>& ray) {
  const BasicRay<Real> reversed = to_local<Real>(at.frame, {ray.origin, -ray.direction});
  auto crossing = cross_local<Real>(at.surface, reversed, -1, at.n_before / at.n_behind);
  to_world(at.frame, crossing.hit);
  return crossing;
}

template <typename Real>
[[gnu::flatten]] Crossing<Real> reflect(const SurfaceBetween<Real>& at, const BasicRay<Real>& ray,
                                        bool forwards) {
  const double sense = forwards ? 1 : -1;
  auto crossing =
      reflect_local<Real>(at.surface, to_local<Real>(at.frame, {ray.origin, ray.direction * sense}), sense);
  to_world(at.frame, crossing.hit);
  return crossing;
}

// A coating is on the glass side of a surface; between two glasses it is on the one behind.
FresnelPower<double> surface_power(const SurfaceBetween<double>& at, double wavelength_nm, double cos_i,
                                   bool forwards) {
  const bool glass_before = !at.surface.behind;
  const double glass = glass_before ? at.n_before : at.n_behind;
  const double outside = glass_before ? at.n_behind : at.n_before;
  return coated_power(at.surface.coating, wavelength_nm, glass, 0, cos_i, glass_before == forwards, outside);
}

FresnelPower<Floats> surface_power(const SurfaceBetween<Floats>& at, const Floats& wavelengths_nm,
                                   const Floats& cos_i, bool forwards) {
  FresnelPower<Floats> all{};
  for (int j = 0; j < Floats::kCount; ++j) {
    const auto power = surface_power(
        {at.surface, at.frame, static_cast<double>(at.n_before[j]), static_cast<double>(at.n_behind[j])},
        static_cast<double>(wavelengths_nm[j]), static_cast<double>(cos_i[j]), forwards);
    all.Rs.set(j, static_cast<float>(power.Rs));
    all.Rp.set(j, static_cast<float>(power.Rp));
    all.Ts.set(j, static_cast<float>(power.Ts));
    all.Tp.set(j, static_cast<float>(power.Tp));
  }
  return all;
}

template <typename Real>
UnpolarisedFields<Real>::UnpolarisedFields(const Vec3<Real>& direction) {
  using std::abs;
  const Mask<Real> steep = abs(direction.x) < 0.5;
  first_ = unit(direction.cross(select<Real>(steep, {1, 0, 0}, {0, 1, 0})));
  second_ = direction.cross(first_);
}

template <typename Real>
[[gnu::flatten]] void UnpolarisedFields<Real>::apply(const SurfaceBetween<Real>& at,
                                                     const Real& wavelength_nm, const Vec3<Real>& from,
                                                     const BasicRayHit<Real>& hit, Encounter how) {
  const bool bare = at.surface.coating.layers.empty();
  const Mask<Real> differs = at.n_before < at.n_behind || at.n_before > at.n_behind;
  if (bare && !differs) {  // such as a stop
    if (how.reflects) first_ = second_ = Vec3<Real>(0);
    return;
  }
  // Rounding can move a grazing ray to the other side of the surface.
  constexpr double kGrazing = 1e-30;
  const Real cosine = how.forwards ? from.dot(hit.normal) : -from.dot(hit.normal);
  const Real cos_i = select(cosine > kGrazing, select(cosine < 1, cosine, 1), kGrazing);
  const Real eta = how.forwards ? at.n_behind / at.n_before : at.n_before / at.n_behind;
  const auto power = [&] {
    return bare ? fresnel_dielectric<Real>(cos_i, eta)
                : surface_power(at, wavelength_nm, cos_i, how.forwards);
  };
  const Amplitudes<Real> along =
      how.reflects ? reflected<Real>(power(), cos_i, eta) : transmitted<Real>(power());
  // Vectors along s and p. They are not normalised: their lengths are that of the cross product.
  const Vec3<Real> across = from.cross(hit.normal);
  const Vec3<Real> s = select<Real>(across.dot(across) > 0, across, hit.normal.cross(first_));
  const Vec3<Real> p_before = s.cross(from);
  const Real over_length2 = Real(1) / s.dot(s);
  const Vec3<Real> s_behind = s * Real(along.s * over_length2);
  const Vec3<Real> p_behind = s.cross(hit.direction) * Real(along.p * over_length2);
  const Mask<Real> acts = differs || Mask<Real>(!bare || how.reflects);
  const auto behind = [&](const Vec3<Real>& field) {
    return select<Real>(acts, s_behind * field.dot(s) + p_behind * field.dot(p_before), field);
  };
  first_ = behind(first_);
  second_ = behind(second_);
}

template Crossing<double> cross(const SurfaceBetween<double>&, const Ray&);
template Crossing<Doubles> cross(const SurfaceBetween<Doubles>&, const BasicRay<Doubles>&);
template Crossing<Floats> cross(const SurfaceBetween<Floats>&, const BasicRay<Floats>&);
template Crossing<double> cross_back(const SurfaceBetween<double>&, const Ray&);
template Crossing<Doubles> cross_back(const SurfaceBetween<Doubles>&, const BasicRay<Doubles>&);
template Crossing<Floats> cross_back(const SurfaceBetween<Floats>&, const BasicRay<Floats>&);
template Crossing<double> reflect(const SurfaceBetween<double>&, const Ray&, bool);
template Crossing<Doubles> reflect(const SurfaceBetween<Doubles>&, const BasicRay<Doubles>&, bool);
template Crossing<Floats> reflect(const SurfaceBetween<Floats>&, const BasicRay<Floats>&, bool);
template class UnpolarisedFields<double>;
template class UnpolarisedFields<Floats>;

RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures, std::size_t surfaces) {
  surfaces = std::min(surfaces, at.size());
  RayPath path;
  path.last = ray;
  path.hits.reserve(surfaces);
  for (std::size_t i = 0; i < surfaces; ++i) {
    const auto crossing = cross(surface_between(at, i), path.last);
    const RayHit& hit = crossing.hit;
    path.end = end_at(crossing, apertures);
    path.at = i;
    if (!path.reached()) return path;
    path.hits.push_back(hit);
    path.last = {hit.point, hit.direction};
  }
  path.at = surfaces;
  if (surfaces < at.size()) return path;
  if (!(path.last.direction.z > 0)) {
    path.end = RayEnd::missed;
    return path;
  }
  path.last_length_mm = (at.vertex_z.back() - path.last.origin.z) / path.last.direction.z;
  path.last.origin += path.last_length_mm * path.last.direction;
  return path;
}

V3d local_point(const SystemAt& at, std::size_t surface, const V3d& point) {
  return (point - at.frames[surface].vertex) * at.frames[surface].to_local;
}

double transmittance(const SystemAt& at, const Ray& start, const RayPath& path) {
  V3d from = start.direction;
  UnpolarisedFields<double> light(from);
  double depth = 0;
  for (std::size_t i = 0; i < path.hits.size(); ++i) {
    const RayHit& hit = path.hits[i];
    light.apply(surface_between(at, i), at.wavelength_nm, from, hit, {});
    if (i > 0) depth += at.absorption_per_mm[i] * hit.length_mm;
    from = hit.direction;
  }
  depth += at.absorption_per_mm.back() * path.last_length_mm;
  return light.power() * std::exp(-depth);
}

std::string reason(const RayPath& path) {
  switch (path.end) {
    case RayEnd::missed:
      return fmt::format("misses surface {}", path.at + 1);
    case RayEnd::total_reflection:
      return fmt::format("is totally reflected at surface {}", path.at + 1);
    case RayEnd::stopped:
      return fmt::format("is stopped by the aperture of surface {}", path.at + 1);
    case RayEnd::image:
      break;
  }
  return "reaches the image";
}

}  // namespace abbe::lens
