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
#include "transport/render/choose_integrator.h"
#include "transport/render/render.h"

namespace abbe::cli {

/// Options of `render` and `meter`, which their help explains. Values that are absent are those of the scene.
struct SamplingOptions {
  std::optional<int> samples;
  abbe::RenderOptions render;  ///< Without layers, callbacks and guiding data.
  std::optional<Integrator> integrator;
  bool consistent = false;
  std::optional<std::uint64_t> seed;
  std::size_t max_memory_bytes = default_memory_limit();
  std::vector<Override> overrides;
  /// Treat problems that invalidate the result as errors. Problems of the scene end the command before it
  /// renders (exit code 3). Samples that are not finite end it after the results are written (exit code 70).
  bool strict = false;
  bool quiet = false;
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
  std::filesystem::path scene;
  std::filesystem::path output;
  std::filesystem::path display;
  ViewOptions view;  ///< The configuration defaults to that of $OCIO.
  std::filesystem::path exposure_of;
  std::filesystem::path gamut;
  std::filesystem::path stats;  ///< "-" is standard output.
  std::filesystem::path checkpoint;
  bool resume = false;
  std::optional<LayerChoice> layers;
  std::optional<ServerAddress> preview;
  std::optional<ServerAddress> tev;
  bool explain = false;
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

/// Report of `abbe info` in plain text. `scene` must have the integrator of `choice`, the result of
/// `choose_integrator`. Traces pilot rays with one thread per processor.
[[nodiscard]] std::string describe(const Scene& scene, const IntegratorChoice& choice);

/// Prints a note on the error of the image if the scene turns polarisation off and has paths that it affects.
void note_polarisation(const Scene& scene);

}  // namespace abbe::cli
