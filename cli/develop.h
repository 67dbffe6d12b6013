#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "description/load.h"
#include "develop/film_sensor.h"
#include "develop/relight.h"
#include "io/inputs.h"

namespace abbe::cli {

/// Options of `abbe develop`.
struct DevelopOptions {
  std::filesystem::path film;
  std::vector<std::filesystem::path> outputs;  ///< Raw pictures and multi-part images.
  std::filesystem::path display;               ///< Empty when no picture is wanted.
  std::filesystem::path polarisation;          ///< Folder for maps of it; empty when none are wanted.
  std::filesystem::path scene;                 ///< Whose sensor looks at a spectral film; else empty.
  std::vector<Override> overrides;             ///< Of the read-out and the white.
  std::optional<std::string> white;            ///< What pictures show as white, as output/white of a scene.
  std::vector<LightFactor> lights;             ///< That count otherwise than in the film.
  std::optional<double> exposure_s;            ///< Of the sensor; that of the film when absent.
  std::optional<double> iso;                   ///< Speed of the sensor, in place of its gain.
  std::optional<CalibrationFrame> frame;       ///< What the camera sees instead of the scene.
  std::uint32_t frames = 1;                ///< Exposures of one film, numbered in the files' names if more.
  std::optional<double> display_exposure;  ///< Film value shown as white.
  std::filesystem::path exposure_of;  ///< Film whose display exposure pictures take; empty for their own.
  bool flattens_field = false;        ///< True to balance white over the field, not for its centre alone.
  ViewOptions view;                   ///< Of the display.
  std::filesystem::path profile;      ///< Matrices of a calibration for a DNG; else empty.
  std::optional<std::uint64_t> seed;  ///< Of the noise; that of the render when absent.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// A film to digital numbers, files and pictures without rendering; prints what the sensor's noise and the
/// render's own error are. Returns the exit code.
int develop(const DevelopOptions& options);

}  // namespace abbe::cli
