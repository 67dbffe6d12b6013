#include "transport/path/polarised_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/bsdf/mirror.h"
#include "scene/scene_features.h"
#include "scene/shapes/ray.h"
#include "sensor/response/polarised_channels.h"

namespace abbe {
namespace {

// First axis of the film's frame: the picture's right, made perpendicular to the direction of the light.
Imath::V3f film_axis(const Scene& scene, const Imath::V3f& travels, float time) {
  const Imath::V3f right = film_right(scene.camera, time).value_or(Imath::V3f(1, 0, 0));
  const Imath::V3f up = across(travels, right);
  return up.cross(travels);
}

// Rows of the Mueller matrix of a real Jones matrix, relative to its first element. The field components are
// E_x = xx e_1 + xy e_2 and E_y = yx e_1 + yy e_2.
//     I' = |E_x|^2 + |E_y|^2,  Q' = |E_x|^2 - |E_y|^2,  U' = 2 Re(E_x E_y*),  V' = det V.
// [Born1999, sec. 10.9]
Polarisation through_lens(const LensJones& of, bool all_elements) {
  const SampledSpectrum x1 = of.xx * of.xx;
  const SampledSpectrum x2 = of.xy * of.xy;
  const SampledSpectrum y1 = of.yx * of.yx;
  const SampledSpectrum y2 = of.yy * of.yy;
  const SampledSpectrum x12 = of.xx * of.xy;
  const SampledSpectrum y12 = of.yx * of.yy;
  const SampledSpectrum half(0.5F);
  const SampledSpectrum none;
  const StokesSpectrum power{SampledSpectrum(1.0F), (x1 - x2 + y1 - y2) * half, x12 + y12, none};
  if (!all_elements) return {of.axis, power};
  return {
      of.axis,
      {power,
       {(x1 + x2 - y1 - y2) * half, (x1 - x2 - y1 + y2) * half, x12 - y12, none},
       {of.xx * of.yx + of.xy * of.yy, of.xx * of.yx - of.xy * of.yy, of.xx * of.yy + of.xy * of.yx, none},
       {none, none, none, of.xx * of.yy - of.xy * of.yx}}};
}

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

bool measures_polarisation(const Scene& scene) {
  return carries_polarisation(scene) && any_analyser(scene.channels);
}

Polarisation polarisation_of_film(const Scene& scene, const Imath::V3f& travels, float time,
                                  const WavelengthImages* images) {
  const bool measures = measures_polarisation(scene);
  if (images != nullptr) return through_lens(images->jones, measures);
  return measures ? Polarisation::all_elements(film_axis(scene, travels, time)) : Polarisation();
}

Polarisation emitted_polarisation(const Light& light, const Imath::V3f& travels) {
  const auto of = polarisation_of(light, travels);
  if (!of) return {};
  return {of->axis, StokesSpectrum{SampledSpectrum(1.0F), SampledSpectrum(of->q), SampledSpectrum(of->u),
                                   SampledSpectrum(of->v)}};
}

std::optional<StokesSpectrum> measured_on_film(const Scene& scene, const PathPacket& packet,
                                               const Imath::V3f& travels, float time,
                                               const WavelengthImages* images) {
  if (!packet.polarisation) return std::nullopt;
  return polarisation_of_film(scene, travels, time, images).of(*packet.polarisation, travels);
}

std::optional<StokesSpectrum> measured_emission(const Light& light, const PathPacket& packet,
                                                const Imath::V3f& towards) {
  if (!packet.polarisation) return std::nullopt;
  return packet.polarisation->of(emitted_polarisation(light, -towards), -towards);
}

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
