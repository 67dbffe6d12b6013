#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "transport/render/pass.h"
#include "transport/technique/bidirectional.h"
#include "transport/technique/photon_mapping.h"

namespace abbe {

/// Memory [bytes] for the light subpaths of one sample, if each has four vertices, as is usual; 0 if the
/// scene's integrator stores none.
[[nodiscard]] std::size_t bytes_of_light_paths(const Scene& scene);

/// Returns the sampler of random numbers of one light subpath of a sample, by the index of the subpath.
using LightPathSampler = std::function<Sampler(std::uint64_t path)>;

/// Traces the plan's light subpaths of one sample, all with the same `packet` and `time`, and returns the
/// photons that they deposit. `time` is a fraction of the exposure. The result does not depend on `threads`,
/// which is at least 1. Several threads call `samplers` concurrently. Adds paths, rays and truncated paths to
/// `counts`. Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest.
[[nodiscard]] PhotonCloud trace_photon_cloud(const Plan& plan, const PathPacket& packet, float time,
                                             const LightPathSampler& samplers, int threads,
                                             PassCounts& counts);

/// Traces the plan's light subpaths of one sample and stores them in `light_paths`, replacing its content, to
/// be merged within `radius` [m]. Other arguments and errors are as for `trace_photon_cloud`.
void trace_light_subpaths(const Plan& plan, const PathPacket& packet, float time, float radius,
                          const LightPathSampler& samplers, int threads, LightSubpaths& light_paths,
                          PassCounts& counts);

}  // namespace abbe
