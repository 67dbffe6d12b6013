#pragma once

#include <optional>
#include <span>
#include <string>

#include "develop/relight.h"
#include "io/image.h"
#include "scene/white.h"

namespace abbe {

/// The white of a film whose lights are to be scaled.
struct RelitWhite {
  std::optional<White> white;  ///< The new main light; empty if the film's white remains.
  std::string warning;         ///< A limitation of the pictures; empty if there is none.
};

/// The white after `relight` with these factors, for a film that still has its layers of lights. A film shows
/// its main light as white; lights of one colour count together, within the pilot's noise. The white remains
/// in these cases:
/// - the scene requests it;
/// - it is not that of the brightest light in the film, as may happen in a crop;
/// - its light remains the brightest.
/// Factors of planes change the contribution of a light, not its recorded colour. Throws as `relight`.
[[nodiscard]] RelitWhite relit_white(const Image& film, std::span<const LightFactor> factors);

}  // namespace abbe
