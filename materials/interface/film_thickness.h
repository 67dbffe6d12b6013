#pragma once

#include "io/json_values.h"

namespace abbe {

/// Allowed thickness of a thin film: above 0 and at most 1e5 nm. Thicker layers are not coherent.
inline constexpr Range kFilmThickness{0, 1e5, true, false, "nm"};

}  // namespace abbe
