#pragma once

namespace abbe {

/// Diffuse reflectance of a smooth interface from the side of lower index: 2 int_0^1 R(c) c dc with R the
/// mean over s and p. eta >= 1 is the higher index divided by the lower. Accurate to 1e-7. [Judd1942]
[[nodiscard]] double diffuse_reflectance_outside(double eta);

/// Diffuse reflectance from inside a medium of index eta relative to the outside, including total internal
/// reflection. Any eta > 0 is allowed. Diffuse transmission from outside is eta^2 times that from inside, so
/// 1 - r_inside = (1 - r_outside)/eta^2. [Judd1942]
[[nodiscard]] double diffuse_reflectance_inside(double eta);

/// Diffuse reflectance of a smooth interface to a medium of index n + ik, relative to the outside, from which
/// the light arrives; n > 0, k >= 0. It is 2 int_0^1 R(c) c dc by Gauss-Legendre quadrature, accurate to
/// 5e-5. If n < 1 and k is so small that total reflection sets in at an angle, the error is up to 2e-3.
[[nodiscard]] double diffuse_reflectance(double n, double k);

}  // namespace abbe
