#pragma once

#include <optional>

#include "transport/plan/plan.h"

namespace abbe {

/// Variance and cost of one technique, estimated by pilots.
struct TechniqueCost {
  /// Variance of a pixel from one sample, divided by the squared mean of its surroundings; mean over all
  /// pixels.
  double relative_variance;
  double rays;  ///< Rays of one path.
};

/// Costs by which `balance_techniques` chose the numbers of camera paths and photons of a sample: those of a
/// camera path through each pixel, and of as many photons as pixels.
struct TechniqueCosts {
  TechniqueCost camera_paths;
  TechniqueCost photons;
};

/// Sets `Plan::path_interval`, `Plan::photons` and `Plan::photons_split_wavelengths` of a plan that traces
/// both camera paths and photons, for the least error at its cost. The default is one path per pixel and as
/// many photons as pixels. One of the two numbers may be reduced to a half, a quarter or an eighth.
///
/// Photons split into their wavelengths if that reduces V' c'. Their number is then reduced by a power of
/// two, so that they cast about as many rays as photons that do not split.
///
/// Let V and V' be the variances and c and c' the costs of a camera path per pixel and of as many photons. At
/// the cost n c + m c', V/n + V'/m is least for m/n = sqrt(V' c/(V c')). If that ratio is below 1, it is the
/// fraction of photons. The fraction of camera paths is n/m with the mean square in place of V, because each
/// pixel skips paths at random.
///
/// Variances are relative to the squared mean of a region of a sixteenth of the film's width and height, as
/// in relMSE. Costs are numbers of rays. Both come from 32768 camera paths, eight per pixel, and 65536
/// photons, and depend on the plan alone, not on `threads`, which is at least 1. A technique that finds
/// nothing retains an eighth, since it may find something later. Returns the costs; empty, with the plan
/// unchanged, if only one technique renders.
std::optional<TechniqueCosts> balance_techniques(Plan& plan, int threads);

}  // namespace abbe
