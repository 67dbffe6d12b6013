#pragma once

#include <string>
#include <vector>

#include "io/image.h"
#include "materials/material.h"
#include "spectral/colorimetry.h"
#include "validation/goniometer/lobes.h"

namespace abbe {

struct GoniometerSettings {
  std::vector<double> wavelengths_nm{450, 550, 650};          ///< At least one.
  std::vector<double> angles_deg{0, 15, 30, 45, 60, 75, 85};  ///< Angles of incidence in [0, 90).
  bool from_inside = false;  ///< If true, the beam arrives from the side opposite to the normal.
  Curve illuminant;          ///< Relative spectrum for the colours.
  Observer observer = Observer::cie1931;
  int samples = 1 << 13;  ///< Samples per angle, packet of eight wavelengths and hero.
};

/// Colour of scattered light under the bench's illuminant.
struct ScatteredColor {
  XYZ xyz;         ///< Y = 100 for a material that scatters all of the beam.
  Lab lab;         ///< L*a*b* relative to that white.
  double Y_error;  ///< Standard error of Y; 0 for a material with delta events only.
};

/// Scattering of a beam at one angle of incidence.
struct GoniometerAngle {
  double angle_deg;                   ///< Angle of incidence, from the normal on the side of the beam.
  std::vector<Estimate> reflected;    ///< Directional-hemispherical reflectance by wavelength.
  std::vector<Estimate> transmitted;  ///< Directional-hemispherical transmittance by wavelength.
  ScatteredColor reflected_color;     ///< Colour of all light in the hemisphere of the beam.
  ScatteredColor transmitted_color;   ///< Colour of all light in the other hemisphere.
  /// p-value of the chi-square test of the samples against the pdf; 1 for delta events only.
  double sampling_p;
  double non_delta_probability;  ///< Integral of the pdf: the probability of an event that is not delta.
};

/// Results of the BSDF bench.
struct GoniometerReport {
  Lobes lobes;
  bool dispersive;                      ///< True if a refractive index varies with wavelength.
  std::vector<GoniometerAngle> angles;  ///< In the order of the settings.
  Asymmetry reciprocity;                ///< Result of `reciprocity_error` for the first eight wavelengths.
  double max_albedo;  ///< Largest reflectance plus transmittance over angles and wavelengths.
};

/// Wavelengths [nm] of a colorimetric sum (`SumRange`), in steps of 1 nm.
[[nodiscard]] std::vector<double> visible_wavelengths();

/// Measures a material at all angles and wavelengths of the settings. Equal arguments give equal results.
[[nodiscard]] GoniometerReport measure(const Material& material, const GoniometerSettings& settings);

/// Map of the scattered light: channels R, G and B of sRGB code values in [0, 1]. Each angle of incidence
/// has a column of 96 x 192 pixels: the upper disc is the hemisphere of the incident beam, which comes from
/// the left, the lower disc the other one, in equal-area projections. Colours are those of f |cos|, with
/// the cosine of the scattered direction, under the illuminant, scaled to the largest channel of the
/// column. Delta directions are not drawn.
[[nodiscard]] Image lobe_map(const Material& material, const GoniometerSettings& settings);

/// SVG document with a polar plot in the plane of incidence for each angle of `report`, which was measured
/// for `material` with `settings`. The beam comes from the left. The radius of a curve is the square root
/// of f |cos| [1/sr] relative to the largest value of its panel, with a curve per wavelength. A thick line
/// marks a delta direction at the first wavelength; its length is the square root of the fraction of power.
/// A swatch shows the colour of all reflected light.
[[nodiscard]] std::string lobe_plot(const Material& material, const GoniometerSettings& settings,
                                    const GoniometerReport& report, const std::string& title);

}  // namespace abbe
