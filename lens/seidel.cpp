#include "lens/seidel.h"

#include "lens/paraxial.h"

namespace abbe::lens {
namespace {

struct SurfaceRays {
  double y, u, u_behind;  // of the marginal ray
  double chief_y, chief_u;
  double n, n_behind, dn, dn_behind;
  double lagrange;
};

Seidel aspheric(const Profile& profile, const SurfaceRays& r) {
  const double c = profile.curvature;
  const double vertex = profile.vertex_curvature();
  // G = a_2 + ((1 + k) c^3 - C^3)/8 with the vertex curvature C is the r^4 departure from the osculating
  // sphere.
  const double departure = profile.even[1] + ((1 + profile.conic) * c * c * c - vertex * vertex * vertex) / 8;
  const double strength = 8 * departure * (r.n_behind - r.n);
  const double y = r.y;
  const double Y = r.chief_y;
  Seidel s;
  s.spherical = strength * y * y * y * y;
  s.coma = strength * y * y * y * Y;
  s.astigmatism = strength * y * y * Y * Y;
  s.distortion = strength * y * Y * Y * Y;
  return s;
}

Seidel of_surface(const Profile& profile, const SurfaceRays& r) {
  const double c = profile.vertex_curvature();
  const double A = r.n * (r.u + r.y * c);
  const double B = r.n * (r.chief_u + r.chief_y * c);
  const double slope = r.y * (r.u_behind / r.n_behind - r.u / r.n);
  const double inverse = 1 / r.n_behind - 1 / r.n;
  const double inverse2 = 1 / (r.n_behind * r.n_behind) - 1 / (r.n * r.n);
  const double dispersion = r.y * (r.dn_behind / r.n_behind - r.dn / r.n);
  const double H = r.lagrange;
  Seidel s;
  s.spherical = -A * A * slope;
  s.coma = -A * B * slope;
  s.astigmatism = -B * B * slope;
  s.petzval = -H * H * c * inverse;
  s.distortion = -B * (B * B * r.y * inverse2 + (H - B * r.y) * r.chief_y * c * inverse);
  s.axial_color = A * dispersion;
  s.lateral_color = B * dispersion;
  s += aspheric(profile, r);
  return s;
}

}  // namespace

Seidel& Seidel::operator+=(const Seidel& other) {
  spherical += other.spherical;
  coma += other.coma;
  astigmatism += other.astigmatism;
  petzval += other.petzval;
  distortion += other.distortion;
  axial_color += other.axial_color;
  lateral_color += other.lateral_color;
  return *this;
}

SeidelSums seidel_sums(const SystemAt& at, const SystemAt& blue, const SystemAt& red, double marginal_mm,
                       double field) {
  const auto& distance = at.system->object_distance_mm;
  const ParaxialHit marginal{marginal_mm, distance ? marginal_mm / *distance : 0};
  const ParaxialHit chief = paraxial_chief_ray(at, field);
  const auto hits = paraxial_trace(at, marginal.y, marginal.u);
  const auto chief_hits = paraxial_trace(at, chief.y, chief.u);
  const double lagrange = at.n[0] * (marginal.u * chief.y - chief.u * marginal.y);
  SeidelSums sums;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const SurfaceRays rays{.y = hits[i].y,
                           .u = i == 0 ? marginal.u : hits[i - 1].u,
                           .u_behind = hits[i].u,
                           .chief_y = chief_hits[i].y,
                           .chief_u = i == 0 ? chief.u : chief_hits[i - 1].u,
                           .n = at.n[i],
                           .n_behind = at.n[i + 1],
                           .dn = blue.n[i] - red.n[i],
                           .dn_behind = blue.n[i + 1] - red.n[i + 1],
                           .lagrange = lagrange};
    sums.surfaces.push_back(of_surface(at.surface(i).profile, rays));
    sums.sum += sums.surfaces.back();
  }
  sums.image_nu = at.n.back() * hits.back().u;
  return sums;
}

}  // namespace abbe::lens
