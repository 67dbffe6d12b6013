#include "python/picture.h"

#include <utility>

#include <pybind11/numpy.h>

#include "develop/develop.h"
#include "develop/radiance.h"
#include "io/picture.h"
#include "python/errors.h"
#include "sensor/film/recorded_attributes.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

ExposedFilm exposed(const Image& film) {
  constexpr const char* kWhere = "film";
  if (is_spectral(film)) return observed_film(spectral_image(film, kWhere), kWhere, {}, {});
  Diagnostics diagnostics;
  std::optional<FilmSensor> sensor =
      read_film_sensor(film, kWhere, {}, {}, recorded_white(film), diagnostics);
  require_no_errors(diagnostics);
  sensor->readout.reset();  // the expected exposure, without noise
  return {film, *std::move(sensor)};
}

py::object picture(const FilmHandle& film) {
  const Image image = display_picture(film);
  std::vector<std::string> names;
  for (const ImageChannel& channel : image.channels) names.push_back(channel.name);
  return planes_of(image, names);
}

py::object png(const FilmHandle& film) {
  const ExposedFilm source = exposed(film.image());
  return png_of(source.sensor, develop(source, 0).calibrated);
}

}  // namespace

Image display_picture(const FilmSensor& sensor, const Image& calibrated) {
  require_display(sensor);
  const Image planes = display_planes(sensor, calibrated);
  return (*sensor.display)(planes, 1 / display_white(sensor, planes)).image;
}

Image display_picture(const FilmHandle& film) {
  const ExposedFilm source = exposed(film.image());
  return display_picture(source.sensor, develop(source, 0).calibrated);
}

py::object png_of(const FilmSensor& sensor, const Image& calibrated) {
  if (!sensor.display) return py::none();
  return py::bytes(encoded_picture(".png", display_picture(sensor, calibrated)));
}

void add_pictures(py::class_<FilmHandle, std::shared_ptr<FilmHandle>>& film) {
  film.def("picture", picture,
           "Returns the picture of the film on an sRGB display: rows, columns, and R, G, B or grey, as code "
           "values in [0, 1]. Raises UsageError for a film that no display can show.")
      .def("_repr_png_", png);
}

}  // namespace abbe::python
