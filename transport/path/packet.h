#pragma once

#include <algorithm>

#include "materials/bsdf/event.h"
#include "spectral/packet.h"
#include "spectral/wavelength_distribution.h"
#include "transport/path/polarisation.h"

namespace abbe {

/// The lanes of one path. With f the path's contribution, P_k its density of directions, were lane k to make
/// the random choices, and p the density of wavelengths, a technique's estimate is
///     sum_j [f_j / p(lambda_j)] / sum_k P_k,
/// the balance heuristic over the lanes [Wilkie2014], the density of wavelengths standing in the numerator
/// only. One lane, the hero, drawn uniformly from all, makes the choices in fact.
struct PathPacket {
  SampledWavelengths wavelengths;
  SampledSpectrum throughput{1.0F};  ///< f_j / P_hero.
  SampledSpectrum lane_pdf{1.0F};    ///< P_k / P_hero; 0 for a lane that cannot follow.
  int hero = 0;
  CarriedPolarisation polarisation = {};  ///< Where it is carried.

  /// The hero, where no other lane can follow any more.
  [[nodiscard]] std::optional<int> lone_lane() const {
    return lane_pdf.sum() == lane_pdf[hero] ? std::optional(hero) : std::nullopt;
  }
  /// The largest throughput of a lane, the same whichever lane is the hero.
  [[nodiscard]] float carried() const { return throughput.max() / lane_pdf.max(); }
};

/// A packet whose wavelengths and hero are drawn by `u` in [0, 1): the lanes are an eighth of the cumulative
/// distribution apart, so that an eighth of `u` shifts them and the rest picks the hero.
[[nodiscard]] inline PathPacket draw_packet(const WavelengthDistribution& distribution, float u) {
  const float scaled = u * kLanes;
  const int hero = std::min(static_cast<int>(scaled), kLanes - 1);
  PathPacket packet;
  packet.wavelengths = distribution.sample((scaled - static_cast<float>(hero)) / kLanes);
  packet.hero = hero;
  return packet;
}

/// Takes a packet through an event that leaves `weight` = f / P_hero of each lane and that lane k would have
/// brought about with `lane_pdf` times the hero's density.
inline void advance(PathPacket& packet, const SampledSpectrum& weight, const SampledSpectrum& lane_pdf) {
  packet.throughput *= weight;
  packet.lane_pdf *= lane_pdf;
}
inline void advance(PathPacket& packet, const BsdfSample& event) {
  advance(packet, event.weight, event.lane_pdf);
}
/// The share of a packet that an event keeps, the same whichever lane is the hero.
[[nodiscard]] inline float kept_by(const BsdfSample& event) {
  return event.weight.max() / event.lane_pdf.max();
}
/// Takes the polarisation of a packet that carries any through the same event, whose Mueller matrix is
/// nothing where it depolarises; light travels along `travels` on that side of it on which the packet was.
/// What the event leaves of unpolarised light becomes what it leaves of the packet's.
inline void polarise(PathPacket& packet, const std::optional<MuellerMatrix>& matrix,
                     const Imath::V3f& travels, TransportMode mode) {
  packet.throughput *= packet.polarisation->pass(matrix, travels, mode);
}
/// Goes on with a probability that is the same for all lanes.
inline void survive(PathPacket& packet, float probability) {
  packet.throughput *= 1 / probability;
}

}  // namespace abbe
