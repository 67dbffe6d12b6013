#pragma once

#include <cstddef>
#include <vector>

#include "scene/scene.h"
#include "spectral/sampled_spectrum.h"
#include "transport/path/path_vertex.h"
#include "transport/path/ray_caster.h"

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

/// Path z_0 z_1 ... z_L from the camera to a light. A camera subpath sampled its first `t` vertices, a light
/// subpath the others.
struct JoinedPath {
  std::vector<const PathVertex*> z;   ///< Its L + 1 vertices, which others own.
  std::size_t t = 0;                  ///< 1 to L + 1; L + 1 for an emitter hit of the camera subpath.
  SampledSpectrum passing_pdf{1.0F};  ///< `Connection::passing_pdf` of the connecting segment.
  /// Vertex of the light subpath that is merged with the last vertex of the camera subpath; nullptr for a
  /// connection. It is not in `z`.
  const PathVertex* merged = nullptr;
};

/// Pdfs at the ends of a path, which depend on how techniques start there. Pdfs of the light's point z_L have
/// the measure of `PathVertex` and include the probability of choosing the light.
struct EndDensities {
  float light_start = 0;       ///< Pdf of z_L for an emitted path; 0 if the light emits none.
  float light_connection = 0;  ///< Pdf of z_L for next-event estimation at z_{L-1}.
  /// Pdf [1/sr] of the light's direction to z_{L-1} for an emitted path; for a light at infinity, of the
  /// ray's position [1/m^2]. 0 if no emitted path arrives there.
  float emission = 0;
  /// Number of light subpaths that may be connected to a pixel of the camera, per camera path of that pixel;
  /// 0 if the camera has no connections.
  float lens_connections = 0;
  bool lights_connect_to_camera = false;  ///< True if a light may be connected to the camera itself.
  /// Area within which vertices on a surface are merged [m^2], times the number of light subpaths that may be
  /// merged; 0 without merging.
  float merging = 0;
};

/// Balance heuristic over all wavelengths k and all strategies t' that can sample a path. The camera samples
/// z_0 ... z_{t-1} and the light z_t ... z_L [Veach1997, eq. 10.9] [Wilkie2014, eq. 6]:
///     w f / P_t,hero = [f / P_t,hero] / sum_k sum_t' n_t' P_t',k / P_t,hero;
///     P_t',k = prod_{i < t'} p_k(z_{i-1} -> z_i) prod_{i >= t'} p_k(z_{i+1} -> z_i).
/// P_t',k is the pdf of strategy t' with wavelength k as the hero, n_t' its number of paths per camera path.
/// Merging at z_m is a further strategy [Georgiev2012]. With N light subpaths and the radius r its pdf is
///     N pi r^2 prod_{i <= m} p_k(z_{i-1} -> z_i) prod_{i >= m} p_k(z_{i+1} -> z_i).
///
/// Strategies that would connect at a vertex with a delta distribution are left out. Long paths end by
/// roulette and are connected at some of their vertices only. n_t' includes both, with `survival_fraction`
/// for roulette: weights need not be exact as long as they sum to 1. The contribution of strategy t is
/// multiplied by the same fraction, because its throughput was divided by it. One instance per thread.
class StrategyWeights {
 public:
  /// Scene and caster must outlive the weights.
  StrategyWeights(const Scene& scene, RayCaster& caster);

  /// MIS weight for the path's contribution, which is the product of its throughputs. At least 0; it includes
  /// the balance over wavelengths and the survival fraction of the path's own strategy. 0 if a pdf of that
  /// strategy is 0 or the weight is not finite. Throws Error{resource} if more than `MediumStack::kMaxShapes`
  /// media nest.
  [[nodiscard]] float weight_of(const JoinedPath& path, const EndDensities& ends);

  /// Pdf of the last weighted path by path tracing (emitter hit, or NEE at each vertex) over the summed pdfs
  /// of all strategies. May exceed 1 if the strategies connect some vertices only. 0 if path tracing cannot
  /// sample the path.
  [[nodiscard]] float path_tracing_fraction() const {
    const float all = sum_.sum();
    return all > 0 ? path_tracing_sum_.sum() / all : 0;
  }

  /// Probability, per wavelength, of passing the media between two vertices without an event. At most one of
  /// them may be at infinity.
  [[nodiscard]] SampledSpectrum passing_pdf_between(const PathVertex& a, const PathVertex& b) const;

 private:
  // Pdf of a vertex sampled from the one before it, and from the one after it.
  struct VertexPdfs {
    SampledSpectrum pdf_from_camera;
    SampledSpectrum pdf_from_light;
    float current = 0;  // the hero's pdf by the current strategy
  };

  [[nodiscard]] SampledSpectrum pdf_from_camera(const JoinedPath& path, std::size_t i) const;
  [[nodiscard]] SampledSpectrum pdf_from_light(const JoinedPath& path, const EndDensities& ends,
                                               std::size_t i) const;
  [[nodiscard]] SampledSpectrum area_pdf(const JoinedPath& path, const SampledSpectrum& direction,
                                         std::size_t from, std::size_t to) const;
  const Scene& scene_;
  RayCaster& caster_;
  bool has_free_paths_;
  std::vector<VertexPdfs> vertex_pdfs_;      // of the current path
  std::vector<SampledSpectrum> from_light_;  // products of light pdfs over z_i ... z_L
  SampledSpectrum sum_;                      // pdfs of all strategies
  SampledSpectrum path_tracing_sum_;         // pdfs of path tracing
};

}  // namespace abbe
