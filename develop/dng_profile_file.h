#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "develop/film_sensor.h"
#include "io/diagnostics.h"
#include "io/raw_picture.h"

namespace abbe {

/// Matrices of a camera for DNG files under two illuminants, the warmer first.
struct DngProfile {
  std::string camera;  ///< Argument of `abbe calibrate --camera`; empty if the file does not record it.
  std::vector<RawLight> lights;
};

/// Reads a `dng.json` written by `abbe calibrate`. Reports an input error if the file does not have two
/// illuminants with their matrices. Also reports an illuminant without an Exif code, because raw converters
/// take its temperature from the code. The result is then empty.
[[nodiscard]] std::optional<DngProfile> read_dng_profile(const std::filesystem::path& path,
                                                         Diagnostics& diagnostics);

/// Throws Error{input} naming `path` if the profile belongs to a camera other than the sensor's. A profile of
/// a camera in `data/camera` does not fit a sensor whose channels are not that camera's either.
void require_same_camera(const DngProfile& profile, const FilmSensor& sensor,
                         const std::filesystem::path& path);

}  // namespace abbe
