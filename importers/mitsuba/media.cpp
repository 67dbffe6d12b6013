#include "importers/mitsuba/media.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "importers/mitsuba/spectra.h"

namespace abbe::importers::mitsuba {

namespace {

using Phase = decltype(spec::Scattering::phase);

Phase phase_of(const Object& medium, const ImportState& state) {
  const auto phases = medium.all("phase");
  if (phases.empty()) return std::nullopt;
  const Object phase(*phases.front(), state);
  if (phase.type() == "hg") return {{{spec::HenyeyGreenstein{phase.number("g", 0.8)}}, phase.where()}};
  if (phase.type() == "rayleigh") return {{{spec::PhaseWord::rayleigh}, phase.where()}};
  if (phase.type() != "isotropic")
    state.importer.note(
        phase.where(),
        fmt::format("a phase function \"{}\" is not supported: isotropic scattering is used", phase.type()));
  return std::nullopt;
}

// The product of a dimensionless factor and an extinction coefficient, each a number or a spectrum.
spec::Curve product_of(const Spectrum& fraction, const Spectrum& extinction, const SourcePosition& where,
                       const ImportState& state) {
  if (const auto* number = std::get_if<double>(&fraction))
    return curve_of(scaled(extinction, *number), where, state.importer);
  if (const auto* number = std::get_if<double>(&extinction))
    return curve_of(scaled(fraction, *number), where, state.importer);
  spec::Curve curve;
  curve.where = where;
  const std::vector<spec::Curve> factors{curve_of(fraction, where, state.importer),
                                         curve_of(extinction, where, state.importer)};
  curve.value = spec::CurveFormula{spec::Product{{factors}}};
  return curve;
}

// 1 - samples. It is 1 outside the range if the samples are 0 there.
Samples one_minus(Samples fraction) {
  for (double& value : fraction.values) value = 1 - value;
  return extend_constant(std::move(fraction), 1);
}

// 1 - fraction.
Spectrum one_minus(const Spectrum& fraction) {
  if (const auto* rgb = std::get_if<LinearRgb>(&fraction))
    return LinearRgb{1 - (*rgb)[0], 1 - (*rgb)[1], 1 - (*rgb)[2]};
  if (const auto* samples = std::get_if<Samples>(&fraction)) return one_minus(*samples);
  return 1 - number_of(fraction).value_or(0);
}

}  // namespace

spec::Medium medium_of(const Object& medium, const ImportState& state) {
  spec::Medium result;
  state.importer.note_medium(medium.where());
  if (medium.type() != "homogeneous") {
    state.importer.note(
        medium.where(),
        fmt::format("a medium \"{}\" is not supported: replaced by an empty one", medium.type()));
    return result;
  }
  const Spectrum albedo = spectrum(medium, "albedo", 0.75, state);
  const Spectrum extinction = scaled(spectrum(medium, "sigma_t", 1.0, state), medium.number("scale", 1));
  result.absorption_per_m = product_of(one_minus(albedo), extinction, medium.where(), state);
  result.scattering.per_m = product_of(albedo, extinction, medium.where(), state);
  result.scattering.phase = phase_of(medium, state);
  medium.ignore({"sample_emitters", "has_spectral_extinction"});
  medium.note_unused();
  return result;
}

}  // namespace abbe::importers::mitsuba
