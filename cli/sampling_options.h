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
  std::optional<int> samples;
  std::optional<double> target_error;
  std::optional<double> time_limit_s;
  std::optional<Integrator> integrator;
  bool consistent = false;  ///< In addition to the scene's setting.
  std::optional<std::uint64_t> seed;
  int threads = 0;
  std::size_t max_memory_bytes = default_memory_limit();
  std::vector<Override> overrides;
  /// Treat problems that invalidate the result as errors. Those of the scene end the command before it starts
  /// (exit code 3). Samples that are not finite end it after the results are written (exit code 70).
  bool strict = false;
  bool quiet = false;
};

/// Applies the options to the settings. Throws Error{usage} if `consistent`, from the options or the scene,
/// is combined with another integrator than `auto`. Throws Error{usage} for an integrator other than the one
/// whose sampling the scene specifies.
void set_sampling(const SamplingOptions& options, RenderSettings& render);

}  // namespace abbe::cli
