#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// The closed list of techniques from which a plan chooses. Each estimates the light of the classes of paths
/// that it owns, and no path has two owners.
enum class Technique : std::uint8_t {
  path,   ///< Path tracing from the camera [Kajiya1986]: `PathTracer`.
  light,  ///< Light tracing [Arvo1986]: `LightTracer`.
  bdpt,   ///< Bidirectional path tracing [Veach1997]: `BidirectionalTracer`. Alone.
};

/// The name of a technique in scenes and answers.
[[nodiscard]] std::string_view name_of(Technique technique);

/// The techniques that the scene's integrator allows and the scene asks for, in the order of the list.
[[nodiscard]] std::vector<Technique> chosen_techniques(const Scene& scene);

/// Whether a technique is among some.
[[nodiscard]] bool uses(std::span<const Technique> techniques, Technique technique);

/// Whether one of some starts paths from lights.
[[nodiscard]] bool starts_at_lights(std::span<const Technique> techniques);

/// Tells which classes of paths a technique owns beside the others of `active`, in the notation of
/// [Heckbert1990]: E is the camera, S an event of a single direction, D any other, and L the light.
[[nodiscard]] std::string owned_paths(Technique technique, std::span<const Technique> active);

}  // namespace abbe
