#include "importers/pbrt/media.h"

#include <fmt/format.h>

#include "importers/pbrt/spectra.h"

namespace abbe::importers::pbrt {

spec::Medium medium_of(const std::string& name, const SourcePosition& where, ImportState& state) {
  spec::Medium medium;
  const Directive* directive = find(state.media, "medium", name, where, state.importer);
  if (directive == nullptr) return medium;
  state.importer.note_medium(directive->where);
  const Parameters& p = directive->parameters;
  if (directive->type != "homogeneous") {
    state.importer.note(
        directive->where,
        fmt::format("a medium \"{}\" is not supported: replaced by an empty one", directive->type));
    return medium;
  }
  if (p.has("preset"))
    state.importer.note(directive->where, "presets of media are not supported: pbrt's defaults are used");
  p.ignore({"preset"});
  const double scale = p.number("scale", 1, state.importer);
  // pbrt's defaults, per unit of length.
  const LinearRgb absorption{0.0011, 0.0024, 0.014};
  const LinearRgb scattering{2.55, 3.21, 3.77};
  medium.absorption_per_m =
      curve_of(scaled(spectrum(p, "sigma_a", absorption, state), scale), directive->where, state.importer);
  medium.scattering.per_m =
      curve_of(scaled(spectrum(p, "sigma_s", scattering, state), scale), directive->where, state.importer);
  const double g = p.number("g", 0, state.importer);
  if (g != 0) medium.scattering.phase = {{spec::HenyeyGreenstein{g}}, directive->where};
  if (p.has("Le")) state.importer.note(directive->where, "emission of media is not supported: dropped");
  p.ignore({"Le", "Lescale"});
  p.note_unused("medium", state.importer);
  return medium;
}

}  // namespace abbe::importers::pbrt
