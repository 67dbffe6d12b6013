#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

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
  std::uint64_t rays = 0;                 ///< Rays of all pilots.
  std::vector<double> region_means = {};  ///< Mean of each region of the film.
};

/// Number of camera paths that pilots trace through a pixel.
inline constexpr std::uint32_t kPilotPathsPerPixel = 8;

/// Estimates the variance and the cost of a plan's techniques: path tracing and light tracing, or
/// bidirectional path tracing. Pilots trace `kPilotPathsPerPixel` camera paths through each of `pixels`
/// pixels, and twice as many photons. If the scene has dispersion, they trace a sixteenth as many photons
/// again that split into their wavelengths. Bidirectional path tracing has as many photons as camera paths,
/// and its splats count as those of photons. Costs are numbers of rays, so the result depends on the plan and
/// on `pixels` alone, not on `threads`, which is at least 1.
///
/// Variances are relative to `region_means`, those of another integrator's pilots, or to own means where
/// these are absent or 0. The means of few, rare hits are large, so that own means would hide the noise of an
/// integrator that finds the light rarely.
[[nodiscard]] TechniqueStatistics measure_techniques(const Plan& plan, int threads,
                                                     std::uint32_t pixels = 4096,
                                                     std::span<const double> region_means = {});

/// Sets `Plan::log2_splits`, the path splitting [Arvo1990] of Integrator::automatic: the base-2 logarithm of
/// the number of directions, 1, 2, 4 or 8, in which a camera path continues from its first scattering
/// surface. Path tracing that the scene requests does not split, because its techniques are compared with one
/// another.
///
/// Splitting saves rays if the noise of a pixel comes from later vertices, and not from film, lens and first
/// surface. For each number, pilots trace 32 paths through each of 512 pixels, in four replicates, with
/// random numbers that no render uses. They compare relMSE, without the worst pixels, times the number of
/// rays.
///
/// A larger number must improve this cost by 2 %. The search ends at the first number that is worse by 2 %,
/// or when `pilot_ray_budget` is spent. Films of fewer than 8192 pixels and plans without path tracing do not
/// split. The result depends on the plan alone, not on `threads`, which is at least 1.
void choose_path_splitting(Plan& plan, int threads);

}  // namespace abbe
