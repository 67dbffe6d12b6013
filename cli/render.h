#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/output/display.h"
#include "cli/sampling_options.h"
#include "preview/page_server.h"

namespace abbe::cli {

/// Layers into which a film is separated.
struct LayerChoice {
  /// Maximum number of bounces of layers by path length; without a value the layers are by light.
  std::optional<int> bounces;
  std::vector<std::string> lights;  ///< Names of the lights that have a layer; empty for all.
};

/// Options of `abbe render`. Values that are absent are those of the scene.
struct RenderOptions : SamplingOptions {
  std::filesystem::path scene;  ///< Scene file; "-" is standard input.
  std::filesystem::path output;
  std::filesystem::path display;
  ViewOptions view;                   ///< View of the display; the configuration defaults to that of $OCIO.
  std::filesystem::path exposure_of;  ///< Film whose display exposure the pictures use; empty for their own.
  /// Picture of the pixels that the display cannot show exactly; empty for none.
  std::filesystem::path gamut;
  std::filesystem::path stats;  ///< JSON of the statistics; "-" is standard output.
  std::optional<SampleRange> sample_range;
  std::filesystem::path checkpoint;
  double checkpoint_interval_s = 60;
  bool resume = false;  ///< Continue from the checkpoint if it exists.
  std::optional<Crop> crop;
  std::optional<LayerChoice> layers;
  std::vector<Feature> features;         ///< Features of the first hits that become channels of the film.
  std::optional<ServerAddress> preview;  ///< Address of a web page that shows the render; none by default.
  std::optional<ServerAddress> tev;      ///< Address of a viewer that receives the render; none by default.
  bool explain = false;
};

/// Renders a scene file to films and pictures. Returns 0, or 128 plus the number of the signal that stopped
/// the render. In that case the image and the checkpoint are written and valid.
int render(const RenderOptions& options);

}  // namespace abbe::cli
