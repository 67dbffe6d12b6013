#pragma once

#include "spectral/packet.h"

namespace abbe {

/// The balance heuristic over the lanes of a packet and over both ways in which a path may have come by its
/// last direction, by scattering or by connecting to its end [Veach1997, eq. 9.8] [Wilkie2014, eq. 6]:
///     w f / P_hero = [f / P_hero] / sum_k (P_k / P_hero) (s_k + c),
/// P_k being the density of the path up to its last vertex, were lane k the hero, s_k that of scattering from
/// there into the direction, and c that of drawing it as a connection, the same for all lanes.
///
/// What comes by scattering is to be multiplied by this. What comes by a connection, estimated as f/c over
/// the throughput so far, is multiplied by it instead of being divided by c: the c of w f/(P_hero c) cancels.
///
/// `scattered` is P_k s_k and `connected` the sum of P_k, both in one unit, the one that the path's
/// throughput is measured in: of P_hero before it scatters, of P_hero s_hero after.
[[nodiscard]] inline float mis_weight(const SampledSpectrum& scattered, float connection_pdf,
                                      float connected) {
  return 1 / (scattered.sum() + connection_pdf * connected);
}

}  // namespace abbe
