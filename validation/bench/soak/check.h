#pragma once

#include <cstdint>
#include <string>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {

struct Outcome {
  std::uint64_t paths = 0;  ///< Of the first render, like `rays`.
  std::uint64_t rays = 0;
  std::string failure;  ///< Empty if there is none.
};

/// Loads and renders the scene several times and looks for failures:
/// - the loader rejects the scene;
/// - a sample is not finite or too large for the film;
/// - a value other than a Stokes component Q, U or V is negative although no response is;
/// - light enters a closed box from outside;
/// - two sample ranges on another number of threads give different bits;
/// - a crop gives different values, or the layers do not sum to the film;
/// - the rendering code raises a floating-point exception.
/// A scene whose integrator rejects it with Error{scene} is rendered by path tracing instead. Throws other
/// errors of `render`.
/// Exceptions are counted for the rest of the process, so the process should end soon after.
[[nodiscard]] Outcome check(const DrawnScene& drawn);

}  // namespace abbe::soak
