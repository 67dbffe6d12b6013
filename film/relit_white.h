#pragma once

#include <optional>
#include <span>
#include <string>

#include "develop/relight.h"
#include "io/image.h"
#include "scene/white.h"

namespace abbe {

/// What pictures of a film show as white once its lights count other than they did.
struct RelitWhite {
  std::optional<White> white;  ///< The main light that is left; nothing where the film's white stays.
  std::string shortcoming;     ///< What pictures lack then, empty where they lack nothing.
};

/// That of a film that still has its layers of lights, before `relight`. A film shows its main light as
/// white: lights of one colour count together, within the pilot's noise. A white that its scene asks for
/// stays, as does one that is not that of the light which gives the film most, as of a crop, and that of a
/// light which goes on giving most. The factors of planes change what a light gives and not the colour that
/// it is known by. Throws as `relight` does.
[[nodiscard]] RelitWhite relit_white(const Image& film, std::span<const LightFactor> factors);

}  // namespace abbe
