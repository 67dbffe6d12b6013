#pragma once

#include <cmath>
#include <numbers>

#include "materials/interface/fresnel.h"

namespace abbe {

/// Transmittance and reflectance of a plate, including all internal reflections [Born1999, sec. 7.6].
struct Plate {
  double transmittance;
  double reflectance;
};

/// Plate whose faces both reflect `r`. `internal` is the transmittance of one crossing.
[[nodiscard]] inline Plate plate_of(double r, double internal) {
  const double loop = 1 - r * r * internal * internal;
  return {(1 - r) * (1 - r) * internal / loop, r + (1 - r) * (1 - r) * r * internal * internal / loop};
}

/// Plate of index n in unpolarised light: the mean of s and p, which do not mix at parallel faces.
[[nodiscard]] inline Plate plate(double angle_deg, double n, double internal) {
  const FresnelPower<double> face = fresnel_dielectric(std::cos(angle_deg * std::numbers::pi / 180), n);
  const Plate s = plate_of(face.Rs, internal);
  const Plate p = plate_of(face.Rp, internal);
  return {(s.transmittance + p.transmittance) / 2, (s.reflectance + p.reflectance) / 2};
}

/// Fraction of unpolarised light that leaves clear glass through its second face after `bounces` internal
/// reflections. It is the mean of (1 - R)^2 R^bounces over s and p.
[[nodiscard]] inline double transmittance_after_bounces(const FresnelPower<double>& face, int bounces) {
  const auto fraction = [&](double r) { return (1 - r) * (1 - r) * std::pow(r, bounces); };
  return (fraction(face.Rs) + fraction(face.Rp)) / 2;
}

}  // namespace abbe
