#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include <ImathVec.h>

#include "description/curve.h"
#include "scene/lights/polarisation.h"
#include "spectral/scaled_curve.h"

namespace abbe::spec {

struct Illuminant : schema::Located<std::string> {};
struct Spectrum : Curve {};
struct SpectralFlux : Curve {};  ///< Spectral flux [W/nm].

/// Quantity to which an emission can be scaled. The even ones are radiometric; every other one is
/// photometric, weighted by the luminous efficiency function.
enum class Quantity {
  radiant_flux,
  luminous_flux,
  radiance,
  luminance,
  intensity,
  luminous_intensity,
  irradiance,
  illuminance
};
template <Quantity quantity>
struct Amount : schema::Value<double> {};
/// A quantity at a distance from the center of the light, in scene units.
template <Quantity quantity>
struct AmountAt {
  double amount = 0;
  double distance = 0;
};

struct PolarisedAlong : schema::Value<Imath::V3d> {};
enum class Handedness { left, right };
struct CircularlyPolarised : schema::Value<Handedness> {};
/// State of polarisation of the emitted light.
struct Polarisation {
  std::variant<std::monostate, PolarisedAlong, CircularlyPolarised> kind;
  double degree = 1;
};

/// Emission of a light: one spectrum and at most one quantity to which it is scaled.
struct Emission {
  std::variant<std::monostate, Illuminant, Blackbody, Daylight, Spectrum, Lines, SpectralFlux> spectrum;
  std::variant<std::monostate, Amount<Quantity::radiant_flux>, Amount<Quantity::luminous_flux>,
               Amount<Quantity::radiance>, Amount<Quantity::luminance>, Amount<Quantity::intensity>,
               Amount<Quantity::luminous_intensity>, Amount<Quantity::irradiance>,
               Amount<Quantity::illuminance>, AmountAt<Quantity::irradiance>, AmountAt<Quantity::illuminance>>
      scale;
  std::optional<Polarisation> polarised;
  SourcePosition where;
};
// One type for each set of quantities to which an emission can be scaled.
struct MeshEmission : Emission {};
struct AreaLightEmission : Emission {};  ///< Emission of a sphere, disc or quad.
struct PointEmission : Emission {};
struct DirectionalLightEmission : Emission {};
struct SunEmission : Emission {};
struct EnvironmentLightEmission : Emission {};
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
  CurveUnit spectrum;                 ///< Unit of a `spectrum` that is not scaled.
  double flux;  ///< Flux for unit radiance [m^2 sr] or unit intensity [sr]; 0 if the light has no flux.
  /// Irradiance at a distance [m] on the axis of the light, on a surface that faces it: for unit radiance
  /// [sr] or unit intensity [m^-2]. A light at infinity gives the same value at every distance.
  std::function<double(double)> irradiance = {};
};

/// Builds the emission spectrum of a light. Returns nothing after an error:
/// - a relative spectrum without a scale;
/// - a scale in a quantity of which the spectrum has none;
/// - a table without data at wavelengths that are needed.
/// Warns of a table that is 0 outside its range, if the channels of the sensor would record more than a
/// negligible fraction of such a light there.
[[nodiscard]] std::optional<ScaledCurve> build(const spec::Emission& emission, const LightKind& kind,
                                               LoadContext& context);
/// Polarisation of the emitted light; nothing if it is unpolarised.
[[nodiscard]] std::optional<LightPolarisation> polarisation_of(const spec::Emission& emission);

}  // namespace abbe::description
