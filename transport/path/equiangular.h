#pragma once

#include <optional>

#include "scene/lights/light.h"
#include "scene/shapes/ray.h"

namespace abbe {

/// A stretch of a ray through matter, from its origin, which a light at a point may light: the part of it
/// that lies within the light's cone, if that is less than a half space, and the density there that is even
/// in the angle under which the light sees it,
///     p(t) = D / ((theta_b - theta_a) (D^2 + t^2)),
/// t being measured from where the ray passes the light at the distance D [Kulla2012]. So 1/d^2 of what the
/// light sends cancels.
class Equiangular {
 public:
  /// Of a point or spot light and the first `length` [m], perhaps infinite, of a ray. Nothing where the light
  /// is of another kind or shines on no part of it.
  [[nodiscard]] static std::optional<Equiangular> along(const Ray& ray, float length, const Light& light);

  /// The distance from the ray's origin [m] for a number in [0, 1).
  [[nodiscard]] float sample(float u) const;
  /// Density of a distance [1/m]; 0 outside the part.
  [[nodiscard]] float pdf(float distance) const;

 private:
  Equiangular(double from, double to, double foot, double height);

  float from_, to_;    // of the part
  double foot_;        // where the ray passes the light,
  double height_;      // and how far from it
  double low_, high_;  // angles of the part's ends
};

}  // namespace abbe
