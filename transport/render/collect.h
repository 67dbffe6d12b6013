#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "transport/render/pass.h"
#include "transport/technique/bidirectional.h"
#include "transport/technique/photons.h"

namespace abbe {

/// What the paths from lights of a sample take in memory where they are kept, if each comes to four places,
/// as is usual; 0 of a scene whose integrator keeps none.
[[nodiscard]] std::size_t bytes_of_light_paths(const Scene& scene);

/// Numbers of the path from a light with that number, of one sample.
using LightNumbers = std::function<Sampler(std::uint64_t path)>;

/// The photons that the plan's paths from lights leave in a sample of that packet and time, the same whatever
/// the number of threads. Adds to `counts`.
[[nodiscard]] PhotonCloud collect_photons(const Plan& plan, const PathPacket& packet, float time,
                                          const LightNumbers& numbers, int threads, PassCounts& counts);

/// The paths themselves, to be merged within `radius` [m], which take the place of those that were kept.
void collect_light_paths(const Plan& plan, const PathPacket& packet, float time, float radius,
                         const LightNumbers& numbers, int threads, LightPaths& kept, PassCounts& counts);

}  // namespace abbe
