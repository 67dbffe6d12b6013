#pragma once

#include <optional>

#include "transport/plan/plan.h"

namespace abbe {

/// What pilots find of one technique.
struct TechniqueCost {
  double relative_variance;  ///< Of a pixel by one sample of it, over the squared mean around.
  double rays;               ///< Of one path.
};

/// Why the samples of a plan have so many camera paths and photons: what pilots found of a camera path for
/// each pixel, and of as many photons as pixels.
struct TechniqueCosts {
  TechniqueCost camera_paths;
  TechniqueCost photons;
};

/// Sets how many photons and camera paths the samples of a plan that traces both have, which make its error
/// least for what they cost: as many photons as pixels and a path through each, or of one of the two a half,
/// a quarter or an eighth.
///
/// Photons part into their lanes where that makes V' c' less: so few of them set out then, by a power of two,
/// that they cast about as many rays as those that do not.
///
/// With variances V and V' and costs c and c' of a camera path per pixel and of as many photons, V/n + V'/m
/// is least at the cost n c + m c' for m/n = sqrt(V' c/(V c')). Below 1 that is the share of photons. The
/// share of camera paths is n/m with the mean square in place of V, as pixels skip paths by chance, whatever
/// the samples of a range. Both are relative to the squared mean of a sixteenth of the film's edges around,
/// as relMSE takes them; they and the costs, which are rays counted, come from 32768 camera paths, eight to a
/// pixel, and 65536 photons, and depend on nothing but the plan. What finds nothing there keeps an eighth,
/// since it may yet. Returns what was found; nothing where one technique alone renders, whose plan stays.
std::optional<TechniqueCosts> set_technique_shares(Plan& plan, int threads);

}  // namespace abbe
