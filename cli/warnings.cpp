#include "cli/warnings.h"

#include <string>

#include <fmt/format.h>

#include "cli/answer.h"
#include "film/shortcomings.h"
#include "io/error.h"

namespace abbe::cli {
namespace {

void warn(const std::string& message, bool is_error) {
  if (is_error) throw Error(ErrorCode::scene, "", message);
  say("warning: " + message);
}

}  // namespace

void warn_of_lost_light(const Scene& scene, bool strict) {
  if (const auto lost = lost_light(scene)) warn(*lost, strict);
}

void warn_of_dark_camera(const Scene& scene, bool strict) {
  if (const auto dark = dark_camera(scene)) warn(*dark, strict);
}

void note_polarisation(const Needs& needs) {
  if (!needs.polarisation_matters) return;
  say(fmt::format(
      "polarisation is not carried, which matters after {}: it takes 0.3 % of the light off a prism of "
      "N-BK7, 3 % of N-SF11, more where mirrors cross (docs/physics/conventions.md)",
      needs.because.at("polarisation_matters")));
}

}  // namespace abbe::cli
