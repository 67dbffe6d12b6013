#pragma once

#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// Seidel sums of wavefront aberration, and what each surface adds [mm]: spherical aberration, coma,
/// astigmatism, field curvature (Petzval), distortion, axial and lateral colour.
struct Seidel {
  double spherical = 0;
  double coma = 0;
  double astigmatism = 0;
  double petzval = 0;
  double distortion = 0;
  double axial_color = 0;
  double lateral_color = 0;

  Seidel& operator+=(const Seidel& other);
};

struct SeidelSums {
  std::vector<Seidel> surfaces;
  Seidel sum;
  double image_nu;  ///< n'u' of the marginal ray behind the lens.
};

/// The sums for a beam whose marginal ray has the height `marginal_mm` at the first vertex, from a field as
/// in `System`; `blue` and `red` are the system at the wavelengths whose difference is the colour's. For
/// directions of 90 degrees and more all but S_I and C_I are not numbers.
///
/// With A = n i of the marginal ray (y, u), B that of the chief ray (Y, U), H = n (u Y - U y) the Lagrange
/// invariant, c the curvature and D what a surface changes:
///
///   S_I = -A^2 y D(u/n),   S_II = -A B y D(u/n),   S_III = -B^2 y D(u/n),   S_IV = -H^2 c D(1/n),
///   S_V = -B (B^2 y D(1/n^2) + (H - B y) Y c D(1/n)),   C_I = A y D(dn/n),   C_II = B y D(dn/n),
///
/// and a surface that leaves its osculating sphere by G r^4 adds 8 G D(n) y^4 to S_I, (Y/y) times that to
/// S_II, (Y/y)^2 times to S_III, (Y/y)^3 times to S_V. [Welford1986]
[[nodiscard]] SeidelSums seidel_sums(const SystemAt& at, const SystemAt& blue, const SystemAt& red,
                                     double marginal_mm, double field);

}  // namespace abbe::lens
