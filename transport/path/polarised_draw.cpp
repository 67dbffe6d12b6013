#include "transport/path/polarised_draw.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/bsdf/event.h"
#include "scene/shapes/basis.h"

namespace abbe {
namespace {

float factor(const PathPacket& packet, const std::optional<MuellerMatrix>& matrix, const Imath::V3f& along,
             TransportMode mode, int lane) {
  return packet.polarisation->through(matrix, light_travels(along, mode), mode).of_unpolarised().i[lane];
}

// Solves phi + [a sin 2 phi + b (1 - cos 2 phi)]/2 = x in [0, 2 pi) with a^2 + b^2 <= 1. The left side
// increases with phi and differs from it by at most 1.
float solve_azimuth(float a, float b, float x) {
  constexpr int kSteps = 30;
  float low = x - 1;
  float high = x + 1;
  float phi = x;
  for (int step = 0; step < kSteps; ++step) {
    const float value = phi + (a * std::sin(2 * phi) + b * (1 - std::cos(2 * phi))) / 2 - x;
    if (std::abs(value) < 1e-6F) break;
    (value > 0 ? high : low) = phi;
    const float newton = phi - value / (1 + a * std::cos(2 * phi) + b * std::sin(2 * phi));
    phi = newton > low && newton < high ? newton : (low + high) / 2;
  }
  return phi;
}

}  // namespace

bool samples_polarised(const Bsdf& bsdf) {
  return std::holds_alternative<DielectricBsdf>(bsdf);
}

float polarised_reflectance(const PathPacket& packet, const SurfaceVertex& vertex, const Imath::V3f& along,
                            TransportMode mode, int lane) {
  const float unpolarised_reflectance = std::get<DielectricBsdf>(vertex.bsdf).reflectance(vertex.wo, lane);
  if (unpolarised_reflectance >= 1) return 1;
  const auto mirror = vertex.mueller(mirrored(vertex.wo), true, lane);
  return std::min(1.0F, unpolarised_reflectance * factor(packet, mirror, along, mode, lane));
}

float polarised_choice(const PathPacket& packet, const SurfaceVertex& vertex, const Imath::V3f& along,
                       TransportMode mode, float u) {
  const float unpolarised_reflectance =
      std::get<DielectricBsdf>(vertex.bsdf).reflectance(vertex.wo, packet.hero);
  if (unpolarised_reflectance >= 1) return u;
  const float reflectance = polarised_reflectance(packet, vertex, along, mode, packet.hero);
  if (u < reflectance) return std::min(u / reflectance, 1 - 1e-6F) * unpolarised_reflectance;
  return unpolarised_reflectance + (u - reflectance) / (1 - reflectance) * (1 - unpolarised_reflectance);
}

PolarisedDirection sample_polarised_phase(const PathPacket& packet, const PhaseFunction& phase,
                                          const Imath::V3f& along, TransportMode mode, const Imath::V2f& u) {
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  const Basis<float> frame(along);
  const auto drawn = [&](float number) {
    const PhaseSample turned = sample(phase, {u.x, number});
    return PolarisedDirection{frame.to_world(turned.direction), turned.pdf};
  };
  const auto excess = [&](float number) {
    return factor(packet, mueller(phase, along, drawn(number).direction), along, mode, packet.hero) - 1;
  };
  const float azimuth = solve_azimuth(excess(0), excess(0.125F), kTurn * u.y);
  return drawn(azimuth / kTurn);
}

float polarise_sampled(PathPacket& packet, const std::optional<MuellerMatrix>& matrix,
                       const Imath::V3f& travels, TransportMode mode) {
  const SampledSpectrum f = packet.polarisation->pass(matrix, travels, mode);
  const float hero = f[packet.hero];
  const SampledSpectrum over = hero > 0 ? f * (1 / hero) : SampledSpectrum();
  advance(packet, over, over);
  return hero;
}

}  // namespace abbe
