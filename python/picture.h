#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "develop/film_sensor.h"
#include "io/image.h"
#include "python/film.h"

namespace abbe::python {

/// The picture of a sensor's planes `calibrated` (`DevelopedFilm`) on the sRGB display of `abbe render`:
/// channels R, G and B, or one of grey, as code values in [0, 1]. Throws Error{usage} if no display can show
/// it.
[[nodiscard]] Image display_picture(const FilmSensor& sensor, const Image& calibrated);
/// The picture of a film's expected exposure, without sensor noise, on that display. Throws Error{usage} if
/// no display can show it, and InvalidInput if the film does not describe its sensor.
[[nodiscard]] Image display_picture(const FilmHandle& film);

/// The picture as bytes of a PNG, which Jupyter requests. None if no display can show it; Jupyter then shows
/// text.
[[nodiscard]] pybind11::object png_of(const FilmSensor& sensor, const Image& calibrated);

/// Adds `picture` and the PNG for Jupyter to the class of films.
void add_pictures(pybind11::class_<FilmHandle, std::shared_ptr<FilmHandle>>& film);

}  // namespace abbe::python
