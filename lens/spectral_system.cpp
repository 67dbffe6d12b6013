#include "lens/spectral_system.h"

#include <algorithm>
#include <cmath>

#include "spectral/curve.h"

namespace abbe::lens {
namespace {

constexpr int kTableCells = kMaxWavelengthNm - kMinWavelengthNm;

using Imath::Vec3;
using V3d = Imath::V3d;

template <typename Real>
Crossing<Real> interact(const SurfaceBetween<Real>& at, const BasicRay<Real>& ray, Encounter how) {
  if (how.reflects) return reflect(at, ray, how.forwards);
  return how.forwards ? cross(at, ray) : cross_back(at, ray);
}

}  // namespace

MediaTable::MediaTable(const System& system) : absorbs_(system.surfaces.size() + 1) {
  values_.assign(columns() * (kTableCells + 1), 0);
  for (int i = 0; i <= kTableCells; ++i) {
    const double nm = kMinWavelengthNm + i;
    double* row = &values_[columns() * static_cast<std::size_t>(i)];
    row[0] = 1;
    for (std::size_t medium = 1; medium < absorbs_.size(); ++medium) {
      const auto& glass = system.surfaces[medium - 1].behind;
      row[medium] = glass ? glass->index.n(nm) : 1;
      if (!glass) continue;
      const double absorption_per_mm = glass->index.absorption_per_m(nm) / kMmPerM;
      row[absorbs_.size() + medium] = absorption_per_mm;
      if (absorption_per_mm != 0) absorbs_[medium] = true;
    }
  }
}

template <typename Real>
MediaTable::Coordinate<Real> MediaTable::coordinate(const Real& wavelength_nm) const {
  Coordinate<Real> coordinate;
  coordinate.fraction = by_lane<Real>([&](int j) {
    const double x = std::clamp(static_cast<double>(lane_of(wavelength_nm, j)) - kMinWavelengthNm, 0.0,
                                double{kTableCells});
    const int cell = std::min(static_cast<int>(x), kTableCells - 1);
    coordinate.row[static_cast<std::size_t>(j)] = &values_[columns() * static_cast<std::size_t>(cell)];
    return x - cell;
  });
  return coordinate;
}

template MediaTable::Coordinate<double> MediaTable::coordinate(const double&) const;
template MediaTable::Coordinate<Doubles> MediaTable::coordinate(const Doubles&) const;
template MediaTable::Coordinate<Floats> MediaTable::coordinate(const Floats&) const;

SpectralSystem::SpectralSystem(System system, double stop_radius_mm)
    : system_(std::move(system)),
      stop_radius_mm_(stop_radius_mm),
      media_(system_),
      direct_(direct_route(system_.surfaces.size())) {
  std::optional<double>& aperture = system_.surfaces[system_.stop].semi_aperture_mm;
  aperture = std::min(stop_radius_mm, aperture.value_or(stop_radius_mm));
  const SystemAt at(system_, system_.primary_nm());
  frames_ = at.frames;
  vertex_z_ = at.vertex_z;
}

// Lanes that have ended do not move any more.
template <typename Real>
BasicImageRay<Real> SpectralSystem::trace_to_image(BasicRay<Real> ray, const Real& wavelength_nm,
                                                   const Route& route) const {
  const auto coordinate = media_.coordinate(wavelength_nm);
  UnpolarisedFields<Real> light(ray.direction);
  Mask<Real> passes = true;
  Real depth = 0;
  Real n_here = 1;
  for (const auto& [i, how] : route) {
    const std::size_t medium = how.forwards ? i : i + 1;
    const Real n_next = media_.n(how.forwards ? i + 1 : i, coordinate);
    const SurfaceBetween<Real> at{system_.surfaces[i], frames_[i], how.forwards ? n_here : n_next,
                                  how.forwards ? n_next : n_here};
    const auto [hit, intersects, within, refracted] = interact(at, ray, how);
    passes = passes && intersects && within && refracted;
    if (!passes) return {passes, {}, {}, {}, {}, {}, {}};
    light.apply(at, wavelength_nm, ray.direction, hit, how);
    if (medium > 0 && media_.absorbs(medium))
      depth += media_.absorption_per_mm(medium, coordinate) * (how.forwards ? hit.length_mm : -hit.length_mm);
    ray = {select<Real>(passes, hit.point, ray.origin), select<Real>(passes, hit.direction, ray.direction)};
    if (!how.reflects) n_here = n_next;
  }
  const Vec3<Real>& d = ray.direction;
  const Vec3<Real> there = ray.origin + d * Real((image_z() - ray.origin.z) / d.z);
  const Real passed = by_lane<Real>([&](int j) { return std::exp(-lane_of(depth, j)); });
  return {passes && d.z > 0, {there.x, there.y}, d, light.power() * passed, ray.origin,
          light.first(),     light.second()};
}

std::optional<ImageRay> SpectralSystem::to_image(const Ray& ray, double wavelength_nm,
                                                 const Route& route) const {
  const ImageRay arrival = trace_to_image(ray, wavelength_nm, route);
  return arrival.reached_image ? std::optional(arrival) : std::nullopt;
}

BasicImageRay<Floats> SpectralSystem::to_image(const std::array<PacketRay, 2>& rays,
                                               const Route& route) const {
  BasicRay<Floats> together;
  Floats wavelengths_nm;
  for (int lane = 0; lane < Floats::kCount; ++lane) {
    const auto& [ray, of_packet_nm] = rays[static_cast<std::size_t>(lane / kLanes)];
    set_lane(together.origin, lane, Imath::V3f(ray.origin));
    set_lane(together.direction, lane, Imath::V3f(ray.direction));
    wavelengths_nm.set(lane, of_packet_nm[lane % kLanes]);
  }
  return trace_to_image(together, wavelengths_nm, route);
}

template <typename Real>
Crossing<Real> SpectralSystem::interact_next(const Step& step, const MediaTable::Coordinate<Real>& coordinate,
                                             const BasicRay<Real>& ray) const {
  const auto& [i, how] = step;
  return interact<Real>(
      {system_.surfaces[i], frames_[i], media_.n(i, coordinate), media_.n(i + 1, coordinate)}, ray, how);
}

// Backwards, light crosses in the opposite direction but arrives at a reflecting surface from the same side.
template <typename Real>
BasicObjectRay<Real> SpectralSystem::trace_to_object(BasicRay<Real> ray, const Real& wavelength_nm,
                                                     const Route& route) const {
  const auto coordinate = media_.coordinate(wavelength_nm);
  Mask<Real> passes = true;
  for (auto step = route.rbegin(); step != route.rend(); ++step) {
    const auto [of, how] = *step;
    const auto [hit, intersects, within, refracted] =
        interact_next<Real>({of, {how.reflects == how.forwards, how.reflects}}, coordinate, ray);
    passes = passes && intersects && within && refracted;
    if (!passes) return {passes, ray};
    ray = {select<Real>(passes, hit.point, ray.origin), select<Real>(passes, hit.direction, ray.direction)};
  }
  return {passes && ray.direction.z < 0, ray};
}

std::optional<Ray> SpectralSystem::to_object(const Ray& ray, double wavelength_nm, const Route& route) const {
  const auto [reached_object, out] = trace_to_object(ray, wavelength_nm, route);
  return reached_object ? std::optional(out) : std::nullopt;
}

std::vector<std::optional<Ray>> SpectralSystem::to_object(std::span<const ColouredRay> rays) const {
  std::vector<std::optional<Ray>> all(rays.size());
  for (std::size_t first = 0; first < rays.size(); first += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, rays.size() - first);
    BasicRay<Doubles> together;
    Doubles wavelengths_nm;
    for (std::size_t i = 0; i < kLanes; ++i) {  // lanes after the last ray repeat it
      const auto& [ray, wavelength_nm] = rays[first + std::min(i, count - 1)];
      const int lane = static_cast<int>(i);
      set_lane(together.origin, lane, ray.origin);
      set_lane(together.direction, lane, ray.direction);
      wavelengths_nm.set(lane, wavelength_nm);
    }
    const auto [reached_object, out] = trace_to_object(together, wavelengths_nm, direct_);
    for (std::size_t i = 0; i < count; ++i)
      if (const int lane = static_cast<int>(i); reached_object[lane])
        all[first + i] = Ray{lane_of(out.origin, lane), lane_of(out.direction, lane)};
  }
  return all;
}

