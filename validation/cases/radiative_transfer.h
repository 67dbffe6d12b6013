#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace abbe {

/// Chandrasekhar's function H(mu) of an isotropically scattering medium [Chandrasekhar1960, sec. 33].
/// H(mu) = 1/(sqrt(1 - albedo) + albedo/2 int_0^1 m H(m)/(mu + m) dm), iterated on the nodes of the midpoint
/// rule.
/// A semi-infinite layer below a uniform sky, viewed at cosine mu, has 1 - H(mu) sqrt(1 - albedo) times the
/// radiance of that sky.
class ChandrasekharH {
 public:
  explicit ChandrasekharH(double albedo);

  [[nodiscard]] double operator()(double mu) const;
  /// Mean over mu from 0 to 1. Exact up to rounding: 2/albedo (1 - sqrt(1 - albedo)).
  [[nodiscard]] double mean() const;

 private:
  [[nodiscard]] double node(std::size_t i) const;

  double albedo_;
  std::vector<double> h_;
};

/// Homogeneous medium: scattering and extinction coefficients [1/m], and the phase function [1/sr] of the
/// cosine between the directions of the light before and after scattering.
struct HomogeneousMedium {
  double scattering;
  double extinction;
  std::function<double(double)> phase;
};

/// Single-scattering radiance [W m^-2 sr^-1 nm^-1] along a line of sight at distance h [m] from a point light
/// of intensity 1 W/(sr nm) [Chandrasekhar1960, sec. 7]:
/// scattering int phase exp(-extinction (x + before + r))/r^2 dx, with r = sqrt(x^2 + h^2).
/// The medium extends along the line from `before` metres in front of the foot of the light, on the camera's
/// side, to `after` metres behind it.
[[nodiscard]] double single_scattering_radiance(const HomogeneousMedium& medium, double h, double before,
                                                double after);

}  // namespace abbe
