#pragma once

#include <optional>
#include <string>

#include "scene/lights/light.h"
#include "spectral/colorimetry.h"

namespace abbe {

/// What pictures of a film show as white.
struct White {
  std::string name;                    ///< Of a light, an illuminant or its file, or the chromaticity.
  std::string reason;                  ///< Why it is this one.
  Chromaticity xy{};                   ///< No numbers for a light that nobody sees.
  std::optional<Curve> spectrum = {};  ///< Of the light; nothing for what lights nothing.
};

/// The white of a light: the chromaticity of its mean emission.
[[nodiscard]] White white_of(const Light& light, std::string reason);

}  // namespace abbe
