#include "description/render.h"

#include "description/render_limits.h"

namespace abbe::spec {

using namespace schema;

Fields fields(Tag<Render>) {
  return describe(
      "render", "How to render.",
      {defaulted("integrator", &Render::integrator,
                 word<Integrator>("integrator", {kIntegratorNames.begin(), kIntegratorNames.end()}),
                 "Which techniques find the light."),
       defaulted("samples", &Render::samples, {1, kMaxSamples}, "Samples per pixel."),
       field("max_depth", &Render::max_depth, {1, 100000},
             "Events a path may have between camera and light, at surfaces and within matter; without it "
             "chance alone ends paths."),
       defaulted("roulette_depth", &Render::roulette_depth, {-1, 10000},
                 "Events before Russian roulette; -1 never plays it, and needs `max_depth`."),
       defaulted("seed", &Render::seed, {0, kMaxSeed}, "Chooses the random numbers.")});
}

}  // namespace abbe::spec

namespace abbe::description {

RenderSettings build(const spec::Render& render, Diagnostics& diagnostics) {
  if (render.roulette_depth.value < 0 && !render.max_depth)
    diagnostics.error(render.roulette_depth.where,
                      "ends no path, so that max_depth must (got -1 without a max_depth)");
  return {render.integrator, render.samples, render.max_depth, render.roulette_depth.value, render.seed};
}

}  // namespace abbe::description
