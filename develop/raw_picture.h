#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "develop/develop.h"
#include "develop/film_sensor.h"
#include "io/diagnostics.h"
#include "io/raw_picture.h"

namespace abbe {

/// The contents of a raw file for a film that was read out; the sensor must have a readout. The colour
/// matrices are the calibrated ones of `sensor.lights`. If there are none, they are computed from the
/// display's transform to XYZ, which needs `sensor.display` and three channels. Otherwise the file has no
/// colour matrices.
[[nodiscard]] RawPicture raw_picture(const DevelopedFilm& developed, const FilmSensor& sensor);

/// Matrices of a camera for DNG files under two illuminants, in the order of the file, which has the warmer
/// first.
struct DngProfile {
  std::string camera;  ///< Argument of `abbe calibrate --camera`; empty if the file does not record it.
  std::vector<RawLight> lights;
};

/// Reads a `dng.json` written by `abbe calibrate`. Empty after an error: it must have two illuminants with
/// their matrices and an Exif code, from which raw converters take the temperature.
[[nodiscard]] std::optional<DngProfile> read_dng_profile(const std::filesystem::path& path,
                                                         Diagnostics& diagnostics);

/// Throws Error{input} if the profile read from `path` belongs to another camera than the sensor's.
/// - A profile without a camera fits every sensor.
/// - A sensor with a `measured_camera` needs a profile of that camera. Curve files are compared by file name,
///   in any folder.
/// - A sensor whose channels the scene defines needs a profile of a camera that is not in `data/camera`, or
///   whose name occurs in `sensor.description`.
void require_same_camera(const DngProfile& profile, const FilmSensor& sensor,
                         const std::filesystem::path& path);

}  // namespace abbe
