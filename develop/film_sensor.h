#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/output/display.h"
#include "io/diagnostics.h"
#include "io/image.h"
#include "io/json.h"
#include "sensor/readout/readout.h"
#include "sensor/response/mosaic.h"

namespace abbe {

/// What a film's file tells of the sensor behind it: all that it takes to go on without its scene.
struct FilmSensor {
  std::vector<std::string> planes;
  std::vector<double> exposure_s;  ///< Of each plane.
  std::optional<Mosaic> mosaic;
  std::vector<std::string> channels;  ///< The planes, or the channels of the mosaic.
  double gathering_area_m2 = 0;       ///< Film values times this are what a pixel counts.
  std::optional<Readout> readout;
  std::optional<double> electrons_per_lx_s;  ///< Of a pixel of the most sensitive channel, in daylight.
  std::optional<DisplayTransform> display;
  std::optional<double> display_exposure;  ///< Film value shown as white.
};

/// A film and the sensor it was exposed on.
struct ExposedFilm {
  Image film;
  FilmSensor sensor;
};

/// The sensor that the metadata of a film tell of, after `overrides` of its description's `/readout`; its
/// pictures, made by `view`, show `white` as white if one is given. Reports what is wrong with the read-out
/// and then returns nothing. Throws Error{input} naming `path` when something is missing, Error{usage} for an
/// override of what the render has used already.
[[nodiscard]] std::optional<FilmSensor> film_sensor(const Image& film, const std::filesystem::path& path,
                                                    std::span<const Override> overrides,
                                                    const ViewOptions& view,
                                                    std::optional<Chromaticity> white,
                                                    Diagnostics& diagnostics);

/// Throws Error{usage} unless displays can show what the sensor sees.
void require_display(const FilmSensor& sensor);

/// Throws Error{input} naming `path` unless the film has each plane of the sensor, and its variance.
void require_planes(const Image& film, const FilmSensor& sensor, const std::filesystem::path& path);

}  // namespace abbe
