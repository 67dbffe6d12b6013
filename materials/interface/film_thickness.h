#pragma once

#include "io/json_values.h"

namespace abbe {

/// Allowed thickness of a thin film. Thicker layers are not coherent.
inline constexpr Range kFilmThickness{0, 1e5, true, false, "nm"};

}  // namespace abbe
