#pragma once

#include <optional>
#include <string>

namespace abbe {

class Scene;

/// The object that makes polarisation relevant: its kind, "channel", "light" or "shape", and its name in the
/// scene.
struct PolarisationCause {
  const char* kind;
  std::string name;
};

/// Finds the first object that makes polarisation affect what the film records: a channel with a polarisation
/// analyser, otherwise the light or shape at which two events suffice. One event polarises the light: at a
/// shape, or the emission of a polarised light. A second one, at a shape or in the camera's lens, depends on
/// the polarisation. The result is conservative, because paths are not traced. Nothing if unpolarised
/// transport is exact.
[[nodiscard]] std::optional<PolarisationCause> polarisation_cause(const Scene& scene);

/// True if paths of the scene carry polarisation: `features.polarisation_relevant`, and the render settings
/// do not turn it off. Requires `Scene::commit`.
[[nodiscard]] bool carries_polarisation(const Scene& scene);

}  // namespace abbe
