#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "materials/bsdf/bsdf.h"
#include "validation/goniometer/sphere_cells.h"
#include "validation/statistics/equivalence.h"

namespace abbe {

/// Scattering seen from one direction, as sampling gives it.
using LobeSampler = std::function<std::optional<BsdfSample>(const BsdfRandom& u, int hero)>;

/// The sampler of a scattering model, for light seen from `wo`.
[[nodiscard]] LobeSampler sampler_of(const Bsdf& bsdf, const Imath::V3f& wo, TransportMode mode);

/// How well samples follow a density.
struct DensityCheck {
  double p;         ///< Probability of samples at least as far from the density, were they drawn from it.
  double integral;  ///< Of the density over the sphere: the probability of an event that is not delta.
};
/// Chi-square of the events of `sampler` that are not delta against `density`, over cells refined by other
/// samples; what expects fewer than 5 is pooled, and what sends nothing, or a delta event, counts as a cell.
/// A pool that expects fewer than 5 itself is judged by Poisson's law, with a millionth of all samples to
/// spare.
[[nodiscard]] DensityCheck check_density(const LobeSampler& sampler, const SphereDensity& density, int hero,
                                         int samples = 200000, std::uint64_t seed = 0);

/// Equally good means of one quantity, each by random numbers of its own.
inline constexpr std::size_t kReplicates = 16;
using Replicates = std::array<double, kReplicates>;
/// Their mean, and its standard error by how they differ: 0 where they do not.
[[nodiscard]] Estimate estimate(const Replicates& replicates);

/// What leaves of light that arrives along `wo`: the directional-hemispherical reflectance and transmittance,
/// lane by lane, by the balanced estimator with a hero drawn evenly. Photons carry it (TransportMode::power),
/// so that lossless matter sends 1 in all.
struct Albedo {
  std::array<Estimate, kLanes> reflected;
  std::array<Estimate, kLanes> transmitted;

  [[nodiscard]] double total(int lane) const {
    const auto i = static_cast<std::size_t>(lane);
    return reflected[i].mean + transmitted[i].mean;
  }
};
[[nodiscard]] Albedo albedo(const LobeSampler& sampler, const Imath::V3f& wo, int samples = 4096,
                            std::uint64_t seed = 0);

/// The replicates whose mean is an albedo, lane by lane. Those of one number and one seed have the same
/// random numbers, whatever they sample.
struct AlbedoReplicates {
  std::array<Replicates, kLanes> reflected;
  std::array<Replicates, kLanes> transmitted;
};
[[nodiscard]] AlbedoReplicates albedo_replicates(const LobeSampler& sampler, const Imath::V3f& wo,
                                                 int samples, std::uint64_t seed = 0);

/// The single directions light leaves in, each with its probability and weights, by trying choices of lobe:
/// an event that fewer than one in 64 choices lead to may be missed in the midst of others.
[[nodiscard]] std::vector<BsdfSample> delta_events(const Bsdf& bsdf, const Imath::V3f& wo, int hero,
                                                   TransportMode mode);

/// How far a model is from being symmetric, over pairs of directions it connects.
struct Asymmetry {
  double largest;  ///< Of |f(a, b) - f(b, a)| / max(f(a, b), f(b, a)), counting only pairs that matter.
  double mean;     ///< Of |f(a, b) - f(b, a)| over that of f(a, b) + f(b, a) halved.
};
/// How far a model is from Helmholtz's reciprocity: f(a, b) = f(b, a), and f/n^2 of the side light leaves to,
/// across the surface.
[[nodiscard]] Asymmetry reciprocity_error(const Bsdf& bsdf, int pairs = 4096, std::uint64_t seed = 0);
/// How far what camera paths see, f(a, b) of radiance, is from what photons do on the same way, f(b, a) of
/// power: 0 for every model, reciprocal or not.
[[nodiscard]] Asymmetry adjoint_error(const Bsdf& bsdf, int pairs = 4096, std::uint64_t seed = 0);

}  // namespace abbe
