#pragma once

#include "develop/develop.h"
#include "io/raw_picture.h"

namespace abbe {

/// The contents of a raw file for a film that was read out. Its colour matrices invert the film's own
/// transform to XYZ.
[[nodiscard]] RawPicture raw_picture(const DevelopedFilm& developed, const FilmSensor& sensor);

}  // namespace abbe
