#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace abbe {

/// Chandrasekhar's function H(mu) of an isotropically scattering medium [Chandrasekhar1960, sec. 33].
/// H(mu) = 1/(sqrt(1 - albedo) + albedo/2 int_0^1 m H(m)/(mu + m) dm), iterated on the nodes of the midpoint
/// rule.
/// A semi-infinite layer below a uniform sky, viewed at cosine mu to its normal, has 1 - H(mu) sqrt(1 -
/// albedo) times the radiance of that sky.
class ChandrasekharH {
 public:
  /// Computes H on 400 nodes in 100 iterations. `albedo` in [0, 1) is the ratio of scattering to extinction.
  explicit ChandrasekharH(double albedo);

  /// H at a cosine `mu` in [0, 1]; at least 1.
  [[nodiscard]] double operator()(double mu) const;

 private:
  [[nodiscard]] double node(std::size_t i) const;

  double albedo_;
  std::vector<double> h_;
};

/// Homogeneous medium with coefficients [1/m]. The argument of the phase function [1/sr] is the cosine
/// between the directions of travel before and after scattering: 1 for forward scattering.
struct HomogeneousMedium {
  double scattering;
  double extinction;
  std::function<double(double)> phase;
};

/// Single-scattering radiance [W m^-2 sr^-1 nm^-1] along a line of sight at distance h [m] from a point light
/// of intensity 1 W/(sr nm) [Chandrasekhar1960, sec. 7]:
/// scattering int phase(-x/r) exp(-extinction (x + before + r))/r^2 dx, with r = sqrt(x^2 + h^2).
/// x is the distance along the line from the foot of the light, positive away from the camera. The integral
/// extends from `before` metres in front of the foot to `after` metres behind it. Light is attenuated
/// from its source to x, and from x to the near end.
[[nodiscard]] double single_scattering_radiance(const HomogeneousMedium& medium, double h, double before,
                                                double after);

}  // namespace abbe
