#pragma once

#include <cmath>
#include <numbers>

#include "materials/interface/fresnel.h"

namespace abbe {

/// Transmittance and reflectance of a plate with all its internal bounces [Born1999, sec. 7.6].
struct Plate {
  double transmittance;
  double reflectance;
};

/// Of light for which either face reflects `r`, `internal` being the transmittance of one crossing.
[[nodiscard]] inline Plate plate_of(double r, double internal) {
  const double loop = 1 - r * r * internal * internal;
  return {(1 - r) * (1 - r) * internal / loop, r + (1 - r) * (1 - r) * r * internal * internal / loop};
}

/// Of unpolarised light: the mean of s and p, which each keep to themselves from face to face.
[[nodiscard]] inline Plate plate(double angle_deg, double n, double internal) {
  const FresnelPower<double> face = fresnel_dielectric(std::cos(angle_deg * std::numbers::pi / 180), n);
  const Plate s = plate_of(face.Rs, internal);
  const Plate p = plate_of(face.Rp, internal);
  return {(s.transmittance + p.transmittance) / 2, (s.reflectance + p.reflectance) / 2};
}

/// Of unpolarised light the share that comes through both faces of clear glass after `bounces` reflections
/// within, s and p kept apart: the mean of (1 - R)^2 R^bounces.
[[nodiscard]] inline double through_after(const FresnelPower<double>& face, int bounces) {
  const auto share = [&](double r) { return (1 - r) * (1 - r) * std::pow(r, bounces); };
  return (share(face.Rs) + share(face.Rp)) / 2;
}

}  // namespace abbe
