#pragma once

#include <array>
#include <vector>

#include "materials/material.h"
#include "spectral/colorimetry.h"
#include "validation/goniometer/lobes.h"

namespace abbe {

/// How the bench looks at a material.
struct GoniometerSettings {
  std::vector<double> wavelengths_nm{450, 550, 650};
  std::vector<double> angles_deg{0, 15, 30, 45, 60, 75, 85};  ///< Of incidence, in [0, 90).
  bool from_inside = false;                                   ///< Against the normal.
  Curve illuminant;                                           ///< Relative, of the colours.
  Observer observer = Observer::cie1931;
  int samples = 1 << 13;  ///< Per angle and eight of `wavelengths_nm`.
};

/// A colour in the light of the bench.
struct ScatteredColor {
  XYZ xyz;         ///< Y = 100 for what sends on all of the beam.
  Lab lab;         ///< Relative to that.
  double Y_error;  ///< Standard error of Y; 0 where nothing needs to be sampled.
};

/// What a beam at one angle turns into.
struct GoniometerAngle {
  double angle_deg;
  std::vector<Estimate> reflected;    ///< Directional-hemispherical reflectance, by wavelength.
  std::vector<Estimate> transmitted;  ///< Directional-hemispherical transmittance, by wavelength.
  ScatteredColor reflected_color;     ///< Of the hemisphere's light.
  ScatteredColor transmitted_color;
  double sampling_p;       ///< Of chi-square, sampled against stated density; 1 where nothing spreads.
  double spread_integral;  ///< Of that density: the probability of leaving in no single direction.
};

/// What the bench found.
struct GoniometerReport {
  Lobes lobes;
  bool dispersive;
  std::vector<GoniometerAngle> angles;
  Asymmetry reciprocity;  ///< Of f(a, b) and f(b, a), by `reciprocity_error`.
  double most_energy;     ///< Largest R + T over angles and wavelengths.
};

/// Where the beam of an angle comes from: the side of -x.
[[nodiscard]] Imath::V3f incidence(const GoniometerSettings& settings, double angle_deg);
/// The wavelengths of a colorimetric sum.
[[nodiscard]] std::vector<double> visible_wavelengths();
/// The packet of up to eight of the wavelengths from the `first` on; the last one fills up.
[[nodiscard]] SampledSpectrum packet_of(const std::vector<double>& wavelengths_nm, std::size_t first);

[[nodiscard]] GoniometerReport measure(const Material& material, const GoniometerSettings& settings);

}  // namespace abbe
