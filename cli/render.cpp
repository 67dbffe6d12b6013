#include "cli/render.h"

#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "calibration/output/display.h"
#include "cli/answer.h"
#include "cli/info.h"
#include "cli/interrupt.h"
#include "cli/mpi_group.h"
#include "cli/output_files.h"
#include "cli/progress.h"
#include "cli/render_stats.h"
#include "cli/same_render.h"
#include "cli/warnings.h"
#include "develop/film_file.h"
#include "io/atomic_file.h"
#include "io/extension.h"
#include "io/file_lock.h"
#include "io/picture.h"
#include "io/standard_stream.h"
#include "preview/preview.h"
#include "preview/tev_viewer.h"
#include "results/rendered_film.h"
#include "results/scene_warnings.h"
#include "results/white.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/light_subpaths.h"
#include "transport/render/threads.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

Scene load(const RenderOptions& options, Inputs& inputs) {
  Diagnostics diagnostics(options.strict ? Strictness::strict : Strictness::lenient);
  Scene scene = accepted(load_scene(options.scene, options.overrides, diagnostics, &inputs), diagnostics);
  set_sampling(options, scene.render);
  return scene;
}

struct Outputs {
  fs::path film;
  fs::path display;  ///< Empty for none.
  fs::path gamut;    ///< Empty for none.
  fs::path stats;    ///< Empty for none.
};

std::array<fs::path, 5> files_of(const Outputs& outputs, const RenderOptions& options) {
  return {outputs.film, outputs.display, outputs.gamut, outputs.stats, options.checkpoint};
}

// Path that names the film by default.
fs::path name_of(const fs::path& scene) {
  return scene == kStandardStream ? "stdin" : scene;
}

// Chooses the outputs, and checks them before any time is spent on pilot rays and rendering.
Outputs choose_outputs(const RenderOptions& options, const Scene& scene, const Inputs& inputs) {
  Outputs outputs{options.output, options.display, options.gamut, {}};
  if (options.stats != kStandardStream) outputs.stats = options.stats;
  if (outputs.film.empty()) outputs.film = scene.output.image;
  if (outputs.film.empty()) outputs.film = name_of(options.scene).stem().concat(".exr");
  // A picture of a part would lack the samples of other parts, and all parts would write the same file.
  const bool part = extension_of(outputs.film) == kPartExtension;
  if (part && !(outputs.display.empty() && outputs.gamut.empty()))
    throw Error(ErrorCode::usage, outputs.film.string(),
                "is a partial film, which is written without pictures: use merge --display for all parts");
  if (outputs.display.empty() && !part) outputs.display = scene.output.display;
  if (outputs.display.empty() && outputs.gamut.empty() && !options.preview)
    require_no_view(options.view, "--display, --gamut or --preview");
  if (outputs.display.empty() && outputs.gamut.empty() && !options.exposure_of.empty())
    throw Error(ErrorCode::usage, "--exposure-of",
                "applies to pictures only (allowed with --display or --gamut)");
  require_film_output(outputs.film);
  for (const fs::path& picture : {outputs.display, outputs.gamut}) {
    if (picture.empty()) continue;
    require_picture_extension(picture);
    require_writable(picture);
  }
  if (!outputs.stats.empty()) require_writable(outputs.stats);
  if (!options.checkpoint.empty()) {
    require_extension(options.checkpoint, {kPartExtension});
    require_writable(options.checkpoint);
  }
  require_distinct(files_of(outputs, options), inputs.files());
  if (!options.exposure_of.empty())
    require_distinct(files_of(outputs, options), std::array{options.exposure_of});
  return outputs;
}

