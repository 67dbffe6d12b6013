#include "description/doors/pbrt/media.h"

#include <fmt/format.h>

#include "description/doors/pbrt/spectra.h"

namespace abbe::doors::pbrt {

spec::Medium medium_of(const std::string& name, const SourcePosition& where, World& world) {
  spec::Medium medium;
  const Made* made = find(world.media, "medium", name, where, world.door);
  if (made == nullptr) return medium;
  world.door.note_medium(made->where);
  const Parameters& p = made->parameters;
  if (made->type != "homogeneous") {
    world.door.note(made->where, fmt::format("a medium \"{}\" has no counterpart here: empty", made->type));
    return medium;
  }
  if (p.has("preset")) world.door.note(made->where, "a medium's preset is not known here: its defaults");
  p.ignore({"preset"});
  const double scale = p.number("scale", 1, world.door);
  // The defaults of a medium, per unit of length.
  const LinearRgb absorption{0.0011, 0.0024, 0.014};
  const LinearRgb scattering{2.55, 3.21, 3.77};
  medium.absorption_per_m =
      curve_of(scaled(spectrum(p, "sigma_a", absorption, world), scale), made->where, world.door);
  medium.scattering.per_m =
      curve_of(scaled(spectrum(p, "sigma_s", scattering, world), scale), made->where, world.door);
  const double g = p.number("g", 0, world.door);
  if (g != 0) medium.scattering.phase = {{spec::HenyeyGreenstein{g}}, made->where};
  if (p.has("Le")) world.door.note(made->where, "a medium does not emit here: its light is dropped");
  p.ignore({"Le", "Lescale"});
  p.note_unused("medium", world.door);
  return medium;
}

}  // namespace abbe::doors::pbrt
