#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/output/display.h"
#include "cli/sampling_options.h"
#include "preview/page_server.h"

namespace abbe::cli {

/// The layers that a film is to be told apart into.
struct LayerChoice {
  std::optional<int> bounces;       ///< By the number of events, up to this one; else by lights,
  std::vector<std::string> lights;  ///< these, or all where none are named.
};

/// What `abbe render` was asked for; what is absent is as the scene says.
struct RenderOptions : SamplingOptions {
  std::filesystem::path scene;  ///< "-" is standard input.
  std::filesystem::path output;
  std::filesystem::path display;
  ViewOptions view;  ///< Of the display; without a configuration here that of $OCIO, if it is set.
  std::filesystem::path exposure_of;  ///< Film whose display exposure pictures take; empty for their own.
  std::filesystem::path gamut;        ///< Picture of what the display could not show as it is.
  std::filesystem::path stats;        ///< "-" is standard output.
  std::optional<SampleRange> sample_range;
  std::filesystem::path checkpoint;
  double checkpoint_interval_s = 60;
  bool resume = false;  ///< Goes on from the checkpoint where there is one.
  std::optional<Crop> crop;
  std::optional<LayerChoice> layers;
  std::vector<Feature> features;         ///< Of the first surfaces that are met, as channels of the film.
  std::optional<ServerAddress> preview;  ///< Where a page shows the render; nowhere unless asked.
  std::optional<ServerAddress> tev;      ///< Of a viewer that is shown the render; none unless asked.
  bool explain = false;
};

/// Scene file to pictures. Returns the exit code: 0, or 128 plus the signal that stopped the render early,
/// its image and checkpoint written and valid.
int render(const RenderOptions& options);

}  // namespace abbe::cli
