#pragma once

#include <string>

#include "description/doors/pbrt/world.h"

namespace abbe::doors::pbrt {

/// The homogeneous matter of that name; an unknown name is reported, other matter noted and left empty.
[[nodiscard]] spec::Medium medium_of(const std::string& name, const SourcePosition& where, World& world);

}  // namespace abbe::doors::pbrt
