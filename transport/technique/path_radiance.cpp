#include "transport/technique/path.h"

#include <type_traits>

#include "transport/path/polarised_ends.h"

// Path tracing: contributions and their exposure.

namespace abbe {

// Stokes vector that the sensor measures of light from `wi` scattered by an event with this matrix, relative
// to an unpolarised estimate.
StokesSpectrum PathTracer::measure(const CameraPath& path, const std::optional<MuellerMatrix>& matrix,
                                   const Light& light, const Imath::V3f& wi) {
  const Polarisation rows =
      path.packet.polarisation->through(matrix, light_travels(path.ray.direction, kMode), kMode);
  return rows.of(emitted_polarisation(light, -wi), -wi);
}

// Adds a contribution; `measured` is the polarised estimate of a contribution of 1, if polarisation is
// carried.
void PathTracer::add(CameraPath& path, const ContributionInfo& info, const SampledSpectrum& contribution,
                     float cos_film, const StokesSpectrum* measured) {
  with_measurement(measures_polarisation_, contribution, measured, [&](const auto& light) {
    if constexpr (std::is_same_v<decltype(light), const StokesSpectrum&>)
      add_to(stokes_[path.index], path, info, light, cos_film);
    else
      add_to(batch_.paths()[path.index].radiance, path, info, light, cos_film);
  });
}

// Direct light on a probe and light in a direction of the guide have their own angle of incidence.
template <typename Contribution>
void PathTracer::add_to(Contribution& radiance, CameraPath& path, const ContributionInfo& info,
                        const Contribution& contribution, float cos_film) {
  const bool adds_to_path = !response_.angular() || cos_film == batch_.paths()[path.index].at.cos_film;
  if (adds_to_path) radiance += contribution;
  if (adds_to_path && !layer_sink_) return;
  FilmPoint at = path.at;
  at.cos_film = cos_film;
  response_.expose(at, path.packet.wavelengths, contribution * path.scale,
                   [&](const FilmPoint& pixel, std::span<const double> values) {
                     if (layer_sink_) layer_sink_(first_ + path.index, pixel, info, values);
                     if (!adds_to_path) (*deposit_)(first_ + path.index, pixel, values);
                   });
}

// Exposes the sum of a path that has ended.
void PathTracer::expose(const CameraPath& path) {
  if (measures_polarisation_)
    expose(path, stokes_[path.index] * path.scale);
  else
    expose(path, path.radiance * path.scale);
}

template <typename Contribution>
void PathTracer::expose(const CameraPath& path, const Contribution& radiance) {
  response_.expose(path.at, path.packet.wavelengths, radiance,
                   [&](const FilmPoint& at, std::span<const double> values) {
                     (*deposit_)(first_ + path.index, at, values);
                   });
}

}  // namespace abbe
