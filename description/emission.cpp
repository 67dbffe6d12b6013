#include "description/emission.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/load_context.h"
#include "io/schema/write.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"

namespace abbe::spec {
namespace {

using namespace schema;

struct QuantityText {
  std::string_view key;
  std::string_view unit;
  std::string_view text;
};
constexpr QuantityText text_of(Quantity quantity) {
  constexpr std::array<QuantityText, 8> kTexts{{
      {"radiant_flux_W", "W", "Power that the light emits; for a surface, from all its sides together."},
      {"luminous_flux_lm", "lm",
       "Luminous flux that the light emits; for a surface, from all its sides together."},
      {"radiance", "W/(m2 sr)", "Radiance over 300-1100 nm."},
      {"luminance", "cd/m2", "Luminance."},
      {"intensity", "W/sr", "Intensity over 300-1100 nm."},
      {"luminous_intensity", "cd", "Luminous intensity."},
      {"irradiance", "W/m2", "Irradiance of a surface that faces the light, over 300-1100 nm."},
      {"illuminance", "lx", "Illuminance of a surface that faces the light."},
  }};
  return kTexts.at(static_cast<std::size_t>(quantity));
}

template <Quantity quantity>
auto amount() {
  return under<Amount<quantity>>(text_of(quantity).key, kPower.in(text_of(quantity).unit),
                                 text_of(quantity).text);
}
template <Quantity quantity>
auto amount_at() {
  return inlined_by<AmountAt<quantity>>(text_of(quantity).key);
}

// Key table of an emission: one spectrum and at most one of the scales.
template <typename E, typename... Choices>
Fields describe_emission(std::string_view name, std::string_view text, bool has_flux, Choices... scale) {
  decltype(Emission::spectrum) E::*spectrum = &Emission::spectrum;
  decltype(Emission::scale) E::*scales = &Emission::scale;
  decltype(Emission::polarised) E::*polarised = &Emission::polarised;
  const auto sources = [&](auto... more) {
    return one_of(
        spectrum,
        under<Illuminant>("illuminant",
                          "A relative spectrum, which needs a scale: a name of data/illuminant, "
                          "blackbody:<K>, daylight:<K>, or FILE.csv:COLUMN."),
        under<Blackbody>("blackbody_K", kBlackbody,
                         "Planck's spectral radiance [W/(m2 sr nm)], in the unit of `spectrum`."),
        under<Daylight>(
            "daylight_K", kDaylight,
            "Relative spectrum of CIE daylight of this correlated colour temperature; needs a scale."),
        under<Spectrum>("spectrum",
                        "Spectral radiance [W/(m2 sr nm)], intensity [W/(sr nm)] of a point or spot, or "
                        "irradiance [W/(m2 nm)] of a directional light; 0 or more."),
        under<Lines>("lines", "Spectral lines, in the unit of a spectrum."), std::move(more)...);
  };
  return describe(
      name, text,
      {has_flux ? sources(under<SpectralFlux>("spectral_flux_W_per_nm",
                                              "Spectral flux of the light [W/nm], 0 or more."))
                : sources(),
       at_most_one(scales, "an emission has one scale", std::move(scale)...),
       field("polarised", polarised, "Polarisation of the emitted light; unpolarised if absent.")});
}

}  // namespace

static Fields fields(Tag<Polarisation>) {
  return describe(
      "polarised", "Polarisation of the emitted light, the same at all wavelengths and in all directions.",
      {one_of(&Polarisation::kind,
              under<PolarisedAlong>(
                  "axis", direction(),
                  "Linear: the electric field oscillates along the projection of this scene direction "
                  "perpendicular to the ray. The direction does not follow a moving light."),
              under<CircularlyPolarised>("circular", enumeration<Handedness>("handedness", {"left", "right"}),
                                         "Circular: right is clockwise as seen by the receiver.")),
       defaulted("degree", &Polarisation::degree, Range::unit(), "Degree of polarisation, in [0, 1].")});
}

template <Quantity quantity>
Fields fields(Tag<AmountAt<quantity>>) {
  using At = AmountAt<quantity>;
  return describe(
      "", "",
      {field(text_of(quantity).key, &At::amount, kPower.in(text_of(quantity).unit), text_of(quantity).text),
       field("distance", &At::distance, kLength,
             "Distance of that surface from the center of the light, along its normal if it has one.")});
}

Fields fields(Tag<MeshEmission>) {
  return describe_emission<MeshEmission>("mesh_emission", "Emission of each triangle.", true,
                                         amount<Quantity::radiant_flux>(), amount<Quantity::luminous_flux>(),
                                         amount<Quantity::radiance>(), amount<Quantity::luminance>());
}
Fields fields(Tag<AreaLightEmission>) {
  return describe_emission<AreaLightEmission>(
      "surface_emission", "Emission of a surface, with the same radiance in all directions.", true,
      amount<Quantity::radiant_flux>(), amount<Quantity::luminous_flux>(), amount<Quantity::radiance>(),
      amount<Quantity::luminance>(), amount_at<Quantity::irradiance>(), amount_at<Quantity::illuminance>());
}
Fields fields(Tag<PointEmission>) {
  return describe_emission<PointEmission>(
      "point_emission", "Emission of a point.", true, amount<Quantity::radiant_flux>(),
      amount<Quantity::luminous_flux>(), amount<Quantity::intensity>(),
      amount<Quantity::luminous_intensity>(), amount_at<Quantity::irradiance>(),
      amount_at<Quantity::illuminance>());
}
Fields fields(Tag<DirectionalLightEmission>) {
  return describe_emission<DirectionalLightEmission>(
      "directional_emission", "Emission of a directional light.", false, amount<Quantity::irradiance>(),
      amount<Quantity::illuminance>());
}
Fields fields(Tag<SunEmission>) {
  return describe_emission<SunEmission>("sun_emission", "Emission of a disc at infinity.", false,
                                        amount<Quantity::radiance>(), amount<Quantity::luminance>(),
                                        amount<Quantity::irradiance>(), amount<Quantity::illuminance>());
}
Fields fields(Tag<EnvironmentLightEmission>) {
  return describe_emission<EnvironmentLightEmission>(
      "environment_emission", "Emission of an environment light.", false, amount<Quantity::radiance>(),
      amount<Quantity::luminance>());
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

constexpr bool is_luminous(spec::Quantity quantity) {
  return static_cast<int>(quantity) % 2 == 1;
}

/// Interpretation of a spectrum. Two emissions with the same text and interpretation have the same spectrum.
struct SpectrumUse {
  CurveUnit unit = CurveUnit::power;  ///< Allowed unit of a table; any power if its values are scaled.
  bool by_power = false;              ///< True if it is scaled by its power over all wavelengths.

  [[nodiscard]] CurveUse curve() const { return {"illuminant", spec::kPower, unit, true}; }
};

/// Builds the curve of each kind of spectrum, before scaling.
struct SpectrumBuilder {
  LoadContext& context;
  const SpectrumUse& use;
  const SourcePosition& where;  ///< Position of the emission.

  std::optional<Curve> operator()(std::monostate) const { return std::nullopt; }
  std::optional<Curve> operator()(const spec::Illuminant& spec) const {
    const std::optional<std::string> name = context.table(spec.value, spec.where);
    if (!name) return std::nullopt;
    std::optional<NamedCurve> named =
        load_illuminant(*name, spec.where, context.diagnostics, context.coverage.needed);
    if (!named) return std::nullopt;
    named->name = spec.value;
    return with_extrapolation(*std::move(named), use.curve(), spec.where, context.coverage).curve;
  }
  std::optional<Curve> operator()(const spec::Blackbody& spec) const { return planck(spec.value); }
  std::optional<Curve> operator()(const spec::Daylight& spec) const {
    return with_extrapolation(named_daylight(spec.value), use.curve(), where, context.coverage).curve;
  }
  std::optional<Curve> operator()(const spec::Curve& spec) const { return build(spec, use.curve(), context); }
  std::optional<Curve> operator()(const spec::Lines& spec) const { return description::build(spec); }
};

// Text of the spectrum alone, in one line.
std::string spectrum_text(const spec::Emission& emission) {
  spec::AreaLightEmission unscaled;
  unscaled.spectrum = emission.spectrum;
  return to_text(schema::write(unscaled));
}

// Builds the curve of a spectrum, and reports tables that end within the range of the sensor.
std::optional<Curve> build_curve(const spec::Emission& emission, const SpectrumUse& use,
                                 LoadContext& context) {
  std::vector<PartialTable> partial_tables;
  context.coverage.partial_tables = &partial_tables;
  std::optional<Curve> curve = std::visit(SpectrumBuilder{context, use, emission.where}, emission.spectrum);
  context.coverage.partial_tables = nullptr;
  if (!curve || partial_tables.empty()) return curve;
  Diagnostics discarded;
  LoadContext extrapolating = extrapolating_context(context, discarded);
  if (const auto extrapolated =
          std::visit(SpectrumBuilder{extrapolating, use, emission.where}, emission.spectrum))
    check_table_range(partial_tables, *extrapolated, context.coverage.channels, context);
  return curve;
}

// Builds the curve of a spectrum. A light that is scaled by its power needs data at all wavelengths.
std::optional<Curve> build_over_needed_range(const spec::Emission& emission, const SpectrumUse& use,
                                             LoadContext& context) {
  if (!use.by_power) return build_curve(emission, use, context);
  const NeededRange needed = std::exchange(context.coverage.needed, kEveryWavelength);
  std::optional<Curve> curve = build_curve(emission, use, context);
  context.coverage.needed = needed;
  return curve;
}

/// True for a scale in a radiometric quantity, which is the power over all wavelengths.
struct IsByPower {
  bool operator()(std::monostate) const { return false; }
  template <spec::Quantity quantity>
  bool operator()(const spec::Amount<quantity>&) const {
    return !is_luminous(quantity);
  }
  template <spec::Quantity quantity>
  bool operator()(const spec::AmountAt<quantity>&) const {
    return !is_luminous(quantity);
  }
};

SpectrumUse use_of(const spec::Emission& emission, const LightKind& kind) {
  const bool scaled = !std::holds_alternative<std::monostate>(emission.scale);
  CurveUnit unit = CurveUnit::power;
  if (!scaled && std::holds_alternative<spec::Spectrum>(emission.spectrum)) unit = kind.spectrum;
  if (!scaled && std::holds_alternative<spec::SpectralFlux>(emission.spectrum))
    unit = CurveUnit::spectral_flux;
  return {unit, std::visit(IsByPower{}, emission.scale)};
}

// Spectra with the same text and use are built once, however many lights have them. A table that is valid if
// scaled need not be valid otherwise, so the use is part of the key.
SharedLightSpectrum* build_spectrum(const spec::Emission& emission, const LightKind& kind,
                                    LoadContext& context) {
  const SpectrumUse use = use_of(emission, kind);
  const std::string words =
      fmt::format("{} {} {}", static_cast<int>(use.unit), use.by_power, spectrum_text(emission));
  if (const auto found = context.light_spectra.find(words); found != context.light_spectra.end())
    return &found->second;
  std::optional<Curve> curve = build_over_needed_range(emission, use, context);
  if (!curve) return nullptr;
  const double power = curve->integral();
  const double luminous = photometric(*curve);
  return &context.light_spectra.emplace(words, SharedLightSpectrum{std::move(*curve), power, luminous})
              .first->second;
}

constexpr int kMinExponent = -1000;  // Ensures that the inverse power of two is finite.

// Scale of a light as a multiple of the normalised curve. The power of two preserves the digits of the first
// light, and all lights stay within the range of single precision.
ScaledCurve times(SharedLightSpectrum& spectrum, double factor) {
  if (!spectrum.normalised) {
    spectrum.reference_factor = factor > 0 ? factor : 1;
    const Curve first = scaled(spectrum.curve, spectrum.reference_factor);
    (void)std::frexp(first.max(), &spectrum.exponent);
    spectrum.exponent = std::max(spectrum.exponent, kMinExponent);
    spectrum.normalised = std::make_shared<const Curve>(scaled(first, std::ldexp(1.0, -spectrum.exponent)));
  }
  return {spectrum.normalised, std::ldexp(factor / spectrum.reference_factor, spectrum.exponent)};
}

/// Quantity to which an emission is scaled, with its value for unit radiance or intensity.
struct Scale {
  spec::Quantity quantity;
  double value;
  double per_unit;
};

struct ScaleBuilder {
  const LightKind& kind;
  const SourcePosition& where;
  const LoadContext& context;

  [[nodiscard]] double per_unit(spec::Quantity quantity) const {
    using enum spec::Quantity;
    if (quantity == radiant_flux || quantity == luminous_flux) return kind.flux;
    if (quantity == intensity || quantity == luminous_intensity) return kind.irradiance(1);
    return quantity == irradiance || quantity == illuminance ? kind.irradiance(0) : 1;
  }
  std::optional<Scale> operator()(std::monostate) const { return std::nullopt; }
  template <spec::Quantity quantity>
  std::optional<Scale> operator()(const spec::Amount<quantity>& spec) const {
    return Scale{quantity, spec.value, per_unit(quantity)};
  }
  template <spec::Quantity quantity>
  std::optional<Scale> operator()(const spec::AmountAt<quantity>& spec) const {
    const double irradiance = kind.irradiance(spec.distance * context.unit_m);
    if (irradiance > 0) return Scale{quantity, spec.amount, irradiance};
    context.diagnostics.error(where,
                              fmt::format("the distance lies inside the light (got {})", spec.distance));
    return std::nullopt;
  }
};

// Factor that scales `spectrum` to the requested quantity. Reports a spectrum whose quantity is 0.
std::optional<double> normaliser(const SharedLightSpectrum& spectrum, const Scale& scale,
                                 const SourcePosition& where, const LoadContext& context) {
  const double unscaled = (is_luminous(scale.quantity) ? spectrum.luminous : spectrum.power) * scale.per_unit;
  if (unscaled > 0) return scale.value / unscaled;
  context.diagnostics.error(
      where, fmt::format("{} cannot scale this spectrum: its value is 0", spec::text_of(scale.quantity).key));
  return std::nullopt;
}

// Keys of the scales of an emission table.
std::vector<std::string_view> scale_names(const schema::Fields& fields) {
  std::vector<std::string_view> names;
  for (const schema::Field& field : fields.fields)
    if (const auto* group = std::get_if<schema::OneOf>(field.content.get()); group && !group->required)
      for (const schema::Choice& choice : group->choices) names.push_back(choice.key);
  return names;
}

}  // namespace

std::optional<ScaledCurve> build(const spec::Emission& emission, const LightKind& kind,
                                 LoadContext& context) {
  context.emission_positions.push_back(emission.where);
  SharedLightSpectrum* spectrum = build_spectrum(emission, kind, context);
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

std::optional<LightPolarisation> polarisation_of(const spec::Emission& emission) {
  if (!emission.polarised) return std::nullopt;
  const auto degree = static_cast<float>(emission.polarised->degree);
  if (const auto* along = std::get_if<spec::PolarisedAlong>(&emission.polarised->kind))
    return LightPolarisation{degree, LinearPolarisation{Imath::V3f(along->value.normalized())}};
  const auto& circular = std::get<spec::CircularlyPolarised>(emission.polarised->kind);
  return LightPolarisation{degree, CircularPolarisation{circular.value == spec::Handedness::right}};
}

}  // namespace abbe::description
