#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "description/curve.h"
#include "spectral/scaled_curve.h"

namespace abbe::spec {

struct Illuminant : schema::Located<std::string> {};
struct Spectrum : Curve {};
struct SpectralFlux : Curve {};  ///< [W/nm]

struct RadiantFlux : schema::Value<double> {};        ///< [W]
struct LuminousFlux : schema::Value<double> {};       ///< [lm]
struct Radiance : schema::Value<double> {};           ///< [W/(m^2 sr)]
struct Luminance : schema::Value<double> {};          ///< [cd/m^2]
struct Intensity : schema::Value<double> {};          ///< [W/sr]
struct LuminousIntensity : schema::Value<double> {};  ///< [cd]
struct Irradiance : schema::Value<double> {};         ///< [W/m^2]
struct Illuminance : schema::Value<double> {};        ///< [lx]
/// At a distance from the middle of the lamp.
struct IrradianceAt {
  double irradiance = 0;
  double distance = 0;
};
struct IlluminanceAt {
  double illuminance = 0;
  double distance = 0;
};

/// What a lamp sends out: one spectrum, and at most one quantity that it is scaled to.
struct Emission {
  std::variant<std::monostate, Illuminant, Blackbody, Daylight, Spectrum, Lines, SpectralFlux> spectrum;
  std::variant<std::monostate, RadiantFlux, LuminousFlux, Radiance, Luminance, Intensity, LuminousIntensity,
               Irradiance, Illuminance, IrradianceAt, IlluminanceAt>
      scale;
  SourcePosition where;
};
// Emissions by what they may be scaled to.
struct MeshEmission : Emission {};
struct LampEmission : Emission {};  ///< Of a sphere, disc or quad.
struct PointEmission : Emission {};
struct BeamEmission : Emission {};
struct SunEmission : Emission {};
struct SkyEmission : Emission {};
[[nodiscard]] const schema::Fields& fields(schema::Tag<MeshEmission>);
[[nodiscard]] const schema::Fields& fields(schema::Tag<LampEmission>);
[[nodiscard]] const schema::Fields& fields(schema::Tag<PointEmission>);
[[nodiscard]] const schema::Fields& fields(schema::Tag<BeamEmission>);
[[nodiscard]] const schema::Fields& fields(schema::Tag<SunEmission>);
[[nodiscard]] const schema::Fields& fields(schema::Tag<SkyEmission>);

}  // namespace abbe::spec

namespace abbe::description {

/// What fixes the strength of a lamp of one kind: the table of its emission, and what a lamp of unit radiance
/// or intensity has of each quantity.
struct LampKind {
  const schema::Fields& (*fields)();
  double flux;  ///< [m^2 sr] for radiance, [sr] for intensity; 0 without a flux.
  /// Irradiance on its axis at that distance [m], of a surface that faces it: [sr] for radiance, [m^-2] for
  /// intensity. Of what is at infinity the same at every distance.
  std::function<double(double)> irradiance = {};
};

/// The spectrum of the lamp. Reports a relative spectrum without a scale, and a scale that it has nothing of;
/// nothing then.
[[nodiscard]] std::optional<ScaledCurve> build(const spec::Emission& emission, const LampKind& kind,
                                               LoadContext& context);

}  // namespace abbe::description
