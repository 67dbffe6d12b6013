#pragma once

#include <cstdint>
#include <string>

#include "validation/bench/soak/scene.h"

namespace abbe::soak {

/// What came of a scene.
struct Outcome {
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;
  std::string failure;  ///< What is wrong, or empty.
};

/// Loads and renders the scene, twice, and looks whether anything is wrong: a refusal, a sample that is not
/// finite, a negative value where no response is negative, light from beyond a closed box, other bits when
/// the samples are rendered in two ranges by another number of threads, other values in a crop, or a
/// floating-point exception in the code that renders. Exceptions are watched from then on, so the process
/// should end soon after.
[[nodiscard]] Outcome check(const DrawnScene& drawn);

}  // namespace abbe::soak
