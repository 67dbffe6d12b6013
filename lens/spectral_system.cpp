#include "lens/spectral_system.h"

#include <algorithm>
#include <cmath>

namespace abbe::lens {
namespace {

using V3d = Imath::V3d;

// Of a function of wavelength, every nanometre.
template <typename F>
Curve sampled(F f) {
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({static_cast<double>(nm), f(static_cast<double>(nm))});
  return Curve(std::move(knots));
}

}  // namespace

SpectralSystem::SpectralSystem(System system, double stop_radius_mm)
    : system_(std::move(system)), stop_radius_mm_(stop_radius_mm), n_{Curve(1)}, absorption_{Curve(0)} {
  std::optional<double>& aperture = system_.surfaces[system_.stop].semi_aperture_mm;
  aperture = std::min(stop_radius_mm, aperture.value_or(stop_radius_mm));
  const SystemAt at(system_, system_.primary_nm());
  frames_ = at.frames;
  vertex_z_ = at.vertex_z;
  for (const Surface& surface : system_.surfaces) {
    if (!surface.behind) {
      n_.emplace_back(1);
      absorption_.emplace_back(0);
      continue;
    }
    const RefractiveIndex& index = surface.behind->index;
    n_.push_back(sampled([&](double nm) { return index.n(nm); }));
    absorption_.push_back(sampled([&](double nm) { return index.absorption_per_m(nm) * 1e-3; }));
  }
}

std::optional<Arrival> SpectralSystem::to_image(const Ray& start, double wavelength_nm) const {
  Ray ray = start;
  WeakenedLight light(ray.direction);
  double depth = 0;
  double n_before = 1;
  RayHit hit{};
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const SurfaceBetween at{system_.surfaces[i], frames_[i], n_before, n(i + 1, wavelength_nm)};
    if (cross(at, Apertures::obeyed, ray, hit) != RayEnd::image) return std::nullopt;
    light.cross(at, wavelength_nm, ray.direction, hit);
    if (i > 0 && system_.surfaces[i - 1].behind) depth += absorption_[i](wavelength_nm) * hit.length_mm;
    ray = {hit.point, hit.direction};
    n_before = at.n_behind;
  }
  if (!(ray.direction.z > 0)) return std::nullopt;
  const V3d there = ray.origin + (image_z() - ray.origin.z) / ray.direction.z * ray.direction;
  return Arrival{{there.x, there.y}, ray.direction, light.power() * std::exp(-depth)};
}

RayEnd SpectralSystem::back_through(std::size_t surface, Apertures apertures, double wavelength_nm, Ray& ray,
                                    double& n_behind, RayHit& hit) const {
  const SurfaceBetween at{system_.surfaces[surface], frames_[surface], n(surface, wavelength_nm), n_behind};
  const RayEnd end = cross_back(at, apertures, ray, hit);
  ray = {hit.point, hit.direction};
  n_behind = at.n_before;
  return end;
}

std::optional<Ray> SpectralSystem::to_object(const Ray& start, double wavelength_nm) const {
  Ray ray = start;
  RayHit hit{};
  double n_behind = n(frames_.size(), wavelength_nm);
  for (std::size_t i = frames_.size(); i-- > 0;)
    if (back_through(i, Apertures::obeyed, wavelength_nm, ray, n_behind, hit) != RayEnd::image)
      return std::nullopt;
  return ray.direction.z < 0 ? std::optional(ray) : std::nullopt;
}

std::optional<Imath::V2d> SpectralSystem::at_stop(const Ray& start, double wavelength_nm) const {
  Ray ray = start;
  RayHit hit{};
  double n_behind = n(frames_.size(), wavelength_nm);
  for (std::size_t i = frames_.size(); i-- > system_.stop + 1;)
    if (back_through(i, Apertures::ignored, wavelength_nm, ray, n_behind, hit) != RayEnd::image)
      return std::nullopt;
  const SystemAt::Frame& frame = frames_[system_.stop];
  const Ray local{(ray.origin - frame.vertex) * frame.to_local, -ray.direction * frame.to_local};
  const auto t = system_.surfaces[system_.stop].profile.intersect(local);
  if (!t) return std::nullopt;
  const V3d point = local.origin + *t * local.direction;
  return Imath::V2d(point.x, point.y) / stop_radius_mm_;
}

}  // namespace abbe::lens
