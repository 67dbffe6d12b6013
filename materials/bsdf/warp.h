#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <ImathVec.h>

namespace abbe {

/// Unit vector at the polar angle of cosine `cos_theta`, in [-1, 1], from z and the azimuth `phi` [rad] from
/// x towards y.
[[nodiscard]] inline Imath::V3f direction_at(double cos_theta, double phi) {
  const double sin_theta = std::sqrt(std::max(0.0, (1 - cos_theta) * (1 + cos_theta)));
  return Imath::V3f(Imath::V3d(sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta));
}

struct SineCosine {
  float sine, cosine;
};
/// Sine and cosine of an angle in [-pi/4, pi/4] rad, by their series, to float precision.
[[nodiscard]] inline SineCosine sine_cosine_of_eighth(float angle) {
  const float x = angle * angle;
  return {angle * (1 + x * (-1.0F / 6 + x * (1.0F / 120 + x * (-1.0F / 5040 + x * (1.0F / 362880))))),
          1 + x * (-0.5F + x * (1.0F / 24 + x * (-1.0F / 720 + x * (1.0F / 40320))))};
}

/// Area of a disc, in the squared unit of the radius.
template <typename Real>
[[nodiscard]] Real disc_area(Real radius) {
  return std::numbers::pi_v<Real> * radius * radius;
}

/// Maps `u` in [0, 1)^2 uniformly to the unit disc. Squares become rings, so neighbours stay together.
/// [Shirley1997]
[[nodiscard]] inline Imath::V2f concentric_disc(const Imath::V2f& u) {
  const float a = 2 * u.x - 1;
  const float b = 2 * u.y - 1;
  const bool along_x = std::abs(a) > std::abs(b);
  const float radius = along_x ? a : b;
  if (radius == 0) return {0, 0};
  const auto [sine, cosine] = sine_cosine_of_eighth(std::numbers::pi_v<float> / 4 *
                                                    ((along_x ? b : a) / radius));  // angle from that axis
  return {radius * (along_x ? cosine : sine), radius * (along_x ? sine : cosine)};
}

/// Inverse of `concentric_disc`: the point in [0, 1]^2 that maps to a point of the unit disc.
[[nodiscard]] inline Imath::V2d square_of_disc(const Imath::V2d& at) {
  const bool along_x = std::abs(at.x) > std::abs(at.y);
  const double axis = along_x ? at.x : at.y;
  const double across = along_x ? at.y : at.x;
  const double radius = std::copysign(at.length(), axis);
  const double other = axis == 0 ? 0 : radius * std::atan(across / axis) * 4 / std::numbers::pi;
  return {((along_x ? radius : other) + 1) / 2, ((along_x ? other : radius) + 1) / 2};
}

/// Samples a direction about z, z >= 0, with pdf cos/(pi sine^2) [1/sr] within the cone about z whose half
/// angle has the sine `sine`, in (0, 1]. `u` is in [0, 1)^2.
[[nodiscard]] inline Imath::V3f cosine_cone(const Imath::V2f& u, float sine) {
  const float radius = sine * std::max(std::abs(2 * u.x - 1),
                                       std::abs(2 * u.y - 1));  // distance of the disc point from the center
  const Imath::V2f disc = concentric_disc(u) * sine;
  return {disc.x, disc.y, std::sqrt((1 - radius) * (1 + radius))};
}

/// Samples a direction about z, z >= 0, with pdf cos/pi [1/sr]. `u` is in [0, 1)^2.
[[nodiscard]] inline Imath::V3f cosine_hemisphere(const Imath::V2f& u) {
  return cosine_cone(u, 1);
}

}  // namespace abbe
