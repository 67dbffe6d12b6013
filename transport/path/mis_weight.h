#pragma once

#include "scene/scene.h"
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

/// Where there is one way alone the balance heuristic over the lanes is left, 1 / sum_k P_k.
[[nodiscard]] inline float lane_balance(const SampledSpectrum& lane_pdf) {
  return 1 / lane_pdf.sum();
}

/// What `mis_weight` is where a render asks for another combination of both ways. Let S = sum_k P_k s_k and
/// C = c sum_k P_k be the densities of both over all lanes. Each way is weighed as a whole, and its weight
/// shared among the lanes by the balance heuristic:
///     w_s,k = W_s P_k s_k / S,   w_c,k = W_c P_k c / C.
/// So the weights of a path add up to 1 over lanes and ways where W_s + W_c = 1, as here [Veach1997,
/// sec. 9.2]:
///     balance   W_s = S / (S + C)          W_c = C / (S + C)
///     power     W_s = S^2 / (S^2 + C^2)    W_c = C^2 / (S^2 + C^2)
///     bsdf      W_s = 1                    W_c = 0
///     light     W_s = 0, or 1 where C = 0  W_c = 1
/// What multiplies the throughput is w_s,hero / (P_hero s_hero) = W_s / S, and W_c / C, by which balance is
/// `mis_weight`. Where two ways of connecting are balanced with each other, c is the sum of both.
class LightWeights {
 public:
  explicit LightWeights(const PathSampling& sampling)
      : lights_(sampling.lights),
        balances_(sampling.lights == LightStrategy::mis && sampling.heuristic == MisHeuristic::balance) {}

  /// Whether connections count.
  [[nodiscard]] bool connects() const { return lights_ != LightStrategy::bsdf; }
  /// Of light that the path has come to by scattering; the arguments are those of `mis_weight`.
  [[nodiscard]] float of_met(const SampledSpectrum& scattered, float connection_pdf, float connected) const {
    return balances_ ? mis_weight(scattered, connection_pdf, connected)
                     : weigh_met(scattered.sum(), connection_pdf, connected);
  }
  /// Of light that the path has been connected to.
  [[nodiscard]] float of_connection(const SampledSpectrum& scattered, float connection_pdf,
                                    float connected) const {
    return balances_ ? mis_weight(scattered, connection_pdf, connected)
                     : weigh_connection(scattered.sum(), connection_pdf, connected);
  }

 private:
  // Sum and product come apart, as the compiler fuses both in `mis_weight` only where it alone has the
  // product.
  [[nodiscard]] float weigh_met(float scattered, float connection_pdf, float connected) const;
  [[nodiscard]] float weigh_connection(float scattered, float connection_pdf, float connected) const;

  LightStrategy lights_;
  bool balances_;
};

}  // namespace abbe
