#include "cli/render.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/mpi_group.h"
#include "cli/output_files.h"
#include "cli/progress.h"
#include "develop/film_file.h"
#include "io/atomic_file.h"
#include "io/data_directory.h"
#include "io/error.h"
#include "io/picture.h"
#include "io/text.h"
#include "preview/preview.h"
#include "preview/tev_viewer.h"
#include "results/rendered_film.h"
#include "results/scene_warnings.h"
#include "results/spectral.h"
#include "results/white.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/cost.h"
#include "transport/render/mpi_group.h"
#include "transport/render/part.h"
#include "transport/render/pass.h"
#include "transport/render/sample_ranges.h"
#include "transport/render/threads.h"
#include "validation/statistics.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "none";
}

std::string text_of(const std::optional<SampleRange>& range) {
  return range ? to_text(SampleRanges{*range}) : "none";
}

// Everything that determines which passes are traced by which process, and the meaning of their sums.
std::string render_description(const FilmIdentity& identity, const abbe::RenderOptions& render_options,
                               const std::optional<RenderResult>& start) {
  FilmIdentity all = distinguishing_keys(identity);
  if (const auto stated = identity.find(kStatedSamplesKey); stated != identity.end()) all.insert(*stated);
  std::string text;
  for (const auto& [key, value] : all) text += fmt::format("{}: {}\n", key, value);
  text += fmt::format("range {}\ntime {}\nerror {}\n", text_of(render_options.samples),
                      text_of(render_options.time_limit_s), text_of(render_options.target_error));
  if (!start) return text;
  text += fmt::format("start {}\n", to_text(start->samples));
  if (const auto& begun = start->unfinished)
    text += fmt::format("begun {} {}\n", text_of(begun->samples), begun->items);
  return text;
}

Json json_of(const Cost& cost) {
  return {{"wall_s", cost.wall_s}, {"cpu_s", cost.cpu_s}};
}

// Mean and error of each plane over the rendered pixels. Planes of a spectral sensor are radiances, as in its
// file.
Json film_figures(const Scene& scene, const Film& film) {
  const Crop crop = film.crop();
  const std::vector<std::string> planes = scene.film_planes();
  const std::vector<double> divisors = scene.spectral ? exposure_per_radiance(scene) : std::vector<double>();
  Json figures;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Film::Average average =
        film.average(static_cast<int>(i), crop.x0, crop.y0, crop.x1, crop.y1, divisors);
    const bool known = average.degrees_of_freedom > 0;
    figures[planes[i]] = {
        {"mean", average.mean},
        {"standard_error", known ? Json(average.standard_error) : Json()},
        {"degrees_of_freedom", average.degrees_of_freedom},
        {"half_interval_95",
         known ? Json(half_interval(average.standard_error, average.degrees_of_freedom, 0.95)) : Json()}};
  }
  return figures;
}

