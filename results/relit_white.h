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
  /// A limitation of the pictures, or the reason for an unknown white; empty if there is none.
  std::string warning;
};

/// The white after `relight` with these factors, for a film that still has its layers of lights. A film shows
/// its main light as white; lights of one colour count together, within the pilot's noise. The white remains
/// in these cases:
/// - the scene requests it;
/// - it is not that of the light with the largest contribution to the film, as may happen in a crop;
/// - its light still has the largest contribution;
/// - the film does not record the colour of the new main light.
/// Factors of planes change the contribution of a light, not its recorded colour. Throws Error{usage} as
/// `relight`.
[[nodiscard]] RelitWhite relit_white(const Image& film, std::span<const LightFactor> factors);

}  // namespace abbe
