#pragma once

#include <string>

#include "materials/index/refractive_index.h"
#include "spectral/library.h"

namespace abbe {

/// A refractive index with its identity.
struct NamedIndex {
  std::string name;
  std::string source;
  RefractiveIndex index;
};

/// An index may be asked for at any wavelength: RefractiveIndex holds n beyond a table, and says where that
/// begins.
inline constexpr NeededRange kAnyWavelength{kMaxWavelengthNm, kMinWavelengthNm};

}  // namespace abbe
