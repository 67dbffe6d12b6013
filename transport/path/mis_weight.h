#pragma once

#include "scene/scene.h"
#include "spectral/sampled_spectrum.h"

namespace abbe {

/// MIS weight by the balance heuristic over the wavelengths of a packet and over two techniques for the last
/// direction: scattering and next-event estimation [Veach1997, eq. 9.8] [Wilkie2014, eq. 6]:
///     w f / P_hero = [f / P_hero] / sum_k (P_k / P_hero) (s_k + c).
/// P_k is the pdf of the path up to its last vertex if wavelength k is the hero. s_k is the scattering pdf of
/// the direction, c the pdf of the connection, both [1/sr] for a direction. c is equal for all wavelengths.
///
/// A contribution by scattering is multiplied by this weight. A contribution by connection is an estimate f/c
/// over the throughput; it is multiplied by this weight instead of being divided by c, because the c of w
/// f/(P_hero c) cancels.
///
/// `scattered` is P_k s_k and `path_pdf` the sum of P_k, both in the unit of the path's throughput: P_hero
/// before it scatters, P_hero s_hero after. The result is infinite if all pdfs are 0.
[[nodiscard]] inline float mis_weight(const SampledSpectrum& scattered, float connection_pdf,
                                      float path_pdf) {
  return 1 / (scattered.sum() + connection_pdf * path_pdf);
}

/// Balance heuristic over wavelengths alone, for a path with a single technique: 1 / sum_k P_k / P_hero.
/// `lane_pdf` is that of `PathPacket`; one wavelength at least must have a positive one.
[[nodiscard]] inline float lane_balance(const SampledSpectrum& lane_pdf) {
  return 1 / lane_pdf.sum();
}

/// MIS weights for the combination of scattering and connection that the scene requests. Over all wavelengths
/// the pdfs are S = sum_k P_k s_k and C = c sum_k P_k. Each technique has one weight, which the balance
/// heuristic distributes over the wavelengths:
///     w_s,k = W_s P_k s_k / S,   w_c,k = W_c P_k c / C.
/// The weights of a path sum to 1 over wavelengths and techniques if W_s + W_c = 1, as here [Veach1997, sec.
/// 9.2]:
///     balance   W_s = S / (S + C)          W_c = C / (S + C)
///     power     W_s = S^2 / (S^2 + C^2)    W_c = C^2 / (S^2 + C^2)
///     bsdf      W_s = 1                    W_c = 0
///     light     W_s = 0, or 1 where C = 0  W_c = 1
///
/// The throughput is multiplied by w_s,hero / (P_hero s_hero) = W_s / S, or by W_c / C; for `balance` both
/// are `mis_weight`. If two connection techniques are balanced with each other, c is the sum of their pdfs.
class LightWeights {
 public:
  explicit LightWeights(const PathSampling& sampling)
      : lights_(sampling.lights),
        balances_(sampling.lights == LightStrategy::mis && sampling.heuristic == MisHeuristic::balance) {}

  /// True if next-event estimation contributes: for every strategy but `LightStrategy::bsdf`.
  [[nodiscard]] bool connects() const { return lights_ != LightStrategy::bsdf; }
  /// Weight of emission that the path hit by scattering. Arguments as for `mis_weight`.
  [[nodiscard]] float emission_weight(const SampledSpectrum& scattered, float connection_pdf,
                                      float path_pdf) const {
    return balances_ ? mis_weight(scattered, connection_pdf, path_pdf)
                     : weigh_emission(scattered.sum(), connection_pdf, path_pdf);
  }
  /// Weight of a connection to a light. Arguments as for `mis_weight`.
  [[nodiscard]] float connection_weight(const SampledSpectrum& scattered, float connection_pdf,
                                        float path_pdf) const {
    return balances_ ? mis_weight(scattered, connection_pdf, path_pdf)
                     : weigh_connection(scattered.sum(), connection_pdf, path_pdf);
  }

 private:
  // Sum and product are passed separately: the compiler fuses both in `mis_weight` only if that function
  // alone has the product.
  [[nodiscard]] float weigh_emission(float scattered, float connection_pdf, float path_pdf) const;
  [[nodiscard]] float weigh_connection(float scattered, float connection_pdf, float path_pdf) const;

  LightStrategy lights_;
  bool balances_;
};

}  // namespace abbe
