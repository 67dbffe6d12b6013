#pragma once

#include "scene/shapes/shape.h"

namespace abbe {

/// Whether a face of one shape may lie in a face of the other: parallel, no further from its plane than
/// `reach` [m], and their boxes meet; or both shapes are the same sphere. Other curved surfaces touch in
/// points at most. It may, too, where either shape moves, or where so many faces meet that comparing them
/// would take seconds.
[[nodiscard]] bool may_coincide(const Shape& a, const Shape& b, double reach);

}  // namespace abbe
