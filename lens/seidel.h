#pragma once

#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// Seidel sums of wavefront aberration, or the contribution of a surface [mm]. The members are S_I to S_V,
/// C_I and C_II in this order. S_IV is field curvature (Petzval).
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
  std::vector<Seidel> surfaces;  ///< Contribution of each surface.
  Seidel sum;
  double image_nu;  ///< n'u' of the marginal ray behind the lens; u' is its slope.
};

/// Seidel sums for a beam whose marginal ray has the height `marginal_mm` at the first vertex, from a field
/// as defined in `System` [Welford1986]. Ignores decentering and tilts. `blue` and `red` are the system at
/// the two wavelengths of the colour sums. For directions of 90 degrees and more, all members but S_I and C_I
/// are NaN.
///
/// A = n i is the index times the angle of incidence of the marginal ray (y, u), B that of the chief ray (Y,
/// U). H = n (u Y - U y) is the Lagrange invariant, c the vertex curvature, and dn the index at the blue
/// wavelength minus that at the red one. D(q) is the change of a quantity q at the surface:
///
///   S_I = -A^2 y D(u/n),   S_II = -A B y D(u/n),   S_III = -B^2 y D(u/n),   S_IV = -H^2 c D(1/n),
///   S_V = -B (B^2 y D(1/n^2) + (H - B y) Y c D(1/n)),   C_I = A y D(dn/n),   C_II = B y D(dn/n).
///
/// A surface that departs from its osculating sphere by G r^4 adds 8 G D(n) y^4 to S_I. It adds this times
/// Y/y to S_II, times (Y/y)^2 to S_III and times (Y/y)^3 to S_V.
[[nodiscard]] SeidelSums seidel_sums(const SystemAt& at, const SystemAt& blue, const SystemAt& red,
                                     double marginal_mm, double field);

}  // namespace abbe::lens
