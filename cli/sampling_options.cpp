#include "cli/sampling_options.h"

#include <fmt/format.h>

#include "io/error.h"

namespace abbe::cli {

void set_sampling(const SamplingOptions& options, RenderSettings& render) {
  render.samples = options.samples.value_or(render.samples);
  render.integrator = options.integrator.value_or(render.integrator);
  render.seed = options.seed.value_or(render.seed);
  const bool by_scene = render.consistent;
  render.consistent = by_scene || options.consistent;
  if (options.consistent && render.integrator != Integrator::automatic)
    throw Error(ErrorCode::usage, "--consistent",
                fmt::format("lets auto choose among more integrators, and this one is chosen already (got "
                            "--integrator {}, allowed auto)",
                            integrator_name(render.integrator)));
  if (by_scene && render.integrator != Integrator::automatic)
    throw Error(ErrorCode::usage, "--integrator",
                fmt::format("the scene lets \"auto\" choose among more integrators (got {}, allowed auto)",
                            integrator_name(render.integrator)));
  if (render.sampling != PathSampling{} && render.integrator != Integrator::path)
    throw Error(ErrorCode::usage, "--integrator",
                fmt::format("the scene says how \"path\" draws its paths (got {}, allowed path)",
                            integrator_name(render.integrator)));
}

}  // namespace abbe::cli
