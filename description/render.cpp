#include "description/render.h"

#include <fmt/format.h>

#include "description/value_ranges.h"

namespace abbe::spec {

using namespace schema;

static Fields fields(Tag<Photons>) {
  return describe("photons",
                  "Settings of photon tracing for integrators other than `auto`, `light` and `bdpt`. Radii "
                  "shrink from sample to sample.",
                  {field("per_sample", &Photons::per_sample, {1, kMaxPhotons},
                         "Photons per sample. `vcm` always traces as many as there are pixels. If absent, "
                         "the number of pixels, but at least 16384."),
                   field("radius", &Photons::radius, kLength,
                         "Initial gathering radius. If absent, the radius in which one photon would lie if "
                         "all were spread evenly over a ball around the scene."),
                   defaulted("nearest", &Photons::nearest, {1, 100000},
                             "Number of nearest photons in an estimate of `photon-map`."),
                   defaulted("final_gather", &Photons::final_gather,
                             "True if `photon-map` gathers one event after the first scattering surface, and "
                             "only caustic photons at that surface.")});
}

Fields fields(Tag<Render>) {
  return describe(
      "render", "Settings of the render.",
      {defaulted("integrator", &Render::integrator,
                 enumeration<Integrator>("integrator", {kIntegratorNames.begin(), kIntegratorNames.end()}),
                 "Integrator that estimates the film."),
       defaulted("samples", &Render::samples, {1, kMaxSamples}, "Samples per pixel."),
       field("max_depth", &Render::max_depth, {1, 100000},
             "Largest number of scattering events of a path, at surfaces and in media. If absent, only "
             "Russian roulette ends paths."),
       defaulted("roulette_depth", &Render::roulette_depth, {-1, 10000},
                 "Number of events before Russian roulette begins. -1 disables it and needs `max_depth`."),
       defaulted("seed", &Render::seed, {0, kMaxSeed}, "Seed of the random numbers."),
       field("photons", &Render::photons),
       defaulted("consistent", &Render::consistent,
                 "True to let `auto` choose `vcm` for light paths that no unbiased integrator can sample. "
                 "Its blur vanishes with the number of samples."),
       defaulted("polarisation", &Render::polarisation,
                 enumeration<PolarisationMode>("polarisation", {"auto", "off"}),
                 "Polarisation of light along paths; `auto` tracks it where it matters. With `off` all light "
                 "counts as unpolarised at every event. Then a prism at minimum deviation is too dark: one "
                 "of N-BK7 by 0.3 %, one of N-SF11 by 3 %. Crossed mirrors near Brewster's angle have "
                 "arbitrary errors."),
       defaulted("directions", &Render::directions,
                 enumeration<DirectionSampling>("directions", {"bsdf", "cosine", "uniform"}),
                 "Distribution from which `path` samples directions at a non-specular surface: the BSDF, the "
                 "cosine, or a uniform one. `cosine` and `uniform` cover the visible side, or both sides if "
                 "the surface transmits."),
       defaulted("lights", &Render::lights, enumeration<LightStrategy>("lights", {"mis", "bsdf", "light"}),
                 "Techniques by which `path` reaches lights after a non-specular event. `mis` combines BSDF "
                 "sampling and next-event estimation. `bsdf` uses BSDF sampling alone, which never hits "
                 "point lights. `light` uses next-event estimation alone."),
       defaulted("heuristic", &Render::heuristic,
                 enumeration<MisHeuristic>("heuristic", {"balance", "power"}),
                 "MIS heuristic: weights by the pdfs, or by their squares.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

// Path sampling options. Reports options that the integrator does not use.
PathSampling sampling_of(const spec::Render& render, Diagnostics& diagnostics) {
  const PathSampling sampling{render.directions.value, render.lights.value, render.heuristic.value};
  const PathSampling defaults;
  const auto refuse_for_others = [&](bool is_set, const SourcePosition& where) {
    if (is_set && !traits(render.integrator).sampling_options)
      diagnostics.error(where, fmt::format("is an option of the integrator \"path\" (got it with \"{}\")",
                                           integrator_name(render.integrator)));
  };
  refuse_for_others(sampling.directions != defaults.directions, render.directions.where);
  refuse_for_others(sampling.lights != defaults.lights, render.lights.where);
  refuse_for_others(sampling.heuristic != defaults.heuristic, render.heuristic.where);
  if (sampling.heuristic != defaults.heuristic && sampling.lights != LightStrategy::mis)
    diagnostics.error(
        render.heuristic.where,
        "combines two sampling techniques, of which \"lights\" uses only one (allowed with \"mis\")");
  return sampling;
}

}  // namespace

RenderSettings build(const spec::Render& render, double unit_m, Diagnostics& diagnostics) {
  if (render.roulette_depth.value < 0 && !render.max_depth)
    diagnostics.error(render.roulette_depth.where,
                      "never ends a path, and then max_depth is required (got -1 without a max_depth)");
  RenderSettings settings{render.integrator, render.samples, render.max_depth, render.roulette_depth.value,
                          render.seed};
  if (const auto& photons = render.photons) {
    settings.photons = {photons->per_sample, photons->radius, photons->nearest, photons->final_gather};
    if (photons->radius) *settings.photons.radius_m *= unit_m;
  }
  settings.consistent = render.consistent.value;
  if (settings.consistent && render.integrator != Integrator::automatic)
    diagnostics.error(render.consistent.where,
                      fmt::format("is an option of the integrator \"auto\" (got it with \"{}\")",
                                  integrator_name(render.integrator)));
  settings.polarisation = render.polarisation == spec::PolarisationMode::automatic;
  settings.sampling = sampling_of(render, diagnostics);
  return settings;
}

}  // namespace abbe::description