std::optional<Imath::V2d> SpectralSystem::at_stop(const Ray& start, double wavelength_nm) const {
  const auto coordinate = media_.coordinate(wavelength_nm);
  Ray ray = start;
  for (std::size_t i = frames_.size(); i-- > system_.stop + 1;) {
    const auto [hit, intersects, within, refracted] =
        interact_next<double>({i, {false, false}}, coordinate, ray);
    if (!intersects || !refracted) return std::nullopt;
    ray = {hit.point, hit.direction};
  }
  const SystemAt::Frame& frame = frames_[system_.stop];
  const Ray local{(ray.origin - frame.vertex) * frame.to_local, -ray.direction * frame.to_local};
  const auto t = system_.surfaces[system_.stop].profile.intersect(local);
  if (!t) return std::nullopt;
  const V3d point = local.origin + *t * local.direction;
  return Imath::V2d(point.x, point.y) / stop_radius_mm_;
}

SurfacePoint SpectralSystem::point_of(std::size_t surface, const Imath::V2d& local) const {
  const SystemAt::Frame& frame = frames_[surface];
  const Profile& profile = system_.surfaces[surface].profile;
  const V3d point(local.x, local.y, profile.sag(local.length2()));
  const V3d normal = profile.normal(point);
  return {point * frame.to_world + frame.vertex, normal * frame.to_world, normal.z};
}

Imath::V2d SpectralSystem::local_of(std::size_t surface, const V3d& point) const {
  const V3d local = (point - frames_[surface].vertex) * frames_[surface].to_local;
  return {local.x, local.y};
}

}  // namespace abbe::lens
