#include "cli/command_options.h"

#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "cli/render.h"

namespace abbe::cli {

void add_samples(CLI::App& app, SamplingOptions& settings, const std::string& spp_help,
                 const std::string& error_name, const std::string& time_scope) {
  CLI::Option* spp =
      add_parsed(app, "--spp", settings.samples, integer_in<int>(1, kMaxSamples), spp_help, "N");
  CLI::Option* error =
      add_parsed(app, "--error", settings.render.target_error, parse_fraction,
                 "Stop when " + error_name + " is at most this fraction, such as 0.5% or 0.005", "FRACTION");
  CLI::Option* time = add_parsed(
      app, "--time", settings.render.time_limit_s, parse_seconds,
      "Stop after this time" + time_scope +
          ", in s or with a unit, such as 60s, 2m or 1h; with --error, when the first of both is reached",
      "TIME");
  spp->excludes(error)->excludes(time);
}

void add_integrator(CLI::App& app, SamplingOptions& settings) {
  add_parsed(app, "--integrator", settings.integrator,
             one_of<Integrator>({kIntegratorNames.begin(), kIntegratorNames.end()}),
             "Integrator (default: the scene's)", fmt::format("{}", fmt::join(kIntegratorNames, "|")));
  app.add_flag("--consistent", settings.consistent,
               "Allow auto to use photon merging (biased, converging) for light paths that no unbiased "
               "integrator can sample");
  add_parsed(app, "--seed", settings.seed, integer_in<std::uint64_t>(0, kMaxSeed),
             "Seed of the random numbers (default: the scene's)", "N");
  add_parsed(app, "--threads", settings.render.threads, integer_in<int>(0, kMaxThreads),
             "Number of threads; 0 for one per processor (default 0)", "N");
}

namespace {

// Adds the options for the crop, the layers and the auxiliary channels of the film.
void add_film(CLI::App& render, RenderOptions& settings) {
  add_parsed(render, "--crop", settings.render.crop, parse_crop,
             "Pixels of the film to render, X0 <= x < X1 and Y0 <= y < Y1 (default: all)", "X0,Y0,X1,Y1");
  add_parsed(render, "--layers", settings.layers, parse_layer_choice,
             "Also record layers, channels that add up to the film: by light (lights, or lights:NAME,... for "
             "some lights) or by path length (bounces, or bounces:N with N or more bounces in the last "
             "layer, 1 to 64, default 8)",
             "lights|bounces");
  add_parsed(render, "--aov", settings.render.features, parse_feature_list,
             "Also record features of the first surface in each pixel, any of depth (channel depth.Z), "
             "position (P), normal (N), shading-normal (Ns), albedo (Albedo) and id (Id), with the fraction "
             "of samples that hit a surface (Coverage)",
             "NAME[,NAME...]");
}

void add_checkpoints(CLI::App& render, RenderOptions& settings) {
  add_value(render, "--checkpoint", settings.checkpoint,
            "File in which the finished samples are saved during the render", "FILE.abbepart");
  add_parsed(render, "--checkpoint-every", settings.render.checkpoint_interval_s, parse_seconds,
             "Time between checkpoints, in s or with a unit, such as 60s, 2m or 1h; longer if writing would "
             "take more than 1 % of the time (default 60s)",
             "TIME")
      ->needs("--checkpoint");
  render.add_flag("--resume", settings.resume, "Continue from the checkpoint if it exists")
      ->needs("--checkpoint");
}

void add_pictures(CLI::App& render, RenderOptions& settings) {
  add_value(render, "--display", settings.display, "Also write a picture for a display", "FILE.png");
  add_value(render, "--screen", settings.view.display,
            "Display of the OpenColorIO configuration (default: its first)", "NAME");
  add_value(render, "--view", settings.view.view, "View of that display (default: its first)", "NAME");
  add_value(render, "--ocio", settings.view.config,
            "OpenColorIO configuration of the picture (default: $OCIO, otherwise Abbe's own)", "FILE.ocio");
  add_value(render, "--exposure-of", settings.exposure_of,
            "Film of the same sensor whose display exposure the picture uses, such as the first of "
            "several frames",
            "FILE.exr");
  add_value(render, "--gamut", settings.gamut,
            "Also write a picture that shows in white the pixels outside the gamut of the display",
            "FILE.png");
}

void add_live_viewers(CLI::App& render, RenderOptions& settings) {
  add_parsed(
      render, "--preview", settings.preview, parse_server_address,
      "Show the running render on a web page at this port of this machine or address; 0 for any free port",
      "[ADDRESS:]PORT");
  add_parsed(
      render, "--tev", settings.tev, parse_viewer_address,
      "Show the running render in the viewer tev, which listens at this port (default host: this machine)",
      "[HOST:]PORT");
}

}  // namespace

void add_render(CLI::App& app, Command& command) {
  const Subcommand<RenderOptions> sub(app, "render", "Render a scene", command, render);
  CLI::App& render = *sub.app;
  add_scene(render, sub->scene);
  add_value(render, "-o,--output", sub->output,
            "Film (.exr) or partial film with exact sums (.abbepart) to write (default: that of the "
            "scene, otherwise SCENE.exr)",
            "FILE.exr|FILE.abbepart");
  add_samples(render, *sub.options, "Samples per pixel (default: the scene's)",
              "the median relative error of illuminated pixel values", "");
  add_parsed(render, "--sample-range", sub->render.samples, parse_sample_range,
             "Render only the samples A to B - 1 of every pixel, for parts of one render", "A:B")
      ->excludes("--error")
      ->excludes("--time");
  add_integrator(render, *sub.options);
  add_film(render, *sub.options);
  add_overrides(render, sub.options);
  add_checkpoints(render, *sub.options);
  add_pictures(render, *sub.options);
  add_value(render, "--stats", sub->stats, "Write statistics of the render as JSON; - for standard output",
            "FILE.json");
  add_live_viewers(render, *sub.options);
  add_max_memory(render, sub.options);
  render.add_flag("--explain", sub->explain, "First print which features the scene needs, and why");
  render.add_flag(
      "--strict", sub->strict,
      "Reject a scene with a warning that means a wrong image (exit code 3): no light, a light that emits "
      "nothing, a medium in a mesh that is open or has vertex normals, a camera in an opaque medium, a thin "
      "sheet or a light that coincides with a surface, or light paths that the chosen integrator cannot "
      "sample (with auto these remain a warning); exit with 70 if any sample was discarded");
  render.add_flag("--quiet", sub->quiet, "Print warnings and errors only, no progress and no notes");
}

}  // namespace abbe::cli
