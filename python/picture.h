#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "develop/film_sensor.h"
#include "io/image.h"
#include "python/film.h"

namespace abbe::python {

/// What a sensor sees as the display of `abbe render` shows it, for sRGB. Throws Error{usage} where none can.
[[nodiscard]] Image display_picture(const FilmSensor& sensor, const Image& calibrated);
/// The film as that display shows it, likewise.
[[nodiscard]] Image display_picture(const FilmHandle& film);

/// The picture as Jupyter asks for it, in a PNG; None where no display can show it, so that text stands for
/// it.
[[nodiscard]] pybind11::object png_of(const FilmSensor& sensor, const Image& calibrated);

/// Adds to films what shows them.
void add_pictures(pybind11::class_<FilmHandle, std::shared_ptr<FilmHandle>>& film);

}  // namespace abbe::python
