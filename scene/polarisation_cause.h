#pragma once

#include <optional>
#include <string>

namespace abbe {

class Scene;

/// The object that makes polarisation relevant: its kind, such as "shape", and its name.
struct PolarisationCause {
  const char* kind;
  std::string name;
};

/// Finds the first object that makes polarisation affect the power of some path. One event polarises the
/// light, and a second one, in the scene or in the camera's lens, depends on the polarisation. Nothing
/// between them depolarises the light completely. Nothing if no such path exists, so that unpolarised
/// transport is exact.
[[nodiscard]] std::optional<PolarisationCause> polarisation_cause(const Scene& scene);

/// True if paths of the scene carry polarisation: it is relevant and the settings do not turn it off.
[[nodiscard]] bool carries_polarisation(const Scene& scene);

}  // namespace abbe
