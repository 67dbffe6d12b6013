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
  std::filesystem::path film;  ///< Film, developed film or spectral image to develop (.exr).
  /// Raw files (.dng, .tif, .fits, .png) and multi-part images (.exr).
  std::vector<std::filesystem::path> outputs;
  std::filesystem::path display;       ///< Display picture; empty for none.
  std::filesystem::path polarisation;  ///< Folder for maps of the polarisation; empty for none.
  std::filesystem::path scene;         ///< Scene whose sensor records a spectral film; otherwise empty.
  std::vector<Override> overrides;     ///< Overrides of the read-out and of the white.
  std::optional<std::string> white;    ///< White of the pictures, as output/white of a scene.
  std::vector<LightFactor> lights;     ///< Lights that are weighted differently from the film.
  /// Exposure time of the sensor [s]; that of the film without a value.
  std::optional<double> exposure_s;
  std::optional<double> iso;              ///< ISO speed of the sensor, instead of its gain.
  std::optional<CalibrationFrame> frame;  ///< Calibration frame that replaces the scene.
  std::uint32_t frames = 1;  ///< Number of simulated exposures; more than one are numbered in the file names.
  /// Film value that is displayed as white; without a value that of the film, else chosen from it.
  std::optional<double> display_exposure;
  std::filesystem::path exposure_of;  ///< Film whose display exposure the pictures use; empty for their own.
  /// Balance white at every position of the field instead of at its centre only.
  bool flattens_field = false;
  ViewOptions view;                   ///< View of the display.
  std::filesystem::path profile;      ///< Calibration whose matrices a DNG uses; otherwise empty.
  std::optional<std::uint64_t> seed;  ///< Seed of the noise; that of the render without a value.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;  ///< Print the answer as JSON instead of plain text.
};

/// Converts a film to digital numbers, files and pictures without rendering. Prints the sensor's noise and
/// the error of the render for the first exposure. Returns 0. All outputs are tried, even if one fails.
/// Throws Error{usage} for options that have no effect or do not apply to the film. Throws Error{input} or
/// InvalidInput for invalid inputs, Error{output} for the first output that failed, Error{resource} above
/// `max_memory_bytes`.
int develop(const DevelopOptions& options);

}  // namespace abbe::cli
