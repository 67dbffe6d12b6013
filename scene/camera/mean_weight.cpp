#include "scene/camera/mean_weight.h"

#include <cmath>
#include <numbers>

#include "scene/camera/perspective.h"

namespace abbe {
namespace {

// Twice the mean squared radius of an opening in the unit circle, which is 1 for the disc. The squared radius
// of an iris point is proportional to that of its disc point, so that the rim suffices.
double mean_square(const std::optional<lens::Iris>& iris) {
  if (!iris) return 1;
  constexpr int kAngles = 7200;
  double sum = 0;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / kAngles;
    sum += iris->point({std::cos(angle), std::sin(angle)}).length2();
  }
  return sum / kAngles;
}

// Mean of cos^4 = 1/(1 + t^2)^2 over the tangents t in a disc of radius k about the tangent u. It is the
// projected solid angle of a disc seen from an element of a parallel plane, divided by the disc's area:
//     2/(B (A + B)),  A = 1 + u^2 - k^2,  B^2 = A^2 + 4 k^2.
double mean_cos4(double u, double k) {
  const double a = 1 + u * u - k * k;
  const double b = std::hypot(a, 2 * k);
  return 2 / (b * (a + b));
}

}  // namespace

double opening_tangent(const Camera& camera) {
  const auto* lens = std::get_if<ThinLens>(&camera.kind);
  if (lens == nullptr) return 0;
  return lens->aperture_radius * std::sqrt(mean_square(lens->iris)) / lens->focus_distance;
}

double mean_weight(const Camera& camera, double opening_tangent, Imath::V2f film) {
  const double central = central_weight(camera, film);
  if (opening_tangent == 0) return central;
  const double u = film_plane(camera.film(), film).length() / traits(camera).image_distance.value();
  return central * mean_cos4(u, opening_tangent) / mean_cos4(u, 0);
}

}  // namespace abbe
