#include "cli/render_commands.h"

#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "cli/meter.h"
#include "cli/render.h"

namespace abbe::cli {
namespace {

/// When to stop by the error, and by the time.
struct Stops {
  CLI::Option* error;
  CLI::Option* time;
};

// How many samples, which `per` says of what, and the error and time that stop in their place.
Stops add_samples(CLI::App& app, SamplingOptions& asked, const std::string& per,
                  const std::string& small_error, const std::string& time_of) {
  CLI::Option* spp = add_parsed(app, "--spp", asked.samples, integer_in<int>(1, kMaxSamples), per, "N");
  CLI::Option* error = add_parsed(app, "--error", asked.target_error, parse_share,
                                  "Stop when " + small_error + " is this small, as 0.5% or 0.005", "SHARE");
  CLI::Option* time = add_parsed(
      app, "--time", asked.time_limit_s, parse_seconds,
      "Stop after this time" + time_of + ", as 60s, 2m or 1h; with --error, at whichever comes first",
      "TIME");
  spp->excludes(error)->excludes(time);
  return {error, time};
}

void add_range(CLI::App& render, RenderOptions& asked, const Stops& stops) {
  CLI::Option* range = add_parsed(render, "--sample-range", asked.sample_range, parse_sample_range,
                                  "Render only samples A to B - 1 of every pixel", "A:B");
  range->excludes(stops.error)->excludes(stops.time);
}

// By which technique.
void add_technique(CLI::App& app, SamplingOptions& asked) {
  add_parsed(app, "--integrator", asked.integrator,
             one_of<Integrator>({kIntegratorNames.begin(), kIntegratorNames.end()}), "Technique",
             fmt::format("{}", fmt::join(kIntegratorNames, "|")));
  app.add_flag("--consistent", asked.consistent,
               "Let auto choose what blurs, ever less, where nothing else finds the light");
  add_parsed(app, "--seed", asked.seed, integer_in<std::uint64_t>(0, kMaxSeed), "Seed of the random numbers",
             "N");
  add_parsed(app, "--threads", asked.threads, integer_in<int>(0, kMaxThreads),
             "Threads, 0 for one per processor", "N");
}

// Of which part of the film, and what it tells.
void add_film(CLI::App& render, RenderOptions& asked) {
  add_parsed(render, "--crop", asked.crop, parse_crop, "Part of the film to render, in pixels",
             "X0,Y0,X1,Y1");
  add_parsed(
      render, "--layers", asked.layers, parse_layer_choice,
      "Also tell the film apart, as channels that add up to it: by the lights' names (lights; of some alone "
      "lights:NAME,...) or by the number of events (bounces; N and more in one layer bounces:N, default 8)",
      "lights|bounces");
  add_parsed(
      render, "--aov", asked.features, parse_feature_list,
      "Also tell, of the surface that each pixel sees first, some of: depth (depth.Z), position (P), normal "
      "(N), "
      "shading-normal (Ns), albedo (Albedo), id (Id), and the share of samples that see one (Coverage)",
      "NAME[,NAME...]");
}

void add_checkpoints(CLI::App& render, RenderOptions& asked) {
  CLI::Option* checkpoint =
      render.add_option("--checkpoint", asked.checkpoint, "Where to save what is finished")
          ->type_name("FILE.abbepart");
  add_parsed(render, "--checkpoint-every", asked.checkpoint_interval_s, parse_seconds,
             "How often, at most a hundredth of the time (default 60s)", "TIME")
      ->needs(checkpoint);
  render.add_flag("--resume", asked.resume, "Go on from the checkpoint, if there is one")->needs(checkpoint);
}

void add_pictures(CLI::App& render, RenderOptions& asked) {
  render.add_option("--display", asked.display, "Also write a picture for displays")->type_name("FILE.png");
  render
      .add_option("--screen", asked.view.display,
                  "Display of the picture (default: the configuration's first)")
      ->type_name("NAME");
  render.add_option("--view", asked.view.view, "View on that display (default: its first)")
      ->type_name("NAME");
  render
      .add_option("--ocio", asked.view.config,
                  "OpenColorIO configuration of the picture (default: $OCIO, else Abbe's own)")
      ->type_name("FILE.ocio");
  render
      .add_option(
          "--exposure-of", asked.exposure_of,
          "Show the picture with the exposure of another film of the same sensor, as the first of several "
          "frames")
      ->type_name("FILE.exr");
  render
      .add_option("--gamut", asked.gamut,
                  "Also write, in white, which colours lay outside the display's gamut")
      ->type_name("FILE.png");
}

void add_watchers(CLI::App& render, RenderOptions& asked) {
  add_parsed(render, "--preview", asked.preview, parse_server_address,
             "Show the render on a page while it runs, on a port of this machine (0: any free one) or of an "
             "address",
             "[ADDRESS:]PORT");
  add_parsed(render, "--tev", asked.tev, parse_viewer_address,
             "Show the render in the viewer tev, which listens there", "[HOST:]PORT");
}

}  // namespace

void add_render(CLI::App& app, Command& command) {
  const Sub<RenderOptions> sub(app, "render", "Render a scene", command, render);
  CLI::App& render = *sub.app;
  render.add_option("scene", sub->scene, "Scene file, or - for standard input")
      ->required()
      ->type_name("SCENE");
  render
      .add_option("-o,--output", sub->output,
                  "Film to write, or its exact sums (default: the scene's, else SCENE.exr)")
      ->type_name("FILE.exr|FILE.abbepart");
  const Stops stops =
      add_samples(render, *sub.options, "Samples per pixel", "the median relative error of lit values", "");
  add_range(render, *sub.options, stops);
  add_technique(render, *sub.options);
  add_film(render, *sub.options);
  add_overrides(render, sub.options);
  add_checkpoints(render, *sub.options);
  add_pictures(render, *sub.options);
  render.add_option("--stats", sub->stats, "Write what the render did as JSON, - for standard output")
      ->type_name("FILE.json");
  add_watchers(render, *sub.options);
  add_max_memory(render, sub.options);
  render.add_flag("--explain", sub->explain, "Say first what the scene needs, and why");
  render.add_flag(
      "--strict", sub->strict,
      "Refuse a scene of which a warning means a wrong image (exit 3): no light, a lamp that emits nothing, "
      "matter in an open mesh or with vertex normals, a camera in opaque matter, a sheet or a lamp on a "
      "surface, light that an integrator named for the scene loses, not what auto says is missing; exit with "
      "70 if any sample was left out");
  render.add_flag("--quiet", sub->quiet, "Show no progress and no notes, only warnings");
}

void add_meter(CLI::App& app, Command& command) {
  const Sub<MeterOptions> sub(app, "meter", "Measure light with the meters of a scene", command, meter);
  CLI::App& options = *sub.app;
  options.add_option("scene", sub->scene, "Scene file, or - for standard input")
      ->required()
      ->type_name("SCENE");
  options.add_option("--only", sub->meters, "Meter to read, by its name; may be repeated (default: all)")
      ->allow_extra_args(false)
      ->type_name("NAME");
  options.add_option("--spectra", sub->spectra, "Table to write of what the meters with a spectrum read")
      ->type_name("FILE.csv");
  (void)add_samples(options, *sub.options, "Samples of each part of a meter, which has 1024 or more",
                    "the largest relative standard error of a meter's three figures", " for each meter");
  add_technique(options, *sub.options);
  add_overrides(options, sub.options);
  add_max_memory(options, sub.options);
  options.add_flag("--strict", sub->strict,
                   "Refuse a scene of which a warning means a wrong reading (exit 3); exit with 70 if any "
                   "sample was left out");
  options.add_flag("--quiet", sub->quiet, "Show no progress and no notes, only warnings");
  add_json(options, sub->json);
}

}  // namespace abbe::cli
