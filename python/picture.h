#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "calibration/output/display.h"
#include "python/film.h"

namespace abbe::python {

/// The film as the display of `abbe render` shows it, for sRGB. Throws Error{usage} for a film that no
/// display can show.
[[nodiscard]] DisplayPicture shown(const FilmHandle& film);

/// Adds to films what shows them.
void add_pictures(pybind11::class_<FilmHandle, std::shared_ptr<FilmHandle>>& film);

}  // namespace abbe::python