/// Cost of the command, and of its phases other than the render itself.
struct Costs {
  CostMeter command;  ///< The whole command so far; starts with the construction of this struct.
  Cost load;          ///< Reading and building the scene.
  Cost plan;     ///< Pilot rays that choose the integrator, train its guiding data and determine the white.
  Cost display;  ///< Making and writing pictures of the film.
  Cost write;    ///< Writing the film and the last checkpoint.
};
// JSON that `abbe render --stats` writes: one line with a newline. The cost of the command is that until
// this call. `display_white` is the film value that the picture displays as white (`kDisplayExposureKey`);
// null without a picture.
std::string stats_text(const Scene& scene, const RenderResult& result, const Costs& costs,
                       std::optional<double> display_white) {
  const RenderStats& stats = result.stats;
  Json answer;
  answer["wall_s"] = stats.wall_s;
  answer["cpu_s"] = stats.cpu_s;
  answer["command"] = json_of(costs.command.spent());
  answer["overhead"] = {{"load", json_of(costs.load)},
                        {"plan", json_of(costs.plan)},
                        {"display", json_of(costs.display)},
                        {"write", json_of(costs.write)}};
  answer["threads"] = stats.threads;
  answer["processes"] = stats.processes;
  answer["samples_per_pixel"] = stats.samples_per_pixel;
  answer["samples_before"] = stats.samples_before;
  answer["photons_per_sample"] = result.film.shape().photons;
  answer["path_interval"] = result.film.shape().path_interval;
  answer["path_splitting"] = stats.path_splitting;
  answer["paths"] = stats.paths;
  answer["rays"] = stats.rays;
  answer["embree_replay_share"] = Json();  // measured by bench, which traces paths again
  answer["relative_error"] = stats.error.median;
  answer["relative_error_p95"] = stats.error.p95;
  answer["frame_mean_error"] = stats.error.frame_mean;
  answer["half_noise_samples"] = or_null(stats.error.few_samples);
  answer["hidden_noise"] = stats.error.hidden_noise > 0 ? Json(stats.error.hidden_noise) : Json();
  answer["nonfinite_samples"] = stats.nonfinite_samples;
  answer["cut_paths"] = stats.cut.paths;
  answer["cut_throughput"] = stats.cut.throughput();
  answer["film"] = film_figures(scene, result.film);
  answer[kDisplayExposureKey] = or_null(display_white);
  answer["version"] = ABBE_VERSION;
  answer["seed"] = scene.render.seed;
  answer["scene_sha256"] = scene.sha256;
  answer["data_sha256"] = data_sha256();
  return text(answer, true);
}
// Checks that all processes of a group are about to render the same samples of the same film, continuing
// from the same ones (`start`, empty for none). Otherwise their sums would be invalid. All processes must
// call it before their first pass. Throws Error{input} in those whose render differs from that of the root.
// Does nothing for a single process.
void require_same_render(const MpiGroup& mpi_group, const FilmIdentity& identity,
                         const abbe::RenderOptions& render_options,
                         const std::optional<RenderResult>& start) {
  if (mpi_group.size == 1) return;
  constexpr std::size_t kDigits = 16;  // hexadecimal, of 64 bits
  const std::string hash = sha256(render_description(identity, render_options, start)).substr(0, kDigits);
  const std::uint64_t own_hash = std::stoull(hash, nullptr, 16);
  if (mpi_group.broadcast(own_hash) == own_hash) return;
  throw Error(ErrorCode::input, "mpirun",
              fmt::format("process {} does not render the same film as the root process: give all processes "
                          "the same command line, files, build and instruction set of the processor",
                          mpi_group.rank));
}

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
  const std::optional<Crop>& crop = options.render.crop;
  if (crop && (crop->x1 > camera.width || crop->y1 > camera.height))
    throw Error(ErrorCode::usage, "--crop",
                fmt::format("extends outside the film (got {},{}, allowed up to {},{})", crop->x1, crop->y1,
                            camera.width, camera.height));
  const std::optional<SampleRange>& range = options.render.samples;
  if (range && range->last > static_cast<std::uint64_t>(scene.render.samples))
    throw Error(ErrorCode::usage, "--sample-range",
                fmt::format("exceeds the samples of the whole render (got {}, allowed up to {})", range->last,
                            scene.render.samples));
}

abbe::RenderOptions make_render_options(const RenderOptions& options, const Scene& scene) {
  abbe::RenderOptions render_options = options.render;
  if (const std::optional<LayerChoice>& layers = options.layers)
    render_options.layers =
        layers->bounces ? bounce_layers(*layers->bounces) : light_layers(scene, layers->lights);
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
  const int threads = thread_count(options.render.threads);
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
                        [](const std::string& warning) { warn(warning); });
  }
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
    writers.emplace_back([&] {
      const std::string stats = stats_text(scene, part.result, costs, display_white);
      if (outputs.stats.empty())
        fmt::print("{}", stats);
      else
        write_atomically(outputs.stats, stats);
    });
  write_all(writers);
}

void report_results(const RenderOptions& options, const fs::path& film, const Scene& scene,
                    const RenderResult& result, const Cost& plan) {
  const RenderStats& stats = result.stats;
  if (!options.quiet)
    print_message(fmt::format("{} after {} samples per pixel in {:.3g} s{}", film.string(),
                              stats.samples_per_pixel, plan.wall_s + stats.wall_s,
                              error_text(stats.error, ", ")));
  if (options.render.target_error && !options.render.time_limit_s && !stats.interrupted &&
      !std::isfinite(stats.error.median))
    print_message("warning: a pilot found no light on the film: --error has no effect");
  for (const std::string& warning : render_warnings(scene, result)) warn(warning);
}

}  // namespace

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

int render(const RenderOptions& options) {
  Costs costs;
  Inputs inputs(options.max_memory_bytes);
  const RootOnlyOutput root_only(mpi_group());
  Scene scene = load_in_all_processes(options, inputs, mpi_group());
  const int threads = thread_count(options.render.threads);
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
  warn(ignored_polarisation_warning(scene), options.strict);
  warn(dark_camera_warning(scene), options.strict);
  warn(coincidence_warning(scene), options.strict);
  warn(unsampled_light_warning(scene), options.strict && !chooses_integrator);
  warn(undertrained_warning(choice.guides.get()));
  warn(unused_settings_warning(scene));

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