void check_ranges(const RenderOptions& options, const Scene& scene) {
  const Camera& camera = scene.camera;
  if (options.crop && (options.crop->x1 > camera.width || options.crop->y1 > camera.height))
    throw Error(ErrorCode::usage, "--crop",
                fmt::format("extends outside the film (got {},{}, allowed up to {},{})", options.crop->x1,
                            options.crop->y1, camera.width, camera.height));
  if (options.sample_range && options.sample_range->last > static_cast<std::uint64_t>(scene.render.samples))
    throw Error(ErrorCode::usage, "--sample-range",
                fmt::format("exceeds the samples of the whole render (got {}, allowed up to {})",
                            options.sample_range->last, scene.render.samples));
}

abbe::RenderOptions make_render_options(const RenderOptions& options, const Scene& scene) {
  abbe::RenderOptions render_options;
  render_options.threads = options.threads;
  render_options.time_limit_s = options.time_limit_s;
  render_options.target_error = options.target_error;
  render_options.crop = options.crop;
  if (const std::optional<LayerChoice>& layers = options.layers) {
    render_options.layers =
        layers->bounces ? bounce_layers(*layers->bounces) : light_layers(scene, layers->lights);
  }
  render_options.features = options.features;
  render_options.samples = options.sample_range;
  render_options.checkpoint_interval_s = options.checkpoint_interval_s;
  render_options.measure_error = !options.stats.empty();
  return render_options;
}

// Rejects a checkpoint with samples above the requested number. A limit of time or error accepts any.
void require_no_excess_samples(const fs::path& path, const SampleRanges& recorded,
                               const abbe::RenderOptions& render_options, int samples) {
  const SampleRanges requested{{0, static_cast<std::uint64_t>(samples)}};
  if (render_options.time_limit_s || render_options.target_error || recorded.empty() ||
      recorded.back().last <= requested.back().last)
    return;
  throw Error(ErrorCode::input, path.string(),
              fmt::format("contains samples that are not requested (got {}, allowed {})", to_text(recorded),
                          to_text(requested)));
}

// Samples of a checkpoint, for messages.
std::string describe_progress(const RenderResult& recorded) {
  if (recorded.samples.empty()) return "a part of the first sample";
  return fmt::format("samples {}{}", to_text(recorded.samples),
                     recorded.unfinished ? " and a part of the next" : "");
}

// Checkpoint of an earlier run, if --resume requests it and it exists.
std::optional<RenderResult> load_checkpoint(const RenderOptions& options, const FilmIdentity& identity,
                                            const abbe::RenderOptions& render_options, int samples) {
  const fs::path& path = options.checkpoint;
  std::error_code ignored;
  if (path.empty() || !fs::exists(path, ignored)) {
    if (options.resume)
      print_message(fmt::format("{}: no checkpoint yet, starting from the first sample", path.string()));
    return std::nullopt;
  }
  if (!options.resume)
    throw Error(ErrorCode::output, path.string(),
                "contains an earlier render: continue it with --resume, or remove the file");
  RenderPart part = read_checkpoint(path);
  require_same_film(path, part.identity, identity);
  if (!part.areas.empty())
    throw Error(ErrorCode::input, path.string(),
                "has pixels with different samples and cannot be resumed: complete it with merge");
  require_no_excess_samples(path, part.result.samples, render_options, samples);
  if (!options.quiet)
    print_message(fmt::format("{}: continuing after {}", path.string(), describe_progress(part.result)));
  return std::move(part.result);
}

// Writes a checkpoint. The render continues after a failure, since only the last checkpoint must be written.
void try_write_checkpoint(const fs::path& path, const FilmIdentity& identity, const RenderResult& result) {
  try {
    write_part(path, identity, result);
  } catch (const Error& error) {
    if (error.code != ErrorCode::output) throw;
    print_message(fmt::format("warning: the checkpoint was not written: {}", error.what()));
  }
}

// Rejects a scene from standard input under mpirun, which only the root process can read.
void require_scene_file(const RenderOptions& options, const MpiGroup& mpi_group) {
  if (mpi_group.size > 1 && options.scene == kStandardStream)
    throw Error(ErrorCode::usage, kStandardInputName,
                "is available to the root process only: under mpirun, give the scene as a file");
}

