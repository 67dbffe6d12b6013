#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/lost_light.h"
#include "scene/scene.h"

namespace abbe {

/// Techniques from which a plan chooses. Each estimates the classes of paths that it owns; no path has two
/// owners.
enum class Technique : std::uint8_t {
  path,   ///< Path tracing [Kajiya1986]: `PathTracer`.
  light,  ///< Light tracing [Arvo1986]: `LightTracer`.
  bdpt,   ///< Bidirectional path tracing [Veach1997]: `BidirectionalTracer`. Used alone.
  /// Photon density estimation with the nearest photons [Jensen1996]: `PhotonGatherer`. Used alone.
  photon_map,
  /// Photon density estimation with a decreasing radius at the same points [Hachisuka2008]: `PhotonGatherer`.
  /// Used alone.
  ppm,
  /// Photon density estimation with a decreasing radius at new points [Hachisuka2009]: `PhotonGatherer`. Used
  /// alone.
  sppm,
  vcm,            ///< Vertex connection and merging [Georgiev2012]: `BidirectionalTracer`. Used alone.
  photon_brute,   ///< Photons that enter the lens by chance: `BrutePhotonTracer`. Used alone.
  adjoint_brute,  ///< Camera paths that hit lights by chance: `AdjointBruteTracer`. Used alone.
};

/// Name of a technique in scene files and answers.
[[nodiscard]] std::string_view name_of(Technique technique);

/// Techniques of the scene's integrator, in the order of the enumeration; at least one.
[[nodiscard]] std::vector<Technique> chosen_techniques(const Scene& scene);

/// Classes of light paths of a scene that none of its `chosen_techniques` can sample.
[[nodiscard]] std::vector<PathClass> unreached(const Scene& scene);

/// True if `techniques` contains `technique`.
[[nodiscard]] bool uses(std::span<const Technique> techniques, Technique technique);

/// True if one of the techniques starts paths at lights: all but `path` and `adjoint_brute` do.
[[nodiscard]] bool starts_at_lights(std::span<const Technique> techniques);

/// True if a technique gathers photons that the light paths of a sample store first: `photon_map`, `ppm` and
/// `sppm`.
[[nodiscard]] bool gathers_photons(Technique technique);

/// Reason why a technique's estimate is biased; "" if it is unbiased.
[[nodiscard]] std::string_view bias_of(Technique technique);

/// Classes of camera paths that a technique owns if a plan combines the techniques `active`, of which it is
/// one. The notation is that of [Heckbert1990], e.g. "E (S|D)* L": E is the camera, S a delta event, D any
/// other event, and L the light.
[[nodiscard]] std::string owned_paths(Technique technique, std::span<const Technique> active,
                                      const Camera& camera);

}  // namespace abbe
