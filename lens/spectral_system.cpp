#include "lens/spectral_system.h"

#include <algorithm>
#include <cmath>

namespace abbe::lens {
namespace {

using Imath::Vec3;
using V3d = Imath::V3d;

// Of a ray without lanes.
template <typename Real>
BasicRay<Real> in_all_lanes(const Ray& ray) {
  return {Imath::Vec3<Real>(ray.origin), Imath::Vec3<Real>(ray.direction)};
}

}  // namespace

SpectralSystem::SpectralSystem(System system, double stop_radius_mm)
    : system_(std::move(system)), stop_radius_mm_(stop_radius_mm), media_(system_) {
  std::optional<double>& aperture = system_.surfaces[system_.stop].semi_aperture_mm;
  aperture = std::min(stop_radius_mm, aperture.value_or(stop_radius_mm));
  const SystemAt at(system_, system_.primary_nm());
  frames_ = at.frames;
  vertex_z_ = at.vertex_z;
}

// Lanes that have ended stay where they were.
template <typename Real>
BasicArrival<Real> SpectralSystem::follow(BasicRay<Real> ray, const Real& wavelength_nm) const {
  const auto place = media_.place(wavelength_nm);
  WeakenedLight<Real> light(ray.direction);
  Truth<Real> passes = true;
  Real depth = 0;
  Real n_before = 1;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const SurfaceBetween<Real> at{system_.surfaces[i], frames_[i], n_before, media_.n(i + 1, place)};
    const auto [hit, met, within, refracted] = cross(at, ray);
    passes = passes && met && within && refracted;
    if (!passes) return {passes, {}, {}, {}};
    light.cross(at, wavelength_nm, ray.direction, hit);
    if (i > 0 && media_.absorbs(i)) depth += media_.absorption_per_mm(i, place) * hit.length_mm;
    ray = {select<Real>(passes, hit.point, ray.origin), select<Real>(passes, hit.direction, ray.direction)};
    n_before = at.n_behind;
  }
  const Vec3<Real>& d = ray.direction;
  const Vec3<Real> there = ray.origin + d * Real((image_z() - ray.origin.z) / d.z);
  const Real passed = by_lane<Real>([&](int j) { return std::exp(-lane_of(depth, j)); });
  return {passes && d.z > 0, {there.x, there.y}, d, light.power() * passed};
}

std::optional<Arrival> SpectralSystem::to_image(const Ray& ray, double wavelength_nm) const {
  const Arrival arrival = follow(ray, wavelength_nm);
  return arrival.arrived ? std::optional(arrival) : std::nullopt;
}

BasicArrival<Doubles> SpectralSystem::to_image(const Ray& ray, const SampledSpectrum& wavelengths_nm) const {
  return follow(in_all_lanes<Doubles>(ray), Doubles(wavelengths_nm));
}

Crossing<double> SpectralSystem::cross_next(std::size_t surface, const MediaTable::Place<double>& place,
                                            const Ray& ray) const {
  return cross_back<double>(
      {system_.surfaces[surface], frames_[surface], media_.n(surface, place), media_.n(surface + 1, place)},
      ray);
}

std::optional<Ray> SpectralSystem::to_object(const Ray& start, double wavelength_nm) const {
  const auto place = media_.place(wavelength_nm);
  Ray ray = start;
  for (std::size_t i = frames_.size(); i-- > 0;) {
    const auto [hit, met, within, refracted] = cross_next(i, place, ray);
    if (!met || !within || !refracted) return std::nullopt;
    ray = {hit.point, hit.direction};
  }
  return ray.direction.z < 0 ? std::optional(ray) : std::nullopt;
}

std::optional<Imath::V2d> SpectralSystem::at_stop(const Ray& start, double wavelength_nm) const {
  const auto place = media_.place(wavelength_nm);
  Ray ray = start;
  for (std::size_t i = frames_.size(); i-- > system_.stop + 1;) {
    const auto [hit, met, within, refracted] = cross_next(i, place, ray);
    if (!met || !refracted) return std::nullopt;
    ray = {hit.point, hit.direction};
  }
  const SystemAt::Frame& frame = frames_[system_.stop];
  const Ray local{(ray.origin - frame.vertex) * frame.to_local, -ray.direction * frame.to_local};
  const auto t = system_.surfaces[system_.stop].profile.intersect(local);
  if (!t) return std::nullopt;
  const V3d point = local.origin + *t * local.direction;
  return Imath::V2d(point.x, point.y) / stop_radius_mm_;
}

}  // namespace abbe::lens
