#pragma once

namespace abbe {

/// Reflectance of a smooth interface for light that is the same from all directions of the thinner side,
/// 2 int_0^1 R(c) c dc with R the mean over s and p; eta >= 1 is the index of the denser side over that of
/// the thinner. To 1e-7. [Judd1942]
[[nodiscard]] double diffuse_reflectance_outside(double eta);

/// Reflectance of diffuse light from inside matter of any index eta relative to the outside, what is totally
/// reflected included: the passages of a diffuse light either way are as 1 to eta^2, so that 1 - r_inside =
/// (1 - r_outside)/eta^2. [Judd1942]
[[nodiscard]] double diffuse_reflectance_inside(double eta);

/// Reflectance of a smooth interface to matter of index n + ik relative to the outside, for diffuse light
/// from there, 2 int_0^1 R(c) c dc by the points of Gauss and Legendre: to 5e-5, or 2e-3 where n < 1 and k is
/// so small that total reflection begins at an angle.
[[nodiscard]] double diffuse_reflectance(double n, double k);

}  // namespace abbe
