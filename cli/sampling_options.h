#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "description/load.h"
#include "io/inputs.h"
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

}  // namespace abbe::cli