// Loads the scene in all processes. If all fail, the root process reports the error and ends the others,
// which wait for it here.
Scene load_in_all_processes(const RenderOptions& options, Inputs& inputs, const MpiGroup& mpi_group) {
  std::optional<Error> failure;
  std::optional<Scene> scene;
  try {
    require_scene_file(options, mpi_group);
    scene = load(options, inputs);
  } catch (const Error& error) {
    if (mpi_group.rank == 0) throw;
    failure = error;
  }
  if (mpi_group.size > 1) (void)mpi_group.broadcast(0);
  if (failure) throw *failure;
  return *std::move(scene);
}

/// Live viewers of the render. Both may be absent.
struct LiveViewers {
  std::optional<Preview> page = {};
  std::optional<TevViewer> tev = {};

  [[nodiscard]] bool page_is_ready() { return page && page->viewer_is_ready(); }
  [[nodiscard]] bool tev_is_ready() { return tev && tev->viewer_is_ready(); }
  void show(const RenderResult& result) {
    if (page_is_ready()) page->show(result);
    if (tev_is_ready()) tev->show(result);
  }
  void end(const RenderResult& result) {
    if (tev) tev->end(result);
    if (page) page->end(result);
  }
};

// Connects the viewers to the render, in addition to the display of its progress.
void attach_viewers(LiveViewers& viewers, abbe::RenderOptions& render_options) {
  if (!viewers.page && !viewers.tev) return;
  render_options.viewer_is_ready = [&viewers] { return viewers.page_is_ready() || viewers.tev_is_ready(); };
  render_options.show = [&viewers](const RenderResult& result) { viewers.show(result); };
  if (viewers.page)
    render_options.progress = [&viewers,
                               earlier_progress = render_options.progress](const Progress& progress) {
      if (earlier_progress) earlier_progress(progress);
      viewers.page->set_progress(progress);
    };
}

// Renders the film in the group of processes, from a checkpoint if there is one.
RenderPart render_film(const Scene& scene, const RenderOptions& options,
                       const std::shared_ptr<const GuidingData>& guides, const InterruptWatch& watch,
                       LiveViewers& viewers, ProgressDisplay& display) {
  abbe::RenderOptions render_options = make_render_options(options, scene);
  const FilmIdentity identity = identity_of(scene, name_of(options.scene), render_options);
  render_options.stop = &watch.stop();
  render_options.guides = guides;
  render_options.mpi_group = mpi_group();
  if (!options.quiet && render_options.mpi_group.rank == 0)
    render_options.progress = [&display](const Progress& progress) { display(progress); };
  attach_viewers(viewers, render_options);
  const fs::path& checkpoint = options.checkpoint;
  if (!checkpoint.empty())
    render_options.checkpoint = [&](const RenderResult& result) {
      try_write_checkpoint(checkpoint, identity, result);
      if (watch.stop() && result.unfinished)
        print_message("finishing the current sample; another signal ends the program at once");
    };
  std::optional<RenderResult> start =
      load_checkpoint(options, identity, render_options, scene.render.samples);
  require_same_render(render_options.mpi_group, identity, render_options, start);
  if (render_options.progress) display.prepare();
  RenderPart part{identity, abbe::render(scene, render_options, std::move(start))};
  display.finish();
  return part;
}

ViewOptions chosen_view(const RenderOptions& options) {
  ViewOptions view = options.view;
  if (view.config.empty()) view.config = users_configuration();
  return view;
}

