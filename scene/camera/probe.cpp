#include "scene/camera/probe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/bsdf/warp.h"
#include "scene/shapes/basic.h"
#include "scene/shapes/ray.h"

namespace abbe {
namespace {

// Area-preserving maps between the unit square and each surface: `point_at`, and its inverse `uv_of`.

Imath::V3d point_at(const ProbePoint& point, const Imath::V2d& /*uv*/) {
  return point.at;
}

Imath::V3d point_at(const Quad& quad, const Imath::V2d& uv) {
  return quad.corner + quad.edge_u * uv.x + quad.edge_v * uv.y;
}

Imath::V3d point_at(const Disc& disc, const Imath::V2d& uv) {
  return Imath::V3d(sample_area(disc, Imath::V2f(uv)).point);
}

Imath::V3d point_at(const SphereSide& side, const Imath::V2d& uv) {
  return Imath::V3d(sample_area(side.sphere, Imath::V2f(uv)).point);
}

Imath::V2d uv_of(const ProbePoint& /*point*/, const Imath::V3d& /*at*/) {
  return {0.5, 0.5};
}

// Solves (u edge_u + v edge_v) . edge = (at - corner) . edge for both edges.
Imath::V2d uv_of(const Quad& quad, const Imath::V3d& at) {
  const Imath::V3d d = at - quad.corner;
  const double uu = quad.edge_u.length2();
  const double uv = quad.edge_u.dot(quad.edge_v);
  const double vv = quad.edge_v.length2();
  const double determinant = uu * vv - uv * uv;
  const double du = d.dot(quad.edge_u);
  const double dv = d.dot(quad.edge_v);
  return {(du * vv - dv * uv) / determinant, (dv * uu - du * uv) / determinant};
}

Imath::V2d uv_of(const Disc& disc, const Imath::V3d& at) {
  const Imath::V3d local = Basis<double>(disc.normal).to_local(at - disc.center) / disc.radius;
  return square_of_disc({local.x, local.y});
}

Imath::V2d uv_of(const SphereSide& side, const Imath::V3d& at) {
  const Imath::V3d outward = (at - side.sphere.center) / side.sphere.radius;
  const double turn = std::atan2(outward.y, outward.x) / (2 * std::numbers::pi);
  return {(1 - outward.z) / 2, turn < 0 ? turn + 1 : turn};
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

std::optional<Opening> opening_of(const Quad& quad) {
  return FlatOpening{quad.corner + (quad.edge_u + quad.edge_v) * 0.5, quad.edge_u * 0.5, quad.edge_v * 0.5,
                     normal_of(quad), false};
}

std::optional<Opening> opening_of(const Disc& disc) {
  const Basis<double> axes(disc.normal);
  return FlatOpening{disc.center, axes.x * disc.radius, axes.y * disc.radius, disc.normal, true};
}

std::optional<Opening> opening_of(const SphereSide& side) {
  return side;
}

}  // namespace

CameraRay IrradianceProbe::sample_ray(const FilmGrid& grid, Imath::V2f film, Imath::V2f direction,
                                      const SampledSpectrum& /*wavelengths_nm*/, int /*hero*/,
                                      float time) const {
  const Imath::V2d uv(static_cast<double>(film.x) / grid.width, static_cast<double>(film.y) / grid.height);
  const Imath::V3f point(std::visit([&](const auto& of) { return point_at(of, uv); }, surface));
  const Imath::V3f normal = normal_at(point);
  const Imath::V3f local = cosine_cone(direction, static_cast<float>(acceptance));
  // Starts on the side of its normal even at grazing directions.
  return {ray_at(offset_point(point, normal, normal), Basis<float>(normal).to_world(local), time),
          SampledSpectrum(static_cast<float>(disc_area(acceptance))), local.z};
}

std::optional<CameraConnection> IrradianceProbe::sample_towards(const FilmGrid& /*grid*/,
                                                                const Imath::V3f& /*point*/,
                                                                Imath::V2f /*lens*/,
                                                                const SampledSpectrum& /*wavelengths_nm*/,
                                                                float /*time*/) const {
  return std::nullopt;
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
  if (const auto* point = std::get_if<ProbePoint>(&surface)) return point->at;
  if (const auto* quad = std::get_if<Quad>(&surface)) return quad->corner;
  if (const auto* disc = std::get_if<Disc>(&surface)) return disc->center;
  return std::get<SphereSide>(surface).sphere.center;
}

Imath::V3d IrradianceProbe::center() const {
  const auto* quad = std::get_if<Quad>(&surface);
  return quad != nullptr ? point_at(*quad, {0.5, 0.5}) : position();
}

void IrradianceProbe::translate(const Imath::V3d& by) {
  if (auto* point = std::get_if<ProbePoint>(&surface)) point->at += by;
  if (auto* quad = std::get_if<Quad>(&surface)) quad->corner += by;
  if (auto* disc = std::get_if<Disc>(&surface)) disc->center += by;
  if (auto* side = std::get_if<SphereSide>(&surface)) side->sphere.center += by;
}

Imath::V3f IrradianceProbe::normal_at(const Imath::V3f& point) const {
  if (const auto* single = std::get_if<ProbePoint>(&surface)) return Imath::V3f(single->normal);
  if (const auto* quad = std::get_if<Quad>(&surface)) return Imath::V3f(normal_of(*quad));
  if (const auto* disc = std::get_if<Disc>(&surface)) return Imath::V3f(disc->normal);
  const auto& side = std::get<SphereSide>(surface);
  const Imath::V3d outward = (Imath::V3d(point) - side.sphere.center).normalized();
  return Imath::V3f(side.inwards ? -outward : outward);
}

double IrradianceProbe::area() const {
  if (const auto* quad = std::get_if<Quad>(&surface)) return abbe::area(*quad);
  if (const auto* disc = std::get_if<Disc>(&surface)) return abbe::area(*disc);
  if (const auto* side = std::get_if<SphereSide>(&surface)) return abbe::area(side->sphere);
  return 0;
}

}  // namespace abbe
