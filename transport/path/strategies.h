#pragma once

#include <cstddef>
#include <vector>

#include "transport/path/path_vertex.h"
#include "transport/path/ray_caster.h"

namespace abbe {

/// A path z_0 z_1 ... z_k from the camera to a light, of which one from the camera made the first `t`
/// vertices and one from the light the rest.
struct JoinedPath {
  std::vector<const PathVertex*> z;
  std::size_t t = 0;
  SampledSpectrum passed{1.0F};  ///< `Connection::density` of the way between both.
  /// Where the path from the light came to as well as that from the camera, whose last vertex it is merged
  /// with; nullptr where both are connected. It is not among `z`.
  const PathVertex* merged = nullptr;
};

/// Densities at the ends of a path, which depend on how techniques start there.
struct EndDensities {
  float light_start = 0;       ///< Of the light's point, where a path sets out from it,
  float light_connection = 0;  ///< and where z_{k-1} is connected to a light drawn for it.
  /// Of the light's direction to z_{k-1}, of one that sets out; for light from infinity of the way's place. 0
  /// where none is to come from there, whatever the path did.
  float emission = 0;
  /// How many paths from lights may be connected to a pixel of the camera for each path through it; 0 where
  /// it takes no connections.
  float lens_connections = 0;
  bool camera_takes_lights = false;  ///< Whether a light may be connected to the camera itself.
  /// Area that vertices on a surface are merged within [m^2], times the number of paths from lights that any
  /// path through a pixel may be merged with; 0 where none is.
  float merging = 0;
};

/// The balance heuristic over all lanes and all ways in which a path may have come about, z_0 ... z_{t-1}
/// from the camera and z_t ... z_k from the light [Veach1997, eq. 10.9] [Wilkie2014, eq. 6]:
///     w f / P_t,hero = [f / P_t,hero] / sum_k sum_t' n_t' P_t',k / P_t,hero,
///     P_t',k = prod_{i < t'} p_k(z_{i-1} -> z_i) prod_{i >= t'} p_k(z_{i+1} -> z_i),
/// P_t',k being the density of strategy t', were lane k the hero, and n_t' the number of its paths for each
/// path through the pixel. Merging at z_m is a strategy too [Georgiev2012], whose density, with N
/// paths from lights and the radius r, is N pi r^2 prod_{i <= m} p_k(z_{i-1} -> z_i) prod_{i >= m}
/// p_k(z_{i+1} -> z_i). Strategies that would join at a vertex where light goes in a single direction are
/// left out. Long paths end by roulette and are joined at some of their vertices alone: n_t' counts that as
/// if nothing but `kept_share` ended them, as the weights of a path need not be exact but to add up to 1, and
/// what comes of strategy t is multiplied by the same share, which its throughputs were divided by. Serves
/// one thread.
class StrategyWeights {
 public:
  StrategyWeights(const Scene& scene, RayCaster& caster);

  /// What the path's contribution by its throughputs is to be multiplied by.
  [[nodiscard]] float of(const JoinedPath& path, const EndDensities& ends);

  /// The density of that path by path tracing, whose path from the camera meets the light, or is connected at
  /// each of its vertices to one drawn for it, over that of all strategies together: their share, or more
  /// where these join some of the vertices alone. 0 where path tracing cannot make it.
  [[nodiscard]] float by_path_tracing() const {
    const float all = sum_.sum();
    return all > 0 ? own_.sum() / all : 0;
  }

  /// With which density the way between two vertices is come through, lane by lane.
  [[nodiscard]] SampledSpectrum passed_between(const PathVertex& a, const PathVertex& b) const;

 private:
  // How densely a vertex is drawn from the one before it, and from the one after.
  struct Densities {
    SampledSpectrum by_camera;
    SampledSpectrum by_light;
    float ours = 0;  // by the strategy in hand, were it the hero's
  };

  [[nodiscard]] SampledSpectrum by_camera(const JoinedPath& path, std::size_t i) const;
  [[nodiscard]] SampledSpectrum by_light(const JoinedPath& path, const EndDensities& ends,
                                         std::size_t i) const;
  [[nodiscard]] SampledSpectrum drawn(const JoinedPath& path, const SampledSpectrum& direction,
                                      std::size_t from, std::size_t to) const;
  const Scene& scene_;
  RayCaster& caster_;
  bool has_free_paths_;
  std::vector<Densities> at_;                // of the path in hand
  std::vector<SampledSpectrum> from_light_;  // products of what the light makes of z_i ... z_k
  SampledSpectrum sum_;                      // of the densities of all strategies,
  SampledSpectrum own_;                      // and of those of path tracing
};

}  // namespace abbe
