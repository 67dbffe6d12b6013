#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "scene/unreached.h"

namespace abbe {

/// The closed list of techniques from which a plan chooses. Each estimates the light of the classes of paths
/// that it owns, and no path has two owners.
enum class Technique : std::uint8_t {
  path,   ///< Path tracing from the camera [Kajiya1986]: `PathTracer`.
  light,  ///< Light tracing [Arvo1986]: `LightTracer`.
  bdpt,   ///< Bidirectional path tracing [Veach1997]: `BidirectionalTracer`. Alone.
  /// Photon density estimation: `PhotonGatherer`. Alone. With so many nearest photons [Jensen1996];
  photon_map,
  /// within a radius that shrinks from sample to sample, at the same places [Hachisuka2008],
  ppm,
  /// or at new ones [Hachisuka2009].
  sppm,
  vcm,            ///< Vertex connection and merging [Georgiev2012]: `BidirectionalTracer`. Alone.
  photon_brute,   ///< Photons that come through the lens by themselves: `BrutePhotonTracer`. Alone.
  adjoint_brute,  ///< Paths from the camera that meet lights by themselves: `AdjointBruteTracer`. Alone.
};

/// The name of a technique in scenes and answers.
[[nodiscard]] std::string_view name_of(Technique technique);

/// The techniques that the scene's integrator allows and the scene asks for, in the order of the list.
[[nodiscard]] std::vector<Technique> chosen_techniques(const Scene& scene);

/// The classes of paths of a scene that they do not reach.
[[nodiscard]] std::vector<PathClass> unreached(const Scene& scene);

/// Whether a technique is among some.
[[nodiscard]] bool uses(std::span<const Technique> techniques, Technique technique);

/// Whether one of some starts paths from lights.
[[nodiscard]] bool starts_at_lights(std::span<const Technique> techniques);

/// Whether a technique gathers photons that all paths from lights of a sample leave first.
[[nodiscard]] bool gathers_photons(Technique technique);

/// What a technique's estimate converges to with more samples, where that is not plainly the light: "", or
/// why.
[[nodiscard]] std::string_view bias_of(Technique technique);

/// Tells which classes of paths to a camera a technique owns beside the others of `active`, in the notation
/// of [Heckbert1990]: E is the camera, S an event of a single direction, D any other, and L the light.
[[nodiscard]] std::string owned_paths(Technique technique, std::span<const Technique> active,
                                      const Camera& camera);

}  // namespace abbe
