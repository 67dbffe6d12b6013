#pragma once

#include "materials/interface/microfacet.h"

namespace abbe {

/// Both slope distributions.
inline constexpr FacetShape kFacetShapes[] = {FacetShape::ggx, FacetShape::beckmann};

}  // namespace abbe
