#include "transport/path/polarised_ends.h"

#include "scene/polarisation_need.h"
#include "sensor/response/stokes_channels.h"

namespace abbe {
namespace {

// The picture's right, made perpendicular to the way of the light.
Imath::V3f film_axis(const Scene& scene, const Imath::V3f& travels, float time) {
  const Imath::V3f right = film_right(scene.camera, time).value_or(Imath::V3f(1, 0, 0));
  const Imath::V3f up = across(travels, right);
  return up.cross(travels);
}

}  // namespace

bool measures_polarisation(const Scene& scene) {
  return carries_polarisation(scene) && any_analyser(scene.channels);
}

Polarisation polarisation_of_film(const Scene& scene, const Imath::V3f& travels, float time) {
  return measures_polarisation(scene) ? Polarisation::all_elements(film_axis(scene, travels, time))
                                      : Polarisation();
}

Polarisation polarisation_of_lamp(const Light& light, const Imath::V3f& travels) {
  const auto of = polarisation_of(light, travels);
  if (!of) return {};
  return {of->axis, StokesSpectrum{SampledSpectrum(1.0F), SampledSpectrum(of->q), SampledSpectrum(of->u),
                                   SampledSpectrum(of->v)}};
}

std::optional<StokesSpectrum> seen_of(const Light& light, const PathPacket& packet,
                                      const Imath::V3f& towards) {
  if (!packet.polarisation) return std::nullopt;
  return packet.polarisation->of(polarisation_of_lamp(light, -towards), -towards);
}

StokesSpectrum on_film(const Scene& scene, const Polarisation& light, const Imath::V3f& travels, float time) {
  if (!measures_polarisation(scene)) return light.of_unpolarised();
  return light.in_frame(film_axis(scene, travels, time), travels);
}

}  // namespace abbe
