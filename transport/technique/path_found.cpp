#include "transport/technique/path.h"

#include <type_traits>

#include "transport/path/polarised_ends.h"

// What paths find, and where it falls on the film.

namespace abbe {

// What the sensor measures of light that comes from `wi` and that an event of that matrix sends along the
// path, over what it would measure were all of it unpolarised.
StokesSpectrum PathTracer::measured(const CameraPath& path, const std::optional<MuellerMatrix>& matrix,
                                    const Light& light, const Imath::V3f& wi) {
  const Polarisation rows =
      path.packet.polarisation->through(matrix, light_travels(path.ray.direction, kMode), kMode);
  return rows.of(polarisation_of_lamp(light, -wi), -wi);
}

// The sensor measures `seen` of a contribution of 1, where polarisation is carried.
void PathTracer::add(CameraPath& path, const LightHistory& of, const SampledSpectrum& contribution,
                     float cos_film, const StokesSpectrum* seen) {
  with_seen(measures_polarisation_, contribution, seen, [&](const auto& light) {
    if constexpr (std::is_same_v<decltype(light), const StokesSpectrum&>)
      add_to(found_[path.path], path, of, light, cos_film);
    else
      add_to(walks_.paths()[path.path].found, path, of, light, cos_film);
  });
}

// Light that a meter sees directly, or finds by its guide, comes in under an angle of its own.
template <typename Contribution>
void PathTracer::add_to(Contribution& found, CameraPath& path, const LightHistory& of,
                        const Contribution& contribution, float cos_film) {
  const bool with_others = !response_.angular() || cos_film == walks_.paths()[path.path].at.cos_film;
  if (with_others) found += contribution;
  if (with_others && !apart_) return;
  FilmPoint at = path.at;
  at.cos_film = cos_film;
  response_.expose(at, path.packet.wavelengths, contribution * path.scale,
                   [&](const FilmPoint& pixel, std::span<const double> values) {
                     if (apart_) apart_(first_ + path.path, pixel, of, values);
                     if (!with_others) (*deposit_)(first_ + path.path, pixel, values);
                   });
}

// All of a path that has ended.
void PathTracer::expose(const CameraPath& path) {
  if (measures_polarisation_)
    expose(path, found_[path.path] * path.scale);
  else
    expose(path, path.found * path.scale);
}

template <typename Contribution>
void PathTracer::expose(const CameraPath& path, const Contribution& found) {
  response_.expose(path.at, path.packet.wavelengths, found,
                   [&](const FilmPoint& at, std::span<const double> values) {
                     (*deposit_)(first_ + path.path, at, values);
                   });
}

}  // namespace abbe
