#pragma once

#include <string>

#include "materials/index/refractive_index.h"
#include "spectral/library.h"

namespace abbe {

/// A refractive index with its name and source.
struct NamedIndex {
  std::string name;
  std::string source;  ///< Text that identifies the origin of the data.
  RefractiveIndex index;
};

/// No wavelength range is required of an index table: RefractiveIndex extrapolates n and reports the range of
/// its data.
inline constexpr NeededRange kAnyWavelength{kMaxWavelengthNm, kMinWavelengthNm};

}  // namespace abbe
