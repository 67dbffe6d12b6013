#include "scene/camera/irradiance_probe.h"

#include <algorithm>
#include <numbers>

#include "materials/bsdf/warp.h"
#include "scene/shapes/basis.h"

namespace abbe {
namespace {

// Where on the film a point of the parallelogram is, as the solution of
// (u edge_u + v edge_v) . edge = (point - corner) . edge for both edges.
Imath::V2f film_at(const IrradianceProbe& probe, const FilmGrid& grid, const Imath::V3f& point) {
  const Imath::V3d d = Imath::V3d(point) - probe.corner;
  const double uu = probe.edge_u.length2();
  const double uv = probe.edge_u.dot(probe.edge_v);
  const double vv = probe.edge_v.length2();
  const double determinant = uu * vv - uv * uv;
  Imath::V2d at(0.5, 0.5);
  if (determinant > 0) {
    const double du = d.dot(probe.edge_u);
    const double dv = d.dot(probe.edge_v);
    at = {(du * vv - dv * uv) / determinant, (dv * uu - du * uv) / determinant};
  }
  return {static_cast<float>(std::clamp(at.x, 0.0, 1.0) * grid.width),
          static_cast<float>(std::clamp(at.y, 0.0, 1.0) * grid.height)};
}

}  // namespace

CameraRay IrradianceProbe::sample_ray(const FilmGrid& grid, Imath::V2f film, Imath::V2f direction,
                                      const SampledSpectrum& /*wavelengths_nm*/, int /*hero*/,
                                      float time) const {
  const Imath::V3d point = corner + edge_u * (static_cast<double>(film.x) / grid.width) +
                           edge_v * (static_cast<double>(film.y) / grid.height);
  const Imath::V3f local = cosine_hemisphere(direction);
  const Imath::V3f outward(normal);
  return {spawn(Imath::V3f(point), outward, Basis<float>(outward).to_world(local), time),
          SampledSpectrum(std::numbers::pi_v<float>), local.z};
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
  const double cos_theta = normal.dot(Imath::V3d(ray.direction));
  if (!(cos_theta > 0)) return std::nullopt;
  const double patch_area = edge_u.cross(edge_v).length() / (static_cast<double>(grid.width) * grid.height);
  const double pdf_position = patch_area > 0 ? 1 / patch_area : 1;
  return CameraDensity{
      film_at(*this, grid, ray.origin), SampledSpectrum(static_cast<float>(pdf_position)),
      static_cast<float>(pdf_position), SampledSpectrum(static_cast<float>(cos_theta / std::numbers::pi)),
      static_cast<float>(cos_theta),    static_cast<float>(cos_theta)};
}

double IrradianceProbe::least_film_cosine(const FilmGrid& /*grid*/) const {
  return 0;
}

CameraTraits IrradianceProbe::traits() const {
  CameraTraits of{.surface_normal = normal};
  if (edge_u.cross(edge_v).length() > 0)
    of.opening = Opening{middle(), edge_u * 0.5, edge_v * 0.5, normal, false};
  return of;
}

}  // namespace abbe
