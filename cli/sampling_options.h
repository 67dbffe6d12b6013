#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "description/load.h"
#include "io/inputs.h"
#include "transport/render/render.h"

namespace abbe::cli {

/// How light is to be traced; what is absent is as the scene says.
struct SamplingOptions {
  std::optional<int> samples;
  std::optional<double> target_error;
  std::optional<double> time_limit_s;
  std::optional<Integrator> integrator;
  bool consistent = false;  ///< Besides what the scene says.
  std::optional<std::uint64_t> seed;
  int threads = 0;
  std::size_t max_memory_bytes = default_memory_limit();
  std::vector<Override> overrides;
  bool strict = false;  ///< What makes the figures wrong ends the command: of the scene before it starts (3),
                        ///< a sample that was left out after they are written (70).
  bool quiet = false;
};

/// Sets what is asked for. Throws Error{usage} where `consistent`, the scene's too, has nothing to choose,
/// and for another integrator than the one that the scene says how to sample.
void set_sampling(const SamplingOptions& options, RenderSettings& render);

}  // namespace abbe::cli
