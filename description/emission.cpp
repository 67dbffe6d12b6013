#include "description/emission.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/table_ends.h"
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
      {"radiant_flux_W", "W", "Power that the lamp sends out, of a surface from all its sides together."},
      {"luminous_flux_lm", "lm",
       "Luminous flux that the lamp sends out, of a surface from all its sides together."},
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
  return beside<AmountAt<quantity>>(text_of(quantity).key);
}

// One spectrum and at most one of the scales.
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
                          "blackbody:<K>, daylight:<K>, or "
                          "FILE.csv:COLUMN."),
        under<Blackbody>("blackbody_K", kBlackbody,
                         "Planck's spectral radiance [W/(m2 sr nm)], in the unit of `spectrum`."),
        under<Daylight>("daylight_K", kDaylight,
                        "CIE daylight of this correlated colour temperature, relative: needs a scale."),
        under<Spectrum>("spectrum",
                        "Spectral radiance [W/(m2 sr nm)], intensity [W/(sr nm)] of a point or spot, or "
                        "irradiance [W/(m2 nm)] of a directional light; 0 or more."),
        under<Lines>("lines", "Spectral lines, in the unit of a spectrum."), std::move(more)...);
  };
  return describe(name, text,
                  {has_flux ? sources(under<SpectralFlux>(
                                  "spectral_flux_W_per_nm",
                                  "What the lamp sends out at each wavelength [W/nm], 0 or more."))
                            : sources(),
                   at_most_one(scales, "an emission has one scale", std::move(scale)...),
                   field("polarised", polarised, "How its light is polarised; not at all when absent.")});
}

}  // namespace

static Fields fields(Tag<Polarisation>) {
  return describe(
      "polarised", "How the light of a lamp is polarised, at all wavelengths and in all directions.",
      {one_of(&Polarisation::kind,
              under<PolarisedAlong>("axis", direction(),
                                    "Linearly: the field swings along this direction of the scene, which "
                                    "stays where lamps move, as far as it lies across the way of the light."),
              under<CircularlyPolarised>("circular", word<Handedness>("handedness", {"left", "right"}),
                                         "Circularly: right is clockwise as the receiver sees it.")),
       defaulted("degree", &Polarisation::degree, Range::unit(), "Share of the light that is polarised.")});
}

template <Quantity quantity>
Fields fields(Tag<AmountAt<quantity>>) {
  using At = AmountAt<quantity>;
  return describe(
      "", "",
      {field(text_of(quantity).key, &At::amount, kPower.in(text_of(quantity).unit), text_of(quantity).text),
       field("distance", &At::distance, kLength,
             "Distance of that surface from the middle of the lamp, along its normal if it has one.")});
}

