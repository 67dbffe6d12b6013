#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "description/load.h"
#include "io/inputs.h"
#include "io/text.h"
#include "scene/scene.h"
#include "transport/render/choose_integrator.h"

namespace abbe::cli {

/// Options of `abbe info`.
struct InfoOptions {
  std::filesystem::path scene;  ///< Scene file; "-" is standard input.
  std::vector<Override> overrides = {};
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Prints what a scene contains, which features it needs and which it skips. Traces pilot rays to choose the
/// integrator. Returns 0. Throws InvalidInput for an invalid scene; a scene that cannot be rendered only
/// causes a warning.
int info(const InfoOptions& options);

/// Report of `abbe info` in plain text. `scene` must have the integrator of `choice`, the result of
/// `choose_integrator`. Traces pilot rays with one thread per processor.
[[nodiscard]] std::string describe(const Scene& scene, const IntegratorChoice& choice);

/// Prints a note on the error of the image if the scene turns polarisation off and has paths that it affects.
void note_polarisation(const Scene& scene);

/// Options of `abbe convert`.
struct ConvertOptions {
  std::filesystem::path scene;  ///< Scene file; "-" is standard input.
  /// File `.json` to write; by default standard output.
  std::filesystem::path output = kStandardStream;
  /// File of materials that replace those of another renderer's scene, by name.
  std::optional<std::filesystem::path> materials = {};
  std::vector<Override> overrides = {};
  std::size_t max_memory_bytes = default_memory_limit();
};

/// Writes a scene file in canonical form, or a scene of another renderer (see `convert_scene`) as a scene
/// file. Returns 0. Throws Error{usage} if the output is in another folder than the files that a scene file
/// names by relative paths. Throws it also for options that do not apply to this kind of scene. Throws
/// InvalidInput for an invalid scene, Error{output} if the output cannot be written.
int convert(const ConvertOptions& options);

}  // namespace abbe::cli
