#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/output/display.h"
#include "description/load.h"
#include "io/inputs.h"
#include "preview/page_server.h"
#include "transport/render/render.h"

namespace abbe::cli {

/// Options that control how light is sampled. Values that are absent are those of the scene.
struct SamplingOptions {
  std::optional<int> samples;  ///< Samples per pixel, or per sub-area of a meter.
  /// Relative error at which rendering stops, in (0, 1). It is the median over pixels of a film, or the
  /// largest error of a meter's values.
  std::optional<double> target_error;
  std::optional<double> time_limit_s;  ///< Time after which rendering stops.
  std::optional<Integrator> integrator;
  bool consistent = false;  ///< Allow `auto` to use photon merging, as the scene may do too.
  std::optional<std::uint64_t> seed;
  int threads = 0;  ///< Number of threads; 0 for one per processor.
  std::size_t max_memory_bytes = default_memory_limit();
  std::vector<Override> overrides;  ///< Values of the scene file that are replaced.
  /// Treat problems that invalidate the result as errors. Problems of the scene end the command before it
  /// renders (exit code 3). Samples that are not finite end it after the results are written (exit code 70).
  bool strict = false;
  bool quiet = false;  ///< Print warnings and errors only.
};

/// Replaces samples, integrator and seed of the settings by those of the options that have a value. The
/// settings become `consistent` if the options or the scene are. Throws Error{usage} if `consistent`, from
/// the options or the scene, is combined with another integrator than `auto`. Throws Error{usage} for an
/// integrator other than `path` if the scene has settings of path sampling.
void set_sampling(const SamplingOptions& options, RenderSettings& render);

/// Layers into which a film is separated.
struct LayerChoice {
  /// Maximum number of bounces of layers by path length; without a value the layers are by light.
  std::optional<int> bounces;
  std::vector<std::string> lights;  ///< Names of the lights that have a layer; empty for all.
};

/// Options of `abbe render`. Values that are absent are those of the scene.
struct RenderOptions : SamplingOptions {
  std::filesystem::path scene;  ///< Scene file; "-" is standard input.
  /// Film `.exr` or partial film `.abbepart`; if empty that of the scene, else SCENE.exr.
  std::filesystem::path output;
  std::filesystem::path display;      ///< Picture for a display; if empty that of the scene, if any.
  ViewOptions view;                   ///< View of the display; the configuration defaults to that of $OCIO.
  std::filesystem::path exposure_of;  ///< Film whose display exposure the pictures use; empty for their own.
  /// Picture of the pixels that the display cannot show exactly; empty for none.
  std::filesystem::path gamut;
  std::filesystem::path stats;  ///< JSON of the statistics; "-" is standard output, empty for none.
  std::optional<SampleRange> sample_range;  ///< Samples of every pixel to render; all without a value.
  /// File `.abbepart` in which finished samples are saved; empty for none.
  std::filesystem::path checkpoint;
  double checkpoint_interval_s = 60;  ///< Minimum time between checkpoints.
  bool resume = false;                ///< Continue from the checkpoint if it exists.
  std::optional<Crop> crop;           ///< Pixels to render; the whole film without a value.
  /// Layers to record in addition to the film; none without a value.
  std::optional<LayerChoice> layers;
  std::vector<Feature> features;         ///< Features of the first hits that become channels of the film.
  std::optional<ServerAddress> preview;  ///< Address of a web page that shows the render; none by default.
  std::optional<ServerAddress> tev;      ///< Address of a viewer that receives the render; none by default.
  bool explain = false;                  ///< Print the report of `describe` to stderr first.
};

/// Renders a scene file to films and pictures. Under mpirun all processes render one film, which the root
/// writes. Returns
/// - 0 on success;
/// - 128 plus the number of the signal that stopped the render; the image and the checkpoint are written and
///   valid;
/// - ErrorCode::internal if `strict` is set and samples were discarded because they were not finite.
///
/// Throws Error{usage} for options that contradict one another or the scene, and InvalidInput for an invalid
/// scene. Throws Error{scene} for a scene that cannot be rendered, or that gives a wrong image if `strict` is
/// set. Throws Error{output} before the render if an output cannot be written, Error{resource} above
/// `max_memory_bytes`.
int render(const RenderOptions& options);

}  // namespace abbe::cli
