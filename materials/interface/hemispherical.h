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

}  // namespace abbe
