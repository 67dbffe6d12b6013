#include "cli/sampling_options.h"

#include <fmt/format.h>

#include "io/error.h"

namespace abbe::cli {

void set_sampling(const SamplingOptions& options, RenderSettings& render) {
  render.samples = options.samples.value_or(render.samples);
  render.integrator = options.integrator.value_or(render.integrator);
  render.seed = options.seed.value_or(render.seed);
  const bool set_by_scene = render.consistent;
  render.consistent = set_by_scene || options.consistent;
  if (options.consistent && render.integrator != Integrator::automatic)
    throw Error(ErrorCode::usage, "--consistent",
                fmt::format("applies to the integrator auto only (got --integrator {}, allowed auto)",
                            integrator_name(render.integrator)));
  if (set_by_scene && render.integrator != Integrator::automatic)
    throw Error(ErrorCode::usage, "--integrator",
                fmt::format("render/consistent of the scene applies to auto only (got {}, allowed auto)",
                            integrator_name(render.integrator)));
  if (render.sampling != PathSampling{} && !traits(render.integrator).sampling_options)
    throw Error(ErrorCode::usage, "--integrator",
                fmt::format("the sampling settings of the scene apply to path only (got {}, allowed path)",
                            integrator_name(render.integrator)));
}

}  // namespace abbe::cli
