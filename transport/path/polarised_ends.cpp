#include "transport/path/polarised_ends.h"

#include "scene/polarisation_cause.h"
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

}  // namespace abbe
