#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include <ImathVec.h>

#include "description/curve.h"
#include "scene/lights/light.h"
#include "spectral/curve.h"

namespace abbe::spec {

// Emissions of lights as scene files describe them.

/// Name of a relative spectrum, which needs a scale: a table of `data/illuminant`, "blackbody:<K>",
/// "daylight:<K>" or "FILE.csv:COLUMN".
struct Illuminant : schema::Located<std::string> {};
/// Spectrum of 0 or more. Without a scale its unit depends on the light: spectral radiance [W/(m2 sr nm)],
/// intensity [W/(sr nm)] of a point or spot, or irradiance [W/(m2 nm)] of a directional light.
struct Spectrum : Curve {};
struct SpectralFlux : Curve {};  ///< Spectral flux [W/nm].

/// Quantity to which an emission can be scaled. Even values are radiometric, over 300 to 1100 nm; odd values
/// are photometric. A flux is that of all sides of a light together. Irradiance and illuminance are those of
/// a surface that faces the light.
enum class Quantity {
  radiant_flux,        ///< [W]
  luminous_flux,       ///< [lm]
  radiance,            ///< [W/(m2 sr)]
  luminance,           ///< [cd/m2]
  intensity,           ///< [W/sr]
  luminous_intensity,  ///< [cd]
  irradiance,          ///< [W/m2]
  illuminance          ///< [lx]
};
/// A value of a quantity, 0 or more, in its unit above.
template <Quantity quantity>
struct Amount : schema::Value<double> {};
/// Irradiance or illuminance at a distance from the center of the light, along its normal if it has one.
template <Quantity quantity>
struct AmountAt {
  double amount = 0;    ///< [W/m2] or [lx]
  double distance = 0;  ///< [scene units]
};

/// Linear polarisation: the electric field oscillates along the projection of this direction perpendicular to
/// the ray. The direction is in scene coordinates and has any length except 0.
struct PolarisedAlong : schema::Value<Imath::V3d> {};
/// Sense of circular polarisation: `right` is clockwise as the receiver sees the field.
enum class Handedness { left, right };
struct CircularlyPolarised : schema::Value<Handedness> {};
/// State of polarisation of the emitted light.
struct Polarisation {
  std::variant<std::monostate, PolarisedAlong, CircularlyPolarised> kind;
  double degree = 1;  ///< Degree of polarisation, in [0, 1].
};

/// Emission of a light: one spectrum and at most one quantity to which it is scaled. `std::monostate` as the
/// scale means that the spectrum is absolute.
struct Emission {
  std::variant<std::monostate, Illuminant, Blackbody, Daylight, Spectrum, Lines, SpectralFlux> spectrum;
  std::variant<std::monostate, Amount<Quantity::radiant_flux>, Amount<Quantity::luminous_flux>,
               Amount<Quantity::radiance>, Amount<Quantity::luminance>, Amount<Quantity::intensity>,
               Amount<Quantity::luminous_intensity>, Amount<Quantity::irradiance>,
               Amount<Quantity::illuminance>, AmountAt<Quantity::irradiance>, AmountAt<Quantity::illuminance>>
      scale;
  std::optional<Polarisation> polarised;  ///< Unpolarised if absent.
  SourcePosition where;
};
// One type for each set of quantities to which an emission can be scaled.
struct MeshEmission : Emission {};
struct AreaLightEmission : Emission {};  ///< Emission of a sphere, disc or quad.
struct PointEmission : Emission {};      ///< Emission of a point or spot.
struct DirectionalLightEmission : Emission {};
struct SunEmission : Emission {};  ///< Emission of a disc at infinity.
struct EnvironmentLightEmission : Emission {};
// Key tables.
[[nodiscard]] schema::Fields fields(schema::Tag<MeshEmission>);
[[nodiscard]] schema::Fields fields(schema::Tag<AreaLightEmission>);
[[nodiscard]] schema::Fields fields(schema::Tag<PointEmission>);
[[nodiscard]] schema::Fields fields(schema::Tag<DirectionalLightEmission>);
[[nodiscard]] schema::Fields fields(schema::Tag<SunEmission>);
[[nodiscard]] schema::Fields fields(schema::Tag<EnvironmentLightEmission>);

}  // namespace abbe::spec

namespace abbe::description {

/// Relations between radiance or intensity and the other quantities, for one kind of light.
struct LightKind {
  const schema::Fields& (*fields)();  ///< Key table of its emission, for messages.
  CurveUnit spectrum;                 ///< Unit of a `spec::Spectrum` that is not scaled.
  double flux;  ///< Flux for unit radiance [m^2 sr] or unit intensity [sr]; 0 if the light has no flux.
  /// Irradiance at a distance [m] from the center, on the axis of the light, on a surface that faces it. It
  /// is given for unit radiance [sr] or unit intensity [m^-2], and 0 inside the light. A light at infinity
  /// has the same value at every distance. Empty for a light that no irradiance can scale. An intensity that
  /// scales the light is that along the axis: the irradiance at 1 m times 1 m^2.
  std::function<double(double)> irradiance = {};
};

/// Builds the emission spectrum of a light of the given kind: spectral radiance [W/(m2 sr nm)], intensity
/// [W/(sr nm)] of a point or spot, or irradiance [W/(m2 nm)] of a directional light. Appends to
/// `context.emission_positions`. Reports errors to `context.diagnostics` and returns nothing after one:
/// - a relative spectrum without a scale;
/// - a scale in a quantity of which the spectrum has none;
/// - a distance inside the light;
/// - a table without data at wavelengths that are needed.
/// Warns of a table that is 0 outside its range, if the channels of the sensor would record more than a
/// negligible fraction of such a light there.
[[nodiscard]] std::optional<ScaledCurve> build(const spec::Emission& emission, const LightKind& kind,
                                               LoadContext& context);
/// Polarisation of the emitted light; nothing if it is unpolarised.
[[nodiscard]] std::optional<LightPolarisation> polarisation_of(const spec::Emission& emission);

}  // namespace abbe::description
