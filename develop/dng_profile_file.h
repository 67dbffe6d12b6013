#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "develop/film_sensor.h"
#include "io/diagnostics.h"
#include "io/raw_picture.h"

namespace abbe {

/// The matrices of a camera for DNG files, in two lights, the warmer first.
struct DngProfile {
  std::string camera;  ///< As `abbe calibrate --camera` was given it; empty where the file does not tell.
  std::vector<RawLight> lights;
};

/// Reads a `dng.json` that `abbe calibrate` wrote. Reports, as an input, a file that has not two lights with
/// their matrices, and a light without a number in Exif, by which raw converters know its temperature; then
/// returns nothing.
[[nodiscard]] std::optional<DngProfile> read_dng_profile(const std::filesystem::path& path,
                                                         Diagnostics& diagnostics);

/// Throws Error{input} naming `path` where the profile read from it is of another camera than the sensor's,
/// or of a camera of `data/camera` for a sensor with channels of its own, none of which are that camera's.
void require_same_camera(const DngProfile& profile, const FilmSensor& sensor,
                         const std::filesystem::path& path);

}  // namespace abbe
