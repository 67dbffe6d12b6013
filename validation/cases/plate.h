#pragma once

#include <cmath>
#include <numbers>

#include "materials/interface/fresnel.h"

namespace abbe {

/// Power transmittance and reflectance of a plate, with all internal reflections [Born1999, sec. 7.6].
struct Plate {
  double transmittance;
  double reflectance;
};

/// Plate whose faces both reflect the fraction `r` < 1. `internal` is the transmittance of one crossing.
[[nodiscard]] inline Plate plate_of(double r, double internal) {
  const double loop = 1 - r * r * internal * internal;
  return {(1 - r) * (1 - r) * internal / loop, r + (1 - r) * (1 - r) * r * internal * internal / loop};
}

/// Plate of index `n` relative to its surroundings, in unpolarised light: the mean of s and p, which do not
/// mix at parallel faces. `angle_deg` is the angle of incidence in [0, 90). `internal` is the transmittance
/// of one crossing at that angle.
[[nodiscard]] inline Plate plate(double angle_deg, double n, double internal) {
  const FresnelPower<double> face = fresnel_dielectric(std::cos(angle_deg * std::numbers::pi / 180), n);
  const Plate s = plate_of(face.Rs, internal);
  const Plate p = plate_of(face.Rp, internal);
  return {(s.transmittance + p.transmittance) / 2, (s.reflectance + p.reflectance) / 2};
}

/// Fraction of unpolarised light that enters clear glass, is reflected inside `bounces` times and then
/// leaves. It is the mean of (1 - R)^2 R^bounces over s and p. All faces reflect as `face`: those of a plate,
/// or the points of a ball that a ray hits.
[[nodiscard]] inline double transmittance_after_bounces(const FresnelPower<double>& face, int bounces) {
  const auto fraction = [&](double r) { return (1 - r) * (1 - r) * std::pow(r, bounces); };
  return (fraction(face.Rs) + fraction(face.Rp)) / 2;
}

}  // namespace abbe
