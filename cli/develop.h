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
  std::vector<std::filesystem::path> outputs;  ///< Raw files and multi-part images.
  std::filesystem::path display;               ///< Display picture; empty for none.
  std::filesystem::path polarisation;          ///< Folder for maps of the polarisation; empty for none.
  std::filesystem::path scene;            ///< Scene whose sensor records a spectral film; otherwise empty.
  std::vector<Override> overrides;        ///< Overrides of the read-out and of the white.
  std::optional<std::string> white;       ///< White of the pictures, as output/white of a scene.
  std::vector<LightFactor> lights;        ///< Lights that are weighted differently from the film.
  std::optional<double> exposure_s;       ///< Exposure time of the sensor; that of the film without a value.
  std::optional<double> iso;              ///< Sensitivity of the sensor, instead of its gain.
  std::optional<CalibrationFrame> frame;  ///< Calibration frame that replaces the scene.
  std::uint32_t frames = 1;  ///< Number of simulated exposures; more than one are numbered in the file names.
  std::optional<double> display_exposure;  ///< Film value that is displayed as white.
  std::filesystem::path exposure_of;  ///< Film whose display exposure the pictures use; empty for their own.
  /// Balance white at every position of the field instead of at its centre only.
  bool flattens_field = false;
  ViewOptions view;                   ///< View of the display.
  std::filesystem::path profile;      ///< Calibration whose matrices a DNG uses; otherwise empty.
  std::optional<std::uint64_t> seed;  ///< Seed of the noise; that of the render without a value.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Converts a film to digital numbers, files and pictures without rendering. Prints the sensor's noise and
/// the error of the render. Returns the exit code.
int develop(const DevelopOptions& options);

}  // namespace abbe::cli
