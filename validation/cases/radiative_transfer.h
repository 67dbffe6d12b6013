#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace abbe {

/// H(mu) = 1/(sqrt(1 - albedo) + albedo/2 int_0^1 m H(m)/(mu + m) dm) of matter that scatters evenly,
/// iterated on midpoints [Chandrasekhar1960, sec. 33]. A layer without end below an even sky looks 1 - H(mu)
/// sqrt(1 - albedo) times as bright as that under the cosine mu.
class ChandrasekharH {
 public:
  explicit ChandrasekharH(double albedo);

  [[nodiscard]] double operator()(double mu) const;
  /// Over mu from 0 to 1: 2/albedo (1 - sqrt(1 - albedo)), but for rounding.
  [[nodiscard]] double mean() const;

 private:
  [[nodiscard]] double node(std::size_t i) const;

  double albedo_;
  std::vector<double> h_;
};

/// Even matter: scattering and extinction coefficients [1/m], and the phase function [1/sr] of the cosine
/// between the ways of the light before and after.
struct EvenMatter {
  double scattering;
  double extinction;
  std::function<double(double)> phase;
};

/// [W m^-2 sr^-1 nm^-1] of light scattered once on the way from a point of intensity 1 [W/(sr nm)] at
/// distance h beside a line of sight, in even matter on that line from `before` to `after` metres off the
/// foot of the lamp, the former nearer to the camera: scattering int phase exp(-extinction (x + before +
/// r))/r^2 dx [Chandrasekhar1960, sec. 7].
[[nodiscard]] double scattered_once(const EvenMatter& matter, double h, double before, double after);

}  // namespace abbe
