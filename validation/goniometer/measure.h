#pragma once

#include <array>
#include <vector>

#include "materials/material.h"
#include "spectral/colorimetry.h"
#include "validation/goniometer/lobes.h"

namespace abbe {

/// Settings of the BSDF bench.
struct GoniometerSettings {
  std::vector<double> wavelengths_nm{450, 550, 650};
  std::vector<double> angles_deg{0, 15, 30, 45, 60, 75, 85};  ///< Angles of incidence in [0, 90).
  bool from_inside = false;  ///< If true, the beam arrives from the side opposite to the normal.
  Curve illuminant;          ///< Relative spectrum for the colours.
  Observer observer = Observer::cie1931;
  int samples = 1 << 13;  ///< Samples per angle and packet of eight wavelengths.
};

/// Colour of scattered light under the bench's illuminant.
struct ScatteredColor {
  XYZ xyz;         ///< Y = 100 for a material that scatters all of the beam.
  Lab lab;         ///< L*a*b* relative to that white.
  double Y_error;  ///< Standard error of Y; 0 for a material with delta events only.
};

/// Scattering of a beam at one angle of incidence.
struct GoniometerAngle {
  double angle_deg;
  std::vector<Estimate> reflected;    ///< Directional-hemispherical reflectance by wavelength.
  std::vector<Estimate> transmitted;  ///< Directional-hemispherical transmittance by wavelength.
  ScatteredColor reflected_color;     ///< Colour of the light in the hemisphere.
  ScatteredColor transmitted_color;
  /// p-value of the chi-square test of the samples against the pdf; 1 for delta events only.
  double sampling_p;
  double non_delta_probability;  ///< Integral of the pdf: the probability of an event that is not delta.
};

/// Results of the BSDF bench.
struct GoniometerReport {
  Lobes lobes;
  bool dispersive;
  std::vector<GoniometerAngle> angles;
  Asymmetry reciprocity;  ///< Result of `reciprocity_error`.
  double max_albedo;      ///< Largest reflectance plus transmittance over angles and wavelengths.
};

/// Direction of the incident beam's source; its azimuth is that of -x.
[[nodiscard]] Imath::V3f incidence(const GoniometerSettings& settings, double angle_deg);
/// Wavelengths [nm] of a colorimetric sum, in steps of 1 nm.
[[nodiscard]] std::vector<double> visible_wavelengths();
/// Up to eight of the wavelengths from index `first` on. The last wavelength fills an incomplete packet.
[[nodiscard]] SampledSpectrum packet_of(const std::vector<double>& wavelengths_nm, std::size_t first);

[[nodiscard]] GoniometerReport measure(const Material& material, const GoniometerSettings& settings);

}  // namespace abbe