Fields fields(Tag<MeshEmission>) {
  return describe_emission<MeshEmission>("mesh_emission", "What each triangle sends out.", true,
                                         amount<Quantity::radiant_flux>(), amount<Quantity::luminous_flux>(),
                                         amount<Quantity::radiance>(), amount<Quantity::luminance>());
}
Fields fields(Tag<LampEmission>) {
  return describe_emission<LampEmission>(
      "lamp_emission", "What a surface sends out, the same radiance in all directions.", true,
      amount<Quantity::radiant_flux>(), amount<Quantity::luminous_flux>(), amount<Quantity::radiance>(),
      amount<Quantity::luminance>(), amount_at<Quantity::irradiance>(), amount_at<Quantity::illuminance>());
}
Fields fields(Tag<PointEmission>) {
  return describe_emission<PointEmission>(
      "point_emission", "What a point sends out.", true, amount<Quantity::radiant_flux>(),
      amount<Quantity::luminous_flux>(), amount<Quantity::intensity>(),
      amount<Quantity::luminous_intensity>(), amount_at<Quantity::irradiance>(),
      amount_at<Quantity::illuminance>());
}
Fields fields(Tag<BeamEmission>) {
  return describe_emission<BeamEmission>("beam_emission", "What comes from one direction.", false,
                                         amount<Quantity::irradiance>(), amount<Quantity::illuminance>());
}
Fields fields(Tag<SunEmission>) {
  return describe_emission<SunEmission>("sun_emission", "What a disc at infinity sends here.", false,
                                        amount<Quantity::radiance>(), amount<Quantity::luminance>(),
                                        amount<Quantity::irradiance>(), amount<Quantity::illuminance>());
}
Fields fields(Tag<SkyEmission>) {
  return describe_emission<SkyEmission>("sky_emission", "What comes from all directions.", false,
                                        amount<Quantity::radiance>(), amount<Quantity::luminance>());
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

constexpr bool is_luminous(spec::Quantity quantity) {
  return static_cast<int>(quantity) % 2 == 1;
}

/// How a spectrum is read, which is part of what makes it the same as another.
struct SpectrumUse {
  CurveUnit unit = CurveUnit::power;  ///< Of a table: of any power where its values are scaled.
  bool by_power = false;              ///< Whether it is scaled by its power over all wavelengths.

  [[nodiscard]] CurveUse curve() const { return {"illuminant", spec::kPower, unit, true}; }
};

/// The curve of each spectrum, as it is named.
struct SpectrumBuilder {
  LoadContext& context;
  const SpectrumUse& use;
  const SourcePosition& where;  ///< Of the emission.

  std::optional<Curve> operator()(std::monostate) const { return std::nullopt; }
  std::optional<Curve> operator()(const spec::Illuminant& said) const {
    const std::optional<std::string> name = context.table(said.value, said.where);
    if (!name) return std::nullopt;
    std::optional<NamedCurve> named =
        load_illuminant(*name, said.where, context.diagnostics, context.ends.needed);
    if (!named) return std::nullopt;
    named->name = said.value;
    return with_ends(*std::move(named), use.curve(), said.where, context.ends).curve;
  }
  std::optional<Curve> operator()(const spec::Blackbody& said) const { return planck(said.value); }
  std::optional<Curve> operator()(const spec::Daylight& said) const {
    return with_ends(named_daylight(said.value), use.curve(), where, context.ends).curve;
  }
  std::optional<Curve> operator()(const spec::Curve& said) const { return build(said, use.curve(), context); }
  std::optional<Curve> operator()(const spec::Lines& said) const { return description::build(said); }
};

// What is said of the spectrum alone, in one line.
std::string spectrum_text(const spec::Emission& emission) {
  spec::LampEmission unscaled;
  unscaled.spectrum = emission.spectrum;
  return to_text(schema::write(unscaled));
}

// The curve of a spectrum, with a word where tables of it end within what the sensor sees.
std::optional<Curve> build_curve(const spec::Emission& emission, const SpectrumUse& use,
                                 LoadContext& context) {
  std::vector<EndedTable> ended;
  context.ends.noted = &ended;
  std::optional<Curve> curve = std::visit(SpectrumBuilder{context, use, emission.where}, emission.spectrum);
  context.ends.noted = nullptr;
  if (!curve || ended.empty()) return curve;
  Diagnostics unheard;
  LoadContext on = going_on(context, unheard);
  if (const auto longer = std::visit(SpectrumBuilder{on, use, emission.where}, emission.spectrum))
    check_ends(ended, *longer, context.ends.channels, context);
  return curve;
}

// A lamp that is scaled by its power needs all of it.
std::optional<Curve> build_all_of(const spec::Emission& emission, const SpectrumUse& use,
                                  LoadContext& context) {
  if (!use.by_power) return build_curve(emission, use, context);
  const NeededRange seen = std::exchange(context.ends.needed, kEveryWavelength);
  std::optional<Curve> curve = build_curve(emission, use, context);
  context.ends.needed = seen;
  return curve;
}

/// Whether a lamp is scaled by its power over all wavelengths, and not by what the eye sees.
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

SpectrumUse use_of(const spec::Emission& emission, const LampKind& kind) {
  const bool scaled = !std::holds_alternative<std::monostate>(emission.scale);
  CurveUnit unit = CurveUnit::power;
  if (!scaled && std::holds_alternative<spec::Spectrum>(emission.spectrum)) unit = kind.spectrum;
  if (!scaled && std::holds_alternative<spec::SpectralFlux>(emission.spectrum))
    unit = CurveUnit::spectral_flux;
  return {unit, std::visit(IsByPower{}, emission.scale)};
}

// The same words name the same spectrum, which is made once however many lamps have it in the same use: a
// table that one can be scaled of need not be one for another.
LampSpectrum* build_spectrum(const spec::Emission& emission, const LampKind& kind, LoadContext& context) {
  const SpectrumUse use = use_of(emission, kind);
  const std::string words =
      fmt::format("{} {} {}", static_cast<int>(use.unit), use.by_power, spectrum_text(emission));
  if (const auto found = context.lamp_spectra.find(words); found != context.lamp_spectra.end())
    return &found->second;
  std::optional<Curve> curve = build_all_of(emission, use, context);
  if (!curve) return nullptr;
  const double power = curve->integral();
  const double luminous = photometric(*curve);
  return &context.lamp_spectra.emplace(words, LampSpectrum{std::move(*curve), power, luminous}).first->second;
}

constexpr int kLeastExponent = -1000;  // so that its inverse is finite

// A power of two keeps the digits of the first lamp, and all lamps within what a float holds.
ScaledCurve times(LampSpectrum& spectrum, double factor) {
  if (!spectrum.held) {
    spectrum.held_for = factor > 0 ? factor : 1;
    const Curve first = scaled(spectrum.curve, spectrum.held_for);
    (void)std::frexp(first.max(), &spectrum.exponent);
    spectrum.exponent = std::max(spectrum.exponent, kLeastExponent);
    spectrum.held = std::make_shared<const Curve>(scaled(first, std::ldexp(1.0, -spectrum.exponent)));
  }
  return {spectrum.held, std::ldexp(factor / spectrum.held_for, spectrum.exponent)};
}

/// A quantity that an emission is scaled to, and how much of it a lamp of unit radiance or intensity has.
struct Scale {
  spec::Quantity quantity;
  double value;
  double of_unit;
};

struct ScaleBuilder {
  const LampKind& kind;
  const SourcePosition& where;
  const LoadContext& context;

  [[nodiscard]] double of_unit(spec::Quantity quantity) const {
    using enum spec::Quantity;
    if (quantity == radiant_flux || quantity == luminous_flux) return kind.flux;
    return quantity == irradiance || quantity == illuminance ? kind.irradiance(0) : 1;
  }
  std::optional<Scale> operator()(std::monostate) const { return std::nullopt; }
  template <spec::Quantity quantity>
  std::optional<Scale> operator()(const spec::Amount<quantity>& said) const {
    return Scale{quantity, said.value, of_unit(quantity)};
  }
  template <spec::Quantity quantity>
  std::optional<Scale> operator()(const spec::AmountAt<quantity>& said) const {
    const double irradiance = kind.irradiance(said.distance * context.unit_m);
    if (irradiance > 0) return Scale{quantity, said.amount, irradiance};
    context.diagnostics.error(where,
                              fmt::format("lies within the lamp (got a distance of {})", said.distance));
    return std::nullopt;
  }
};

// What `spectrum` is multiplied by to have as much of a quantity as asked for.
std::optional<double> normaliser(const LampSpectrum& spectrum, const Scale& scale,
                                 const SourcePosition& where, const LoadContext& context) {
  const double unscaled = (is_luminous(scale.quantity) ? spectrum.luminous : spectrum.power) * scale.of_unit;
  if (unscaled > 0) return scale.value / unscaled;
  context.diagnostics.error(
      where, fmt::format("{} cannot scale this spectrum, which has none", spec::text_of(scale.quantity).key));
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
  LampSpectrum* spectrum = build_spectrum(emission, kind, context);
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

std::optional<LampPolarisation> polarisation_of(const spec::Emission& emission) {
  if (!emission.polarised) return std::nullopt;
  const auto degree = static_cast<float>(emission.polarised->degree);
  if (const auto* along = std::get_if<spec::PolarisedAlong>(&emission.polarised->kind))
    return LampPolarisation{degree, LinearPolarisation{Imath::V3f(along->value.normalized())}};
  const auto& circular = std::get<spec::CircularlyPolarised>(emission.polarised->kind);
  return LampPolarisation{degree, CircularPolarisation{circular.value == spec::Handedness::right}};
}

}  // namespace abbe::description
