#pragma once

#include "develop/develop.h"
#include "io/raw_picture.h"

namespace abbe {

/// The contents of a raw file for a film that was read out; the sensor must have a readout. The colour
/// matrices are the calibrated ones of `sensor.lights`. If there are none, they are computed from the
/// display's transform to XYZ, which needs `sensor.display` and three channels. Otherwise the file has no
/// colour matrices.
[[nodiscard]] RawPicture raw_picture(const DevelopedFilm& developed, const FilmSensor& sensor);

}  // namespace abbe
