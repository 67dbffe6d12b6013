#pragma once

#include "develop/develop.h"
#include "io/raw_picture.h"

namespace abbe {

/// What a raw file holds of a film that was read out. Its matrix is the inverse of the film's own way to
/// colour.
[[nodiscard]] RawPicture raw_picture(const DevelopedFilm& developed, const FilmSensor& sensor);

}  // namespace abbe
