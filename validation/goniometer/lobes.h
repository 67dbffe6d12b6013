#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "materials/bsdf.h"
#include "validation/goniometer/sphere_cells.h"
#include "validation/statistics.h"

namespace abbe {

/// Samples a BSDF for a fixed outgoing direction, with the wavelength sample `hero` as the hero; empty if the
/// light is absorbed. All directions are in the local frame: z is the normal, and vectors point away from the
/// surface.
using LobeSampler = std::function<std::optional<BsdfSample>(const BsdfRandom& u, int hero)>;

/// Sampler of a BSDF, which is copied.
[[nodiscard]] LobeSampler sampler_of(const Bsdf& bsdf, const Imath::V3f& wo, TransportMode mode);

/// Agreement of samples with a pdf.
struct DensityCheck {
  double p;         ///< p-value: probability that samples of this pdf deviate at least as much.
  double integral;  ///< Integral of the pdf over the sphere: the probability of an event that is not delta.
};
/// Chi-square test of the non-delta events of `sampler` against `density` [1/sr], at the wavelength sample
/// `hero`. It counts `samples` events in cells that half as many others define. Cells with fewer than 5
/// expected samples are pooled. Samples without an event and delta events count as one cell. If the pool
/// itself expects fewer than 5, a Poisson test replaces its term; it allows a millionth of all samples in
/// excess.
[[nodiscard]] DensityCheck check_density(const LobeSampler& sampler, const SphereDensity& density, int hero,
                                         int samples = 200000, std::uint64_t seed = 0);

inline constexpr std::size_t kReplicates = 16;
/// Means of one quantity over each set of random numbers.
using Replicates = std::array<double, kReplicates>;
/// Mean and its standard error from the scatter of the replicates; 0 if they are equal.
[[nodiscard]] Estimate estimate(const Replicates& replicates);

/// Directional-hemispherical reflectance and transmittance for each wavelength sample, as fractions of the
/// power.
struct AlbedoReplicates {
  std::array<Replicates, kLanes> reflected;    ///< Into the hemisphere of `wo`.
  std::array<Replicates, kLanes> transmitted;  ///< Into the other hemisphere.
};
/// Albedo for light from the unit direction `wo`, which points towards the source and is that of `sampler`.
/// The estimator is balanced over the wavelengths, each of which is the hero equally often. With a sampler in
/// `TransportMode::power` a lossless material gives a sum of 1. It uses about `samples` random numbers per
/// hero, at least one in each set. Equal `samples` and `seed` give equal random numbers for every sampler.
[[nodiscard]] AlbedoReplicates albedo_replicates(const LobeSampler& sampler, const Imath::V3f& wo,
                                                 int samples, std::uint64_t seed = 0);

/// Delta events of a BSDF for the unit outgoing direction `wo` and a hero, each with its probability `pdf`
/// and weights; empty if there are none. They are found by sampling 65 values of the lobe choice, so an event
/// with a probability below 1/64 may be missed.
[[nodiscard]] std::vector<BsdfSample> delta_events(const Bsdf& bsdf, const Imath::V3f& wo, int hero,
                                                   TransportMode mode);

/// Deviation of a BSDF from symmetry, over pairs of directions that it connects and all wavelength samples.
/// Both members are 0 if it connects none without delta events.
struct Asymmetry {
  /// Maximum of |f(a, b) - f(b, a)| / max(f(a, b), f(b, a)), over pairs where either is positive.
  double largest;
  double mean;  ///< Mean of |f(a, b) - f(b, a)|, divided by the mean of (f(a, b) + f(b, a))/2.
};
/// Deviation from Helmholtz reciprocity: f(a, b) = f(b, a) on one side of the surface. Across the surface,
/// each f is divided by n^2 of the side that its light leaves to. Half of the `pairs` are uniform over the
/// sphere; in the others the BSDF samples the second direction.
[[nodiscard]] Asymmetry reciprocity_error(const Bsdf& bsdf, int pairs = 4096, std::uint64_t seed = 0);
/// Deviation between f(a, b) for radiance, which camera paths use, and f(b, a) for power, which photons use.
/// It is 0 for every consistent model, reciprocal or not.
[[nodiscard]] Asymmetry adjoint_error(const Bsdf& bsdf, int pairs = 4096, std::uint64_t seed = 0);

}  // namespace abbe
