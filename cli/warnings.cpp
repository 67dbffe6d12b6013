#include "cli/warnings.h"

#include <string>

#include <fmt/format.h>

#include "cli/answer.h"
#include "film/rendered_film.h"
#include "io/error.h"
#include "scene/dark_enclosure.h"
#include "transport/plan/plan.h"

namespace abbe::cli {
namespace {

void warn(const std::string& message, bool is_error) {
  if (is_error) throw Error(ErrorCode::scene, "", message);
  say("warning: " + message);
}

}  // namespace

void warn_of_lost_light(const Scene& scene, bool strict) {
  const auto lost = unreached(scene, scene.needs, uses(chosen_techniques(scene), Technique::light));
  if (lost.empty()) return;
  const bool chosen = scene.render.integrator != Integrator::automatic;
  const std::string by =
      chosen ? fmt::format("integrator \"{}\" does not reach", integrator_name(scene.render.integrator))
             : "no technique reaches";
  warn(fmt::format("light that {} is missing: {}", by, fmt::join(lost, "; ")), strict && chosen);
}

void warn_of_dark_camera(const Scene& scene, bool strict) {
  if (const auto shape = dark_enclosure(scene))
    warn(fmt::format("the camera stands within \"{}\", which is opaque and has no light inside",
                     scene.shapes[*shape].name),
         strict);
}

void note_polarisation(const Needs& needs) {
  if (!needs.polarisation_matters) return;
  say(fmt::format(
      "polarisation is not carried, which matters after {}: it takes 0.3 % of the light off a prism of "
      "N-BK7, 3 % of N-SF11, more where mirrors cross (docs/physics/conventions.md)",
      needs.because.at("polarisation_matters")));
}

}  // namespace abbe::cli