// Opens the requested viewers. Each needs memory for two copies of the planes, the visible one and the next.
void open_viewers(LiveViewers& viewers, const Scene& scene, const RenderOptions& options, Inputs& inputs) {
  const std::size_t pixels =
      static_cast<std::size_t>(scene.camera.width) * static_cast<std::size_t>(scene.camera.height);
  const std::size_t bytes = 2 * sizeof(float) * pixels * scene.film_planes().size();
  const int threads = thread_count(options.threads);
  const auto identity = [&] {
    return identity_of(scene, name_of(options.scene), make_render_options(options, scene));
  };
  if (options.preview) {
    inputs.reserve_memory("the preview", bytes);
    viewers.page.emplace(scene, identity(), chosen_view(options), *options.preview, threads);
    print_message("watch the render at " + viewers.page->url());
  }
  if (options.tev) {
    inputs.reserve_memory("the viewer", bytes);
    viewers.tev.emplace(scene, identity(), *options.tev, threads,
                        [](const std::string& warning) { print_message("warning: " + warning); });
  }
}

// Writes the statistics to a file, or to standard output without a path.
void write_stats(const fs::path& path, const std::string& stats) {
  if (path.empty())
    fmt::print("{}", stats);
  else
    write_atomically(path, stats);
}

/// Settings of pictures: the display, and the film value shown as white. Without a value it is chosen from
/// the film.
struct PictureSettings {
  DisplayTransform display;
  std::optional<double> display_white;
};

// Display exposure that the film of --exposure-of records, otherwise the one chosen from that film.
double exposure_of_film(const fs::path& path, const Scene& scene, const DisplayTransform& display,
                        Inputs& inputs) {
  const Image film = read_film(path, &inputs);
  if (const auto recorded = recorded_display_exposure(film, path)) return *recorded;
  for (const std::string& plane : scene.spectral ? std::vector<std::string>{} : scene.film_planes())
    if (film.find(plane) == nullptr)
      throw Error(ErrorCode::input, path.string(),
                  fmt::format("has no channel \"{}\", although --exposure-of needs a film of the same sensor",
                              plane));
  return 1 / display.automatic_scale(film_for_display(scene, film));
}

PictureSettings picture_settings_of(const Scene& scene, const RenderOptions& options, Inputs& inputs) {
  PictureSettings picture_settings{display_of(scene, chosen_view(options)), scene.output.display_exposure};
  if (!options.exposure_of.empty())
    picture_settings.display_white =
        exposure_of_film(options.exposure_of, scene, picture_settings.display, inputs);
  return picture_settings;
}

// Writes the pictures and returns the film value that they show as white.
double write_pictures(const Outputs& outputs, const PictureSettings& picture_settings, const Image& film,
                      bool quiet) {
  const std::optional<double>& white = picture_settings.display_white;
  const DisplayPicture picture =
      picture_settings.display(film, white ? std::optional(1 / *white) : std::nullopt);
  if (!outputs.display.empty()) write_picture(outputs.display, picture.image);
  if (!outputs.gamut.empty()) write_picture(outputs.gamut, picture.outside);
  if (!quiet && picture.outside_fraction + picture.clipped_fraction > 0)
    print_message(
        fmt::format("{:.1f} % of the pixels are outside the display's gamut, {:.1f} % are too bright for it",
                    100 * picture.outside_fraction, 100 * picture.clipped_fraction));
  if (!quiet && !white)
    print_message(fmt::format("the picture shows the film value {:.4g} as white", 1 / picture.scale));
  return 1 / picture.scale;
}

// Writes checkpoint, film, pictures and statistics, even if one of them fails.
void write_results(const RenderOptions& options, const Outputs& outputs,
                   const std::optional<PictureSettings>& picture_settings, const Scene& scene,
                   const RenderPart& part, Costs& costs) {
  std::optional<double> display_white;
  const auto write_display = [&] {
    display_white =
        write_pictures(outputs, *picture_settings, film_for_display(scene, film_image(part)), options.quiet);
  };
  std::vector<std::function<void()>> writers;
  if (!options.checkpoint.empty())
    writers.emplace_back(
        metered(costs.write, [&] { write_part(options.checkpoint, part.identity, part.result); }));
  writers.emplace_back(metered(costs.write, [&] { write_film(outputs.film, part); }));
  if (picture_settings) writers.emplace_back(metered(costs.display, write_display));
  if (!options.stats.empty())
    writers.emplace_back(
        [&] { write_stats(outputs.stats, stats_text(scene, part.result, costs, display_white)); });
  write_all(writers);
}

