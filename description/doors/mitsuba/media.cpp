#include "description/doors/mitsuba/media.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/doors/mitsuba/spectra.h"

namespace abbe::doors::mitsuba {

namespace {

using Phase = decltype(spec::Scattering::phase);

Phase phase_of(const Object& medium, const World& world) {
  const auto phases = medium.all("phase");
  if (phases.empty()) return std::nullopt;
  const Object phase(*phases.front(), world);
  if (phase.type() == "hg") return {{{spec::HenyeyGreenstein{phase.number("g", 0.8)}}, phase.where()}};
  if (phase.type() == "rayleigh") return {{{spec::PhaseWord::rayleigh}, phase.where()}};
  if (phase.type() != "isotropic")
    world.door.note(phase.where(),
                    fmt::format("a phase function \"{}\" has no counterpart here: isotropic", phase.type()));
  return std::nullopt;
}

// A product of a share and something with wavelengths, either of which may be a number.
spec::Curve product_of(const Spectrum& share, const Spectrum& extinction, const SourcePosition& where,
                       const World& world) {
  if (const auto* number = std::get_if<double>(&share))
    return curve_of(scaled(extinction, *number), where, world.door);
  if (const auto* number = std::get_if<double>(&extinction))
    return curve_of(scaled(share, *number), where, world.door);
  spec::Curve curve;
  curve.where = where;
  const std::vector<spec::Curve> factors{curve_of(share, where, world.door),
                                         curve_of(extinction, where, world.door)};
  curve.value = spec::CurveFormula{spec::Product{{factors}}};
  return curve;
}

// What samples leave of 1: all of it where these are 0 beyond their ends.
Samples rest_of(Samples share) {
  for (double& value : share.values) value = 1 - value;
  return held(std::move(share), 1);
}

// What of a share is left of 1.
Spectrum rest_of(const Spectrum& share) {
  if (const auto* rgb = std::get_if<LinearRgb>(&share))
    return LinearRgb{1 - (*rgb)[0], 1 - (*rgb)[1], 1 - (*rgb)[2]};
  if (const auto* samples = std::get_if<Samples>(&share)) return rest_of(*samples);
  return 1 - number_of(share).value_or(0);
}

}  // namespace

spec::Medium medium_of(const Object& medium, const World& world) {
  spec::Medium matter;
  world.door.note_medium(medium.where());
  if (medium.type() != "homogeneous") {
    world.door.note(medium.where(),
                    fmt::format("a medium \"{}\" has no counterpart here: empty", medium.type()));
    return matter;
  }
  const Spectrum albedo = spectrum(medium, "albedo", 0.75, world);
  const Spectrum extinction = scaled(spectrum(medium, "sigma_t", 1.0, world), medium.number("scale", 1));
  matter.absorption_per_m = product_of(rest_of(albedo), extinction, medium.where(), world);
  matter.scattering.per_m = product_of(albedo, extinction, medium.where(), world);
  matter.scattering.phase = phase_of(medium, world);
  medium.ignore({"sample_emitters", "has_spectral_extinction"});
  medium.note_unused();
  return matter;
}

}  // namespace abbe::doors::mitsuba
