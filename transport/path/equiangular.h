#pragma once

#include <optional>

#include "scene/lights/light.h"
#include "scene/shapes/ray.h"

namespace abbe {

/// Equiangular sampling of a distance along a ray in a medium, for a light at a point [Kulla2012]. The
/// range is the part of the ray within the light's cone, if the cone is narrower than a half space. The pdf
/// is uniform in the angle at which the light sees the point. Let D be the light's distance from the ray, t
/// the signed distance along the ray from its point nearest to the light, and theta = atan(t/D):
///     p(t) = D / ((theta_b - theta_a) (D^2 + t^2)),
/// theta_a and theta_b being the angles at both ends of the range. The factor 1/d^2 of the light cancels.
class Equiangular {
 public:
  /// Sampler for the first `length` [m] of a ray, which may be infinite. Returns nothing for other
  /// lights, for a light that illuminates no part of it, and for a light at the ray's origin.
  [[nodiscard]] static std::optional<Equiangular> along(const Ray& ray, float length, const Light& light);

  /// Samples a distance from the ray's origin [m], within the range, with `u` in [0, 1).
  [[nodiscard]] float sample(float u) const;
  /// Pdf of a distance from the ray's origin [1/m]; 0 outside the range.
  [[nodiscard]] float pdf(float distance) const;

 private:
  Equiangular(double from, double to, double foot, double height);

  float from_, to_;    // range of distances [m]
  double foot_;        // distance of the point nearest to the light [m]
  double height_;      // distance of that point from the light [m]
  double low_, high_;  // angles at both ends of the range
};

}  // namespace abbe