void report_results(const RenderOptions& options, const fs::path& film, const Scene& scene,
                    const RenderResult& result, const Cost& plan) {
  const RenderStats& stats = result.stats;
  if (!options.quiet)
    print_message(fmt::format("{} after {} samples per pixel in {:.3g} s{}", film.string(),
                              stats.samples_per_pixel, plan.wall_s + stats.wall_s,
                              error_text(stats.error, ", ")));
  if (options.target_error && !options.time_limit_s && !stats.interrupted &&
      !std::isfinite(stats.error.median))
    print_message("warning: a pilot found no light on the film: --error has no effect");
  for (const std::string& warning : render_warnings(scene, result)) print_message("warning: " + warning);
}

}  // namespace

int render(const RenderOptions& options) {
  Costs costs;
  Inputs inputs(options.max_memory_bytes);
  const RootOnlyOutput root_only(mpi_group());
  Scene scene = load_in_all_processes(options, inputs, mpi_group());
  const int threads = thread_count(options.threads);
  if (mpi_group().rank != 0) {
    const IntegratorChoice choice = choose_integrator(scene, threads);
    scene.render.integrator = choice.integrator;
    LiveViewers none;
    ProgressDisplay display;
    (void)render_film(scene, options, choice.guides, InterruptWatch(), none, display);
    return 0;
  }
  const Outputs outputs = choose_outputs(options, scene, inputs);
  check_ranges(options, scene);
  (void)make_render_options(options, scene);  // rejects wrong layers before pilot rays are traced
  const InterruptWatch watch;
  std::deque<FileLock> locks;
  for (const fs::path& output : files_of(outputs, options))
    if (!output.empty()) locks.emplace_back(output);
  const bool chooses_integrator = scene.render.integrator == Integrator::automatic;
  costs.load = costs.command.spent();
  const CostMeter planning;
  ProgressDisplay progress;
  if (!options.quiet) progress.prepare();
  const IntegratorChoice choice = choose_integrator(scene, threads);
  scene.render.integrator = choice.integrator;
  resolve_white(scene, options.scene, threads, choice.guides);
  progress.clear();
  costs.plan = planning.spent();
  std::optional<PictureSettings> picture_settings;
  if (!outputs.display.empty() || !outputs.gamut.empty())
    metered(costs.display, [&] { picture_settings = picture_settings_of(scene, options, inputs); })();
  if (picture_settings) require_distinct(files_of(outputs, options), picture_settings->display.files());
  if (options.explain) print_to_stderr(describe(scene, choice));
  if (!options.quiet) note_polarisation(scene);
  warn_of_ignored_polarisation(scene, options.strict);
  warn_of_dark_camera(scene, options.strict);
  warn_of_hidden_sheet(scene, options.strict);
  warn_of_hidden_light(scene, options.strict);
  warn_of_unsampled_light(scene, options.strict && !chooses_integrator);
  warn_of_undertrained_guides(choice.guides.get());
  warn_of_unused_settings(scene);

  inputs.reserve_memory("the film", film_bytes(scene, make_render_options(options, scene)));
  inputs.reserve_memory("the light subpaths of a sample", bytes_of_light_paths(scene));
  LiveViewers viewers;
  open_viewers(viewers, scene, options, inputs);
  const RenderPart part = render_film(scene, options, choice.guides, watch, viewers, progress);
  write_results(options, outputs, picture_settings, scene, part, costs);
  viewers.end(part.result);
  const RenderStats& stats = part.result.stats;
  report_results(options, outputs.film, scene, part.result, costs.plan);
  if (stats.interrupted) return kSignalExit + watch.signal();
  return options.strict && stats.nonfinite_samples > 0 ? static_cast<int>(ErrorCode::internal) : 0;
}

}  // namespace abbe::cli
