#pragma once

#include <cstdint>
#include <optional>

#include "transport/plan/plan.h"

namespace abbe {

/// Variances and costs of a plan's sampling techniques, estimated by pilots. A film value is the sum of
/// absolute values over the channels. Variances and squares are relative to the squared mean of the
/// surrounding region, as in relMSE, and summed over the pixels. Regions have a sixteenth of the film's width
/// and height; the film of a probe is one region.
struct TechniqueStatistics {
  double path_variance = 0;  ///< Variance of one camera path through each pixel.
  double path_square = 0;    ///< Mean square of one camera path through each pixel.
  /// Standard error of `path_variance`, from its scatter over the pixels. It is of the order of the variance
  /// if a few rare paths dominate; pilots may then have missed others.
  double path_variance_error = 0;
  double photon_variance = 0;  ///< Variance of as many photons as pixels.
  /// Only for bidirectional path tracing: the mean square that path tracing would have for the same light,
  /// which it may find by rare chance only. It is a lower bound.
  double path_tracing_square = 0;
  double path_rays = 0;    ///< Rays of one camera path.
  double photon_rays = 0;  ///< Rays of one photon; 0 if camera paths and photons are traced together.
  /// Rays of a photon that splits into its wavelengths at dispersive glass, divided by those of one that
  /// continues with its hero wavelength alone. Set if splitting costs less at equal error; then all photon
  /// figures are for photons that split.
  std::optional<double> split_ray_ratio = {};
  std::uint64_t rays = 0;  ///< Rays of all pilots.
};

/// Number of camera paths that pilots trace through a pixel.
inline constexpr std::uint32_t kPilotPathsPerPixel = 8;

/// Estimates the variance and the cost of a plan's techniques: path tracing and light tracing, or
/// bidirectional path tracing. Pilots trace `kPilotPathsPerPixel` camera paths through each of `pixels`
/// pixels, and twice as many photons. If the scene has dispersion, they trace a sixteenth as many photons
/// again that split into their wavelengths. Bidirectional path tracing has as many photons as camera paths,
/// and its splats count as those of photons. Costs are numbers of rays, so the result depends on the plan and
/// on `pixels` alone, not on `threads`, which is at least 1.
[[nodiscard]] TechniqueStatistics measure_techniques(const Plan& plan, int threads,
                                                     std::uint32_t pixels = 4096);

}  // namespace abbe
