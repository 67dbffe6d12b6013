#include "scene/camera/probe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/bsdf/warp.h"
#include "scene/shapes/basic.h"
#include "scene/shapes/ray.h"

namespace abbe {
namespace {

// The surfaces that are no `FlatShape` answer as those of scene/shapes/basic.h do.

Imath::V3d point_at(const ProbePoint& point, const Imath::V2d& /*uv*/) {
  return point.at;
}
Imath::V3d point_at(const SphereSide& side, const Imath::V2d& uv) {
  return point_at(side.sphere, uv);
}
Imath::V2d uv_of(const ProbePoint& /*point*/, const Imath::V3d& /*at*/) {
  return {0.5, 0.5};
}
Imath::V2d uv_of(const SphereSide& side, const Imath::V3d& at) {
  return uv_of(side.sphere, at);
}
const Imath::V3d& anchor_of(const ProbePoint& point) {
  return point.at;
}
const Imath::V3d& anchor_of(const SphereSide& side) {
  return side.sphere.center;
}
Imath::V3d center_of(const ProbePoint& point) {
  return point.at;
}
Imath::V3d center_of(const SphereSide& side) {
  return side.sphere.center;
}
void shift(ProbePoint& point, const Imath::V3d& by) {
  point.at += by;
}
void shift(SphereSide& side, const Imath::V3d& by) {
  shift(side.sphere, by);
}
double area_of(const ProbePoint& /*point*/) {
  return 0;
}
double area_of(const SphereSide& side) {
  return area(side.sphere);
}
template <typename Flat>
double area_of(const Flat& flat) {
  return area(flat);
}
Imath::V3d normal_at_point(const ProbePoint& point, const Imath::V3f& /*at*/) {
  return point.normal;
}
Imath::V3d normal_at_point(const SphereSide& side, const Imath::V3f& at) {
  const Imath::V3d outward = (Imath::V3d(at) - side.sphere.center).normalized();
  return side.inwards ? -outward : outward;
}
template <typename Flat>
Imath::V3d normal_at_point(const Flat& flat, const Imath::V3f& /*at*/) {
  return normal_of(flat);
}

// Clamped to less than the film's width or height, even after rounding.
float along_film(double fraction, int pixels) {
  const auto end = static_cast<float>(pixels);
  return std::min(static_cast<float>(std::clamp(fraction, 0.0, 1.0) * pixels), std::nextafter(end, 0.0F));
}

Imath::V2f film_at(const IrradianceProbe& probe, const FilmGrid& grid, const Imath::V3f& point) {
  const Imath::V2d uv =
      std::visit([&](const auto& surface) { return uv_of(surface, Imath::V3d(point)); }, probe.surface);
  return {along_film(uv.x, grid.width), along_film(uv.y, grid.height)};
}

std::optional<Opening> opening_of(const ProbePoint& /*point*/) {
  return std::nullopt;
}
std::optional<Opening> opening_of(const SphereSide& side) {
  return side;
}
template <typename Flat>
std::optional<Opening> opening_of(const Flat& flat) {
  const auto [corner, edge_u, edge_v, center, normal, round] = *flat_face(flat);
  return FlatOpening{center, edge_u * 0.5, edge_v * 0.5, normal, round};
}

}  // namespace

CameraRay IrradianceProbe::sample_ray(const FilmGrid& grid, const CameraSample& sample) const {
  const Imath::V2d uv(static_cast<double>(sample.film.x) / grid.width,
                      static_cast<double>(sample.film.y) / grid.height);
  const Imath::V3f point(std::visit([&](const auto& of) { return point_at(of, uv); }, surface));
  const Imath::V3f normal = normal_at(point);
  const Imath::V3f local = cosine_cone(sample.lens, static_cast<float>(acceptance));
  // Starts on the side of its normal even at grazing directions.
  return {ray_at(offset_point(point, normal, normal), Basis<float>(normal).to_world(local), sample.time),
          SampledSpectrum(static_cast<float>(disc_area(acceptance))), local.z};
}

std::optional<CameraDensity> IrradianceProbe::density(const FilmGrid& grid, const Ray& ray,
                                                      const SampledSpectrum& /*wavelengths_nm*/,
                                                      LensRoute /*route*/) const {
  const Imath::V3f normal = normal_at(ray.origin);
  const float cos_theta = normal.dot(ray.direction);
  if (!within_acceptance(static_cast<float>(acceptance), normal, ray.direction)) return std::nullopt;
  const double patch_area = area() / (static_cast<double>(grid.width) * grid.height);
  const double pdf_position = patch_area > 0 ? 1 / patch_area : 1;
  return CameraDensity{film_at(*this, grid, ray.origin),
                       SampledSpectrum(static_cast<float>(pdf_position)),
                       static_cast<float>(pdf_position),
                       SampledSpectrum(cos_theta / static_cast<float>(disc_area(acceptance))),
                       cos_theta,
                       cos_theta};
}

double IrradianceProbe::min_film_cosine(const FilmGrid& /*grid*/) const {
  return std::sqrt((1 - acceptance) * (1 + acceptance));
}

CameraTraits IrradianceProbe::traits() const {
  CameraTraits of{.probe_acceptance = static_cast<float>(acceptance)};
  of.opening = std::visit([](const auto& surface) { return opening_of(surface); }, surface);
  return of;
}

const Imath::V3d& IrradianceProbe::position() const {
  return std::visit([](const auto& of) -> const Imath::V3d& { return anchor_of(of); }, surface);
}

Imath::V3d IrradianceProbe::center() const {
  return std::visit([](const auto& of) { return center_of(of); }, surface);
}

void IrradianceProbe::translate(const Imath::V3d& by) {
  std::visit([&by](auto& of) { shift(of, by); }, surface);
}

Imath::V3f IrradianceProbe::normal_at(const Imath::V3f& point) const {
  return Imath::V3f(std::visit([&point](const auto& of) { return normal_at_point(of, point); }, surface));
}

double IrradianceProbe::area() const {
  return std::visit([](const auto& of) { return area_of(of); }, surface);
}

}  // namespace abbe
