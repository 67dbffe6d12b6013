#pragma once

#include "materials/interface/microfacet.h"

namespace abbe {

/// Both distributions of facets.
inline constexpr FacetShape kFacetShapes[] = {FacetShape::ggx, FacetShape::beckmann};

}  // namespace abbe
