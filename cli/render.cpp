#include "cli/render.h"

#include <algorithm>

#include <fmt/format.h>

#include "calibration/output/display.h"
#include "cli/answer.h"
#include "cli/info.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "io/picture.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kSignalExit = 128;

Scene load(const RenderOptions& options) {
  Diagnostics diagnostics;
  Scene scene = accepted(load_scene(options.scene, options.overrides, diagnostics), diagnostics);
  scene.render.samples = options.samples.value_or(scene.render.samples);
  scene.render.integrator = options.integrator.value_or(scene.render.integrator);
  scene.render.seed = options.seed.value_or(scene.render.seed);
  return scene;
}

struct Outputs {
  fs::path image;
  fs::path display;  ///< Empty when no picture is wanted.
  fs::path stats;    ///< Likewise.
};

void require_extension(const fs::path& path, std::initializer_list<const char*> allowed) {
  const auto same = [&path](const char* extension) { return path.extension() == extension; };
  if (std::none_of(allowed.begin(), allowed.end(), same))
    throw Error(
        ErrorCode::usage, path.string(),
        fmt::format("got extension \"{}\", allowed {}", path.extension().string(), fmt::join(allowed, ", ")));
}

// Where to write, checked before any time is spent on rendering.
Outputs choose_outputs(const RenderOptions& options, const Scene& scene) {
  Outputs outputs{options.output, options.display, options.stats};
  if (outputs.image.empty()) outputs.image = scene.output.image;
  if (outputs.image.empty()) outputs.image = options.scene.stem().concat(".exr");
  if (outputs.display.empty()) outputs.display = scene.output.display;
  require_extension(outputs.image, {".exr"});
  require_writable(outputs.image);
  if (!outputs.display.empty()) {
    require_extension(outputs.display, {".png", ".jpg", ".tif"});
    require_writable(outputs.display);
  }
  if (!outputs.stats.empty()) require_writable(outputs.stats);
  return outputs;
}

void check_crop(const Crop& crop, const Camera& camera) {
  if (crop.x1 > camera.width || crop.y1 > camera.height)
    throw Error(ErrorCode::usage, "--crop",
                fmt::format("reaches beyond the film (got {},{}, allowed up to {},{})", crop.x1, crop.y1,
                            camera.width, camera.height));
}

RenderResult develop(const Scene& scene, const RenderOptions& options, const InterruptWatch& watch) {
  ProgressDisplay display;
  abbe::RenderOptions how;
  how.threads = options.threads;
  how.time_limit_s = options.time_limit_s;
  how.target_error = options.target_error;
  how.crop = options.crop;
  how.measure_replay = !options.stats.empty();
  how.stop = &watch.stop();
  if (!options.quiet) how.progress = [&display](const Progress& progress) { display(progress); };
  RenderResult result = abbe::render(scene, how);
  display.finish();
  return result;
}

Image image_of(const Scene& scene, const RenderResult& result, const RenderOptions& options) {
  std::vector<std::string> names;
  for (const Channel& channel : scene.channels) names.push_back(channel.name);
  Image image = result.film.image(names);
  image.metadata["renderer"] = "Abbe";
  image.metadata["version"] = ABBE_VERSION;
  image.metadata["scene"] = options.scene.filename().string();
  image.metadata["scene_sha256"] = scene.sha256;
  image.metadata["seed"] = fmt::format("{}", scene.render.seed);
  image.metadata["samples_per_pixel"] = fmt::format("{}", result.stats.samples_per_pixel);
  image.metadata["relative_error"] = fmt::format("{}", result.stats.relative_error);
  image.metadata["exposure_s"] = fmt::format("{}", scene.exposure_s);
  for (const Channel& channel : scene.channels)
    image.metadata["channel." + channel.name] = channel.kind == ResponseKind::quantum
                                                    ? "quantum, electrons per m^2"
                                                    : "energy, response-weighted J per m^2";
  if (options.crop)
    image.metadata["crop"] =
        fmt::format("{},{},{},{}", options.crop->x0, options.crop->y0, options.crop->x1, options.crop->y1);
  return image;
}

void write_stats(const fs::path& path, const Scene& scene, const RenderStats& stats) {
  Json answer;
  answer["wall_s"] = stats.wall_s;
  answer["cpu_s"] = stats.cpu_s;
  answer["threads"] = stats.threads;
  answer["samples_per_pixel"] = stats.samples_per_pixel;
  answer["paths"] = stats.paths;
  answer["rays"] = stats.rays;
  answer["embree_replay_share"] = stats.embree_replay_share;
  answer["relative_error"] = stats.relative_error;
  answer["nonfinite_samples"] = stats.nonfinite_samples;
  answer["version"] = ABBE_VERSION;
  answer["seed"] = scene.render.seed;
  answer["scene_sha256"] = scene.sha256;
  write_atomically(path, text(answer, true));
}

}  // namespace

int render(const RenderOptions& options) {
  const Scene scene = load(options);
  const Outputs outputs = choose_outputs(options, scene);
  if (options.crop) check_crop(*options.crop, scene.camera);
  std::optional<DisplayTransform> display;
  if (!outputs.display.empty())
    display = make_display(scene.channels, scene.lights.empty() ? Curve(1.0) : scene.lights.front().emission);
  if (options.explain) fmt::print(stderr, "{}", describe(scene));
  warn_about_polarisation(scene.needs);

  const InterruptWatch watch;
  const RenderResult result = develop(scene, options, watch);
  const Image image = image_of(scene, result, options);
  write_exr(outputs.image, image);
  if (display) {
    const std::optional<double> white = scene.output.display_exposure;
    write_picture(outputs.display, (*display)(image, white ? std::optional(1 / *white) : std::nullopt).image);
  }
  if (!outputs.stats.empty()) write_stats(outputs.stats, scene, result.stats);

  const RenderStats& stats = result.stats;
  if (!options.quiet)
    say(fmt::format("{} after {} samples per pixel in {:.3g} s{}", outputs.image.string(),
                    stats.samples_per_pixel, stats.wall_s, error_text(stats.relative_error, ", relative ")));
  if (stats.nonfinite_samples > 0)
    say(fmt::format("warning: {} samples were not finite and were left out", stats.nonfinite_samples));
  if (stats.interrupted) return kSignalExit + watch.signal();
  return options.strict && stats.nonfinite_samples > 0 ? static_cast<int>(ErrorCode::internal) : 0;
}

}  // namespace abbe::cli
