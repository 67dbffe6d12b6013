#pragma once

#include "io/json_values.h"

namespace abbe {

/// How thick the films of coatings may be; nothing thicker is coherent.
inline constexpr Range kFilmThickness{0, 1e5, true, false, "nm"};

}  // namespace abbe
