#pragma once

#include <cstdint>
#include <optional>

#include "transport/plan/plan.h"

namespace abbe {

/// What pilots find of the techniques of a plan. Variances and squares are of film values, the sum of their
/// magnitudes over the channels, relative to the squared mean of a sixteenth of the film's edges around, as
/// relMSE takes them, of a meter to that of its film, and summed over the pixels.
struct PilotFindings {
  double path_variance = 0;  ///< Of a camera path through each pixel,
  double path_square = 0;    ///< and the mean square.
  /// Standard error of `path_variance`, from its scatter over the pixels. It is of the order of the variance
  /// itself where few rare paths dominate, and pilots may have missed others.
  double path_variance_error = 0;
  double photon_variance = 0;  ///< Of as many photons as pixels.
  /// Of bidirectional path tracing's, no more than the mean square that a camera path of path tracing would
  /// have, which finds by rare chance what joining finds often.
  double path_tracing_square = 0;
  double path_rays = 0;    ///< Of one camera path,
  double photon_rays = 0;  ///< and of one photon; none where both are traced as one.
  /// Rays of a photon that parts into its lanes where glass disperses it, over those of one that goes on with
  /// its hero alone, where error costs less so: what is told of photons is told of such then.
  std::optional<double> rays_of_parting = {};
  std::uint64_t rays = 0;  ///< Of all pilots.
};

/// Camera paths that pilots trace through a pixel.
inline constexpr std::uint32_t kPilotPathsPerPixel = 8;

/// Tries the techniques of a plan, path tracing and light tracing or bidirectional path tracing, by
/// `kPilotPathsPerPixel` camera paths through each of so many pixels and twice as many photons, where glass
/// disperses by a sixteenth of these again, which part into their lanes. Bidirectional path tracing has as
/// many photons as camera paths, whose splats count as those of photons. Costs are rays counted: what is
/// found depends on nothing but the plan.
[[nodiscard]] PilotFindings try_techniques(const Plan& plan, int threads, std::uint32_t pixels = 4096);

}  // namespace abbe
