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
struct SpectralFlux : Curve {};  ///< [W/nm]

/// What a lamp may be scaled to; every other one is weighed by what the eye sees.
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
/// At a distance from the middle of the lamp.
template <Quantity quantity>
struct AmountAt {
  double amount = 0;
  double distance = 0;
};

struct PolarisedAlong : schema::Value<Imath::V3d> {};
enum class Handedness { left, right };
struct CircularlyPolarised : schema::Value<Handedness> {};
/// How the light of a lamp is polarised.
struct Polarisation {
  std::variant<std::monostate, PolarisedAlong, CircularlyPolarised> kind;
  double degree = 1;
};

/// What a lamp sends out: one spectrum, and at most one quantity that it is scaled to.
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
// Emissions by what they may be scaled to.
struct MeshEmission : Emission {};
struct LampEmission : Emission {};  ///< Of a sphere, disc or quad.
struct PointEmission : Emission {};
struct BeamEmission : Emission {};
struct SunEmission : Emission {};
struct SkyEmission : Emission {};
[[nodiscard]] schema::Fields fields(schema::Tag<MeshEmission>);
[[nodiscard]] schema::Fields fields(schema::Tag<LampEmission>);
[[nodiscard]] schema::Fields fields(schema::Tag<PointEmission>);
[[nodiscard]] schema::Fields fields(schema::Tag<BeamEmission>);
[[nodiscard]] schema::Fields fields(schema::Tag<SunEmission>);
[[nodiscard]] schema::Fields fields(schema::Tag<SkyEmission>);

}  // namespace abbe::spec

namespace abbe::description {

/// What fixes the strength of a lamp of one kind: the table of its emission, what a spectrum that is not
/// scaled is of, and what a lamp of unit radiance or intensity has of each quantity.
struct LampKind {
  const schema::Fields& (*fields)();
  CurveUnit spectrum;
  double flux;  ///< [m^2 sr] for radiance, [sr] for intensity; 0 without a flux.
  /// Irradiance on its axis at that distance [m], of a surface that faces it: [sr] for radiance, [m^-2] for
  /// intensity. Of what is at infinity the same at every distance.
  std::function<double(double)> irradiance = {};
};

/// The spectrum of the lamp. Reports a relative spectrum without a scale, a scale that it has nothing of, and
/// a table that says nothing of wavelengths that are needed; nothing then. Warns of one that is 0 where
/// channels of the sensor count more than a negligible share of such a light.
[[nodiscard]] std::optional<ScaledCurve> build(const spec::Emission& emission, const LampKind& kind,
                                               LoadContext& context);
/// How its light is polarised; nothing where it is not.
[[nodiscard]] std::optional<LampPolarisation> polarisation_of(const spec::Emission& emission);

}  // namespace abbe::description
