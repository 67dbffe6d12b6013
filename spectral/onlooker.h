#pragma once

#include "spectral/colorimetry.h"

namespace abbe {

/// Who sees the colours of a film.
struct Onlooker {
  Observer observer = Observer::cie1931;
};

/// Chromaticity of a light as it is seen; not finite for a light that is not.
[[nodiscard]] Chromaticity chromaticity(const Curve& light, const Onlooker& onlooker);

}  // namespace abbe
