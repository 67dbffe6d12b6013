#include "python/picture.h"

#include <pybind11/numpy.h>

#include "develop/develop.h"
#include "develop/radiance.h"
#include "io/picture.h"
#include "python/errors.h"
#include "sensor/film/recorded_white.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

ExposedFilm exposed(const Image& film) {
  constexpr const char* kWhere = "film";
  if (is_spectral(film)) return observed_film(spectral_image(film, kWhere), kWhere, {}, {});
  Diagnostics diagnostics;
  std::optional<FilmSensor> sensor = film_sensor(film, kWhere, {}, {}, recorded_white(film), diagnostics);
  require_sound(diagnostics);
  sensor->readout.reset();  // the exposure as it is expected, without noise
  return {film, *std::move(sensor)};
}

py::object picture(const FilmHandle& film) {
  const Image image = shown(film).image;
  std::vector<std::string> names;
  for (const ImageChannel& channel : image.channels) names.push_back(channel.name);
  return planes_of(image, names);
}

py::object png(const FilmHandle& film) {
  return py::bytes(encoded_picture(".png", shown(film).image));
}

}  // namespace

DisplayPicture shown(const FilmHandle& film) {
  const ExposedFilm source = exposed(film.image());
  const FilmSensor& sensor = source.sensor;
  if (!sensor.display)
    throw Error(ErrorCode::usage, "film", "a picture needs a sensor of one or three channels, and a light");
  const DevelopedFilm developed = develop(source, 0);
  return (*sensor.display)(
      display_planes(sensor, developed.calibrated),
      sensor.display_exposure ? std::optional(1 / *sensor.display_exposure) : std::nullopt);
}

void add_pictures(py::class_<FilmHandle, std::shared_ptr<FilmHandle>>& film) {
  film.def("picture", picture,
           "Returns the film as an sRGB display shows it: rows, columns, and R, G, B or grey, code values in "
           "[0, 1]. "
           "Raises UsageError for a film that no display can show.")
      .def("_repr_png_", png);
}

}  // namespace abbe::python
