#include "description/emission.h"

#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/schema/write.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"

namespace abbe::description {
namespace {

/// The curve of each spectrum, as it is named.
struct SpectrumBuilder {
  LoadContext& context;

  std::optional<Curve> operator()(std::monostate) const { return std::nullopt; }
  std::optional<Curve> operator()(const spec::Illuminant& said) const {
    const std::optional<std::string> name = context.table(said.value, said.where);
    if (!name) return std::nullopt;
    std::optional<NamedCurve> named = load_illuminant(*name, said.where, context.diagnostics);
    if (!named) return std::nullopt;
    return std::move(named->curve);
  }
  std::optional<Curve> operator()(const spec::Blackbody& said) const { return planck(said.value); }
  std::optional<Curve> operator()(const spec::Daylight& said) const { return daylight(said.value); }
  std::optional<Curve> operator()(const spec::Curve& said) const {
    return build(said, {"illuminant", spec::kPower}, context);
  }
  std::optional<Curve> operator()(const spec::Lines& said) const { return build(said); }
};

// What is said of the spectrum alone, in one line.
std::string spectrum_text(const spec::Emission& emission) {
  spec::LampEmission unscaled;
  unscaled.spectrum = emission.spectrum;
  return to_text(schema::write(unscaled));
}

// The same words name the same spectrum, which is made once however many lamps have it.
LampSpectrum* build_spectrum(const spec::Emission& emission, LoadContext& context) {
  const std::string words = spectrum_text(emission);
  if (const auto found = context.lamp_spectra.find(words); found != context.lamp_spectra.end())
    return &found->second;
  std::optional<Curve> curve = std::visit(SpectrumBuilder{context}, emission.spectrum);
  if (!curve) return nullptr;
  const double power = curve->integral();
  const double luminous = photometric(*curve);
  return &context.lamp_spectra.emplace(words, LampSpectrum{std::move(*curve), power, luminous}).first->second;
}

// A power of two keeps the digits of the first lamp, and all lamps within what a float holds.
ScaledCurve times(LampSpectrum& spectrum, double factor) {
  if (!spectrum.held) {
    spectrum.held_for = factor > 0 ? factor : 1;
    const Curve first = scaled(spectrum.curve, spectrum.held_for);
    (void)std::frexp(first.max(), &spectrum.exponent);
    spectrum.held = std::make_shared<const Curve>(scaled(first, std::ldexp(1.0, -spectrum.exponent)));
  }
  return {spectrum.held, std::ldexp(factor / spectrum.held_for, spectrum.exponent)};
}

/// A quantity that an emission is scaled to, and how much of it a lamp of unit radiance or intensity has.
struct Scale {
  std::string_view name;
  bool luminous;
  double value;
  double of_unit;
};

struct ScaleBuilder {
  const LampKind& kind;
  const SourcePosition& where;
  const LoadContext& context;

  [[nodiscard]] std::optional<Scale> at(std::string_view name, bool luminous, double value,
                                        double distance) const {
    const double of_unit = kind.irradiance(distance * context.unit_m);
    if (of_unit > 0) return Scale{name, luminous, value, of_unit};
    context.diagnostics.error(where, fmt::format("lies within the lamp (got a distance of {})", distance));
    return std::nullopt;
  }
  std::optional<Scale> operator()(std::monostate) const { return std::nullopt; }
  std::optional<Scale> operator()(const spec::RadiantFlux& said) const {
    return Scale{"radiant_flux_W", false, said.value, kind.flux};
  }
  std::optional<Scale> operator()(const spec::LuminousFlux& said) const {
    return Scale{"luminous_flux_lm", true, said.value, kind.flux};
  }
  std::optional<Scale> operator()(const spec::Radiance& said) const {
    return Scale{"radiance", false, said.value, 1};
  }
  std::optional<Scale> operator()(const spec::Luminance& said) const {
    return Scale{"luminance", true, said.value, 1};
  }
  std::optional<Scale> operator()(const spec::Intensity& said) const {
    return Scale{"intensity", false, said.value, 1};
  }
  std::optional<Scale> operator()(const spec::LuminousIntensity& said) const {
    return Scale{"luminous_intensity", true, said.value, 1};
  }
  std::optional<Scale> operator()(const spec::Irradiance& said) const {
    return Scale{"irradiance", false, said.value, kind.irradiance(0)};
  }
  std::optional<Scale> operator()(const spec::Illuminance& said) const {
    return Scale{"illuminance", true, said.value, kind.irradiance(0)};
  }
  std::optional<Scale> operator()(const spec::IrradianceAt& said) const {
    return at("irradiance", false, said.irradiance, said.distance);
  }
  std::optional<Scale> operator()(const spec::IlluminanceAt& said) const {
    return at("illuminance", true, said.illuminance, said.distance);
  }
};

// What `spectrum` is multiplied by to have as much of a quantity as asked for.
std::optional<double> normaliser(const LampSpectrum& spectrum, const Scale& scale,
                                 const SourcePosition& where, const LoadContext& context) {
  const double unscaled = (scale.luminous ? spectrum.luminous : spectrum.power) * scale.of_unit;
  if (unscaled > 0) return scale.value / unscaled;
  context.diagnostics.error(where, fmt::format("{} cannot scale this spectrum, which has none", scale.name));
  return std::nullopt;
}

// The keys of the scales that a table knows.
std::vector<std::string_view> scale_names(const schema::Fields& fields) {
  std::vector<std::string_view> names;
  for (const schema::Field& field : fields.fields)
    if (const auto* group = std::get_if<schema::OneOf>(field.part.get()); group && !group->required)
      for (const schema::Choice& choice : group->choices) names.push_back(choice.key);
  return names;
}

}  // namespace

std::optional<ScaledCurve> build(const spec::Emission& emission, const LampKind& kind, LoadContext& context) {
  context.emissions.push_back(emission.where);
  LampSpectrum* spectrum = build_spectrum(emission, context);
  const bool illuminant = std::holds_alternative<spec::Illuminant>(emission.spectrum);
  const bool relative = illuminant || std::holds_alternative<spec::Daylight>(emission.spectrum);
  const bool scaled = !std::holds_alternative<std::monostate>(emission.scale);
  if (!scaled && relative)
    context.diagnostics.error(
        emission.where,
        fmt::format("{} is a relative spectrum and needs a scale, one of {}",
                    illuminant ? "illuminant" : "daylight_K", fmt::join(scale_names(kind.fields()), ", ")));
  const auto scale = std::visit(ScaleBuilder{kind, emission.where, context}, emission.scale);
  if (!spectrum || (!scaled && relative) || (scaled && !scale)) return std::nullopt;
  if (!scaled)
    return times(*spectrum,
                 std::holds_alternative<spec::SpectralFlux>(emission.spectrum) ? 1 / kind.flux : 1);
  const std::optional<double> factor = normaliser(*spectrum, *scale, emission.where, context);
  if (!factor) return std::nullopt;
  return times(*spectrum, *factor);
}

}  // namespace abbe::description
