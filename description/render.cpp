#include "description/render.h"

#include <fmt/format.h>

#include "description/kinds.h"
#include "description/render_limits.h"

namespace abbe::spec {

using namespace schema;

Fields fields(Tag<Photons>) {
  return describe(
      "photons",
      "How photons are traced and gathered, by integrators that do it otherwise than `auto`, `light` and "
      "`bdpt`. Radii shrink from sample to sample.",
      {field("per_sample", &Photons::per_sample, {1, kMaxPhotons},
             "Photons of a sample, but of `vcm`, which traces as many as there are pixels; when absent the "
             "same, but at least 16384."),
       field("radius", &Photons::radius, kLength,
             "Radius of the first gathering; such that one photon would lie within, were all spread evenly "
             "over a ball around the scene, when absent."),
       defaulted("nearest", &Photons::nearest, {1, 100000},
                 "Photons that an estimate of `photon-map` is made of."),
       defaulted(
           "final_gather", &Photons::final_gather,
           "Whether `photon-map` looks at its photons one event after the first surface that scatters, and "
           "there only at those of caustics.")});
}

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
       defaulted("seed", &Render::seed, {0, kMaxSeed}, "Chooses the random numbers."),
       field("photons", &Render::photons),
       defaulted(
           "consistent", &Render::consistent,
           "Whether `auto` may choose `vcm`, which blurs ever less from sample to sample, where light is "
           "found by nothing else."),
       defaulted(
           "polarisation", &Render::polarisation, word<Polarising>("polarisation", {"auto", "off"}),
           "Whether paths carry the polarisation of light, which `auto` does where it matters. Without it "
           "all "
           "light counts as unpolarised at every event: a prism of N-BK7 at minimum deviation is then .3 % "
           "too "
           "dark, one of N-SF11 3 %, and crossed mirrors near Brewster's angle are wrong by any factor."),
       defaulted("directions", &Render::directions,
                 word<DirectionSampling>("directions", {"bsdf", "cosine", "uniform"}),
                 "By what `path` draws directions after an event at a surface that is not of a single "
                 "direction: its scattering, the cosine, or none. `cosine` and `uniform` are over the side "
                 "seen, or over both where light may come through."),
       defaulted("lights", &Render::lights, word<LightStrategy>("lights", {"mis", "bsdf", "light"}),
                 "How `path` finds light after such an event or one within matter: by following scattering "
                 "and by connecting, both weighed; by scattering alone, which no lamp at a point is met by; "
                 "or by connecting alone."),
       defaulted("heuristic", &Render::heuristic, word<MisHeuristic>("heuristic", {"balance", "power"}),
                 "Whether `mis` weighs both ways by their densities, or by the squares of these.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

// How `path` is to draw its paths; what it is told and does not use is refused.
PathSampling sampling_of(const spec::Render& render, Diagnostics& diagnostics) {
  const PathSampling sampling{render.directions.value, render.lights.value, render.heuristic.value};
  const PathSampling usual;
  const auto refuse_for_others = [&](bool told, const SourcePosition& where) {
    if (told && render.integrator != Integrator::path)
      diagnostics.error(where,
                        fmt::format("says how the integrator \"path\" draws its paths (got it with \"{}\")",
                                    integrator_name(render.integrator)));
  };
  refuse_for_others(sampling.directions != usual.directions, render.directions.where);
  refuse_for_others(sampling.lights != usual.lights, render.lights.where);
  refuse_for_others(sampling.heuristic != usual.heuristic, render.heuristic.where);
  if (sampling.heuristic != usual.heuristic && sampling.lights != LightStrategy::mis)
    diagnostics.error(render.heuristic.where,
                      "weighs two ways to a light, of which \"lights\" leaves one (allowed with \"mis\")");
  return sampling;
}

}  // namespace

RenderSettings build(const spec::Render& render, double unit_m, Diagnostics& diagnostics) {
  if (render.roulette_depth.value < 0 && !render.max_depth)
    diagnostics.error(render.roulette_depth.where,
                      "ends no path, so that max_depth must (got -1 without a max_depth)");
  RenderSettings settings{render.integrator, render.samples, render.max_depth, render.roulette_depth.value,
                          render.seed};
  if (const auto& photons = render.photons) {
    settings.photons = {photons->per_sample, photons->radius, photons->nearest, photons->final_gather};
    if (photons->radius) *settings.photons.radius_m *= unit_m;
  }
  settings.consistent = render.consistent.value;
  if (settings.consistent && render.integrator != Integrator::automatic)
    diagnostics.error(render.consistent.where,
                      fmt::format("lets the integrator \"auto\" choose among more (got it with \"{}\")",
                                  integrator_name(render.integrator)));
  settings.polarisation = render.polarisation == spec::Polarising::automatic;
  settings.sampling = sampling_of(render, diagnostics);
  return settings;
}

}  // namespace abbe::description
