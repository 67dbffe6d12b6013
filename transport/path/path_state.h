#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "materials/bsdf/event.h"
#include "sampling/sampler.h"
#include "scene/lights/light.h"
#include "scene/shapes/ray.h"
#include "spectral/sampled_spectrum.h"
#include "spectral/wavelength_distribution.h"
#include "transport/path/media.h"
#include "transport/path/polarisation.h"

namespace abbe {

/// Wavelength samples of one path. Let f be the path's contribution, P_k its pdf of directions if wavelength
/// k makes the random choices, and p the pdf of wavelengths. The estimate is the balance heuristic over
/// wavelengths [Wilkie2014],
///     sum_j [f_j / p(lambda_j)] / sum_k P_k.
/// The pdf of wavelengths divides the numerator only. The hero, drawn uniformly from all wavelengths, makes
/// the choices.
struct PathPacket {
  SampledWavelengths wavelengths;
  SampledSpectrum throughput{1.0F};       ///< f_j / P_hero.
  SampledSpectrum lane_pdf{1.0F};         ///< P_k / P_hero; 0 for a wavelength that cannot follow the path.
  int hero = 0;                           ///< Index of the hero, 0 to kLanes - 1.
  CarriedPolarisation polarisation = {};  ///< Empty in scenes that need no polarisation.

  /// Index of the hero if no other wavelength can follow the path; nothing if one can.
  [[nodiscard]] std::optional<int> lone_lane() const {
    return lane_pdf.sum() == lane_pdf[hero] ? std::optional(hero) : std::nullopt;
  }
  /// Largest throughput over the largest pdf, max_j f_j / max_k P_k; independent of which wavelength is the
  /// hero.
  [[nodiscard]] float throughput_estimate() const { return throughput.max() / lane_pdf.max(); }
};

/// Draws the wavelengths and the hero of a packet with `u` in [0, 1). The wavelengths divide the cumulative
/// distribution into eighths: an eighth of `u` shifts them, the rest selects the hero.
[[nodiscard]] inline PathPacket draw_packet(const WavelengthDistribution& distribution, float u) {
  const float scaled = u * kLanes;
  const int hero = std::min(static_cast<int>(scaled), kLanes - 1);
  PathPacket packet;
  packet.wavelengths = distribution.sample((scaled - static_cast<float>(hero)) / kLanes);
  packet.hero = hero;
  return packet;
}

/// Applies an event to a packet: `weight` is f / P_hero per wavelength, and `lane_pdf` the pdf of wavelength
/// k relative to the hero's.
inline void advance(PathPacket& packet, const SampledSpectrum& weight, const SampledSpectrum& lane_pdf) {
  packet.throughput *= weight;
  packet.lane_pdf *= lane_pdf;
}
inline void advance(PathPacket& packet, const BsdfSample& event) {
  advance(packet, event.weight, event.lane_pdf);
}
/// Factor by which an event changes `PathPacket::throughput_estimate` if all wavelengths had equal
/// throughputs and pdfs before; independent of which wavelength is the hero.
[[nodiscard]] inline float event_throughput(const BsdfSample& event) {
  return event.weight.max() / event.lane_pdf.max();
}
/// Applies an event to the polarisation of a packet, which must carry one. `matrix` is empty if the event
/// depolarises. `travels` is the unit direction of the light on the side of the event from which the packet
/// came. Corrects the throughput from unpolarised to polarised light.
inline void polarise(PathPacket& packet, const std::optional<MuellerMatrix>& matrix,
                     const Imath::V3f& travels, TransportMode mode) {
  packet.throughput *= packet.polarisation->pass(matrix, travels, mode);
}
/// Divides the throughput by a survival probability in (0, 1], equal for all wavelengths.
inline void survive(PathPacket& packet, float probability) {
  packet.throughput *= 1 / probability;
}

/// Homogeneous scattering segment of a ray, from its origin, with the path's state there.
struct MediumSegment {
  Ray ray;
  float length = 0;  ///< Length [m], which may be infinite; 0 if there is no segment.
  /// Sum over wavelengths of the path's pdf up to the origin, for `mis_weight`. Like the throughput it is
  /// relative to the pdf with which the hero wavelength sampled the path.
  float path_pdf = 0;
  Imath::V3f end_normal{0, 0, 0};  ///< Unit normal of the surface at its end; (0, 0, 0) if there is none.
};

/// Number of paths in a batch; their states fit into a near cache.
inline constexpr std::uint32_t kBatchSize = 64;

/// State of a path from the camera or a light: the ray on which it leaves its last vertex, and all that is
/// needed to continue it.
struct PathState {
  PathState(const Sampler& path_sampler, std::uint32_t batch_index)
      : sampler(path_sampler), index(batch_index) {}

  Ray ray;
  PathPacket packet;
  Sampler sampler;
  std::uint32_t index;  ///< Index within its batch.
  int depth = 0;        ///< Number of scattering events so far; kProbeDepth at a probe.
  /// Argument `path_pdf` of `mis_weight` if the next vertex is an emitter hit; 0 if next-event estimation
  /// could not have sampled it, as after a delta event.
  float nee_path_pdf = 0;
  LightSampleContext prev_context;  ///< The last vertex, as context for light sampling.
  /// Spare random numbers of the last event that may draw the next direction.
  std::optional<Imath::V2f> spare_u;
  /// Spare random numbers of the last event in a medium that draw the free path after it.
  std::optional<Imath::V2f> free_path_u;
  MediumState media;  ///< Media around the ray's origin, on the side to which the ray leaves.
  /// Segment that led to the last event, if that was in a medium; of length 0 in a medium with a grid.
  MediumSegment segment;

  [[nodiscard]] const SampledSpectrum& lambda_nm() const { return packet.wavelengths.lambda_nm; }
  /// Throughput for the count of truncated paths. Paths that do not start with 1 hide it by their throughput
  /// relative to that at the start.
  [[nodiscard]] float throughput_estimate() const { return packet.throughput_estimate(); }
};

/// Direction in which the light travels if a path that carries `mode` travels along `along`: against it for
/// radiance, along it for power.
[[nodiscard]] inline Imath::V3f light_travels(const Imath::V3f& along, TransportMode mode) {
  return mode == TransportMode::radiance ? -along : along;
}

}  // namespace abbe
