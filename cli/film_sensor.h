#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/output/display.h"
#include "io/image.h"
#include "scene/description/load.h"
#include "transport/render/part.h"

namespace abbe::cli {

/// What a film's file tells of the sensor behind it: all that it takes to go on without its scene.
struct FilmSensor {
  std::vector<std::string> planes;
  std::vector<double> exposure_s;  ///< Of each plane.
  std::optional<Mosaic> mosaic;
  std::vector<std::string> channels;  ///< The planes, or the channels of the mosaic.
  double gathering_area_m2 = 0;
  std::optional<Readout> readout;
  std::optional<double> electrons_per_lx_s;  ///< Of a pixel of the most sensitive channel, in daylight.
  std::optional<DisplayTransform> display;
  std::optional<double> display_exposure;  ///< Film value shown as white.
};

/// What a scene's sensor adds to the metadata of its films.
[[nodiscard]] FilmIdentity sensor_identity(const Scene& scene);

/// The reverse, from a film's metadata, after `--set /readout/...=` replaced values of the sensor's
/// description, its pictures showing `white` as white if one is given. Throws Error{input} naming `path` when
/// something is missing, Error{usage} for a `--set` of what a render has used already.
[[nodiscard]] FilmSensor film_sensor(const Image& film, const std::filesystem::path& path,
                                     std::span<const Override> overrides, const ViewOptions& view,
                                     std::optional<Chromaticity> white = {});

/// Takes what `shown_film` gives to pictures. Throws what `make_display` throws.
[[nodiscard]] DisplayTransform display_of(const Scene& scene, const ViewOptions& view = {});

/// A film as its file holds it: of a spectral sensor, radiances in the spectral layout and a preview R, G, B
/// [cd/m^2]; of any other its planes.
[[nodiscard]] Image film_image(const RenderPart& part);
/// What a display shows of it: of a mosaic, a plane for each channel.
[[nodiscard]] Image shown_film(const Scene& scene, const RenderPart& part);

}  // namespace abbe::cli
