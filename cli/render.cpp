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
#include "cli/crew.h"
#include "cli/info.h"
#include "cli/interrupt.h"
#include "cli/output_files.h"
#include "cli/progress.h"
#include "cli/render_stats.h"
#include "cli/same_render.h"
#include "cli/warnings.h"
#include "develop/film_file.h"
#include "film/rendered_film.h"
#include "film/sensor_identity.h"
#include "film/shortcomings.h"
#include "film/white.h"
#include "io/atomic_file.h"
#include "io/extension.h"
#include "io/file_lock.h"
#include "io/picture.h"
#include "io/standard_stream.h"
#include "preview/preview.h"
#include "preview/tev_viewer.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/collect.h"
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
  fs::path display;  ///< Empty when no picture is wanted.
  fs::path gamut;    ///< Empty when no gamut is wanted.
  fs::path stats;    ///< Empty when no statistics are wanted.
};

std::array<fs::path, 5> files_of(const Outputs& outputs, const RenderOptions& options) {
  return {outputs.film, outputs.display, outputs.gamut, outputs.stats, options.checkpoint};
}

// What the film is called after.
fs::path name_of(const fs::path& scene) {
  return scene == kStandardStream ? "stdin" : scene;
}

// Where to write, checked before any time is spent on the pilot that finds the white, and on rendering.
Outputs choose_outputs(const RenderOptions& options, const Scene& scene, const Inputs& inputs) {
  Outputs outputs{options.output, options.display, options.gamut, {}};
  if (options.stats != kStandardStream) outputs.stats = options.stats;
  if (outputs.film.empty()) outputs.film = scene.output.image;
  if (outputs.film.empty()) outputs.film = name_of(options.scene).stem().concat(".exr");
  // A picture of some of the samples is not the scene's, and all parts would write the same file.
  const bool part = extension_of(outputs.film) == kPartExtension;
  if (part && !(outputs.display.empty() && outputs.gamut.empty()))
    throw Error(ErrorCode::usage, outputs.film.string(),
                "a part is all that its render writes: merge --display shows the film of all parts");
  if (outputs.display.empty() && !part) outputs.display = scene.output.display;
  if (outputs.display.empty() && outputs.gamut.empty() && !options.preview)
    require_no_view(options.view, "--display, --gamut or --preview");
  if (outputs.display.empty() && outputs.gamut.empty() && !options.exposure_of.empty())
    throw Error(ErrorCode::usage, "--exposure-of",
                "only a picture takes it (allowed with --display or --gamut)");
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
                fmt::format("reaches beyond the film (got {},{}, allowed up to {},{})", options.crop->x1,
                            options.crop->y1, camera.width, camera.height));
  if (options.sample_range && options.sample_range->last > static_cast<std::uint64_t>(scene.render.samples))
    throw Error(ErrorCode::usage, "--sample-range",
                fmt::format("reaches beyond the samples of the whole render (got {}, allowed up to {})",
                            options.sample_range->last, scene.render.samples));
}

abbe::RenderOptions how_to_render(const RenderOptions& options, const Scene& scene) {
  abbe::RenderOptions how;
  how.threads = options.threads;
  how.time_limit_s = options.time_limit_s;
  how.target_error = options.target_error;
  how.crop = options.crop;
  if (const std::optional<LayerChoice>& layers = options.layers) {
    how.layers = layers->bounces ? bounce_layers(*layers->bounces) : light_layers(scene, layers->lights);
  }
  how.features = options.features;
  how.samples = options.sample_range;
  how.checkpoint_interval_s = options.checkpoint_interval_s;
  how.measure_error = !options.stats.empty();
  return how;
}

// A film of so many samples has no others, though a range of them may be added to what is there.
void require_no_more(const fs::path& path, const SampleRanges& held, const abbe::RenderOptions& how,
                     int samples) {
  const SampleRanges asked{{0, static_cast<std::uint64_t>(samples)}};
  if (how.time_limit_s || how.target_error || held.empty() || held.back().last <= asked.back().last) return;
  throw Error(ErrorCode::input, path.string(),
              fmt::format("holds samples that are not asked for (got {}, allowed {})", to_text(held),
                          to_text(asked)));
}

// What a checkpoint holds.
std::string in_words(const RenderResult& held) {
  if (held.samples.empty()) return "a part of the first sample";
  return fmt::format("samples {}{}", to_text(held.samples), held.unfinished ? " and a part of the next" : "");
}

// What an earlier run left, if it is asked for and there is some.
std::optional<RenderResult> earlier(const RenderOptions& options, const FilmIdentity& identity,
                                    const abbe::RenderOptions& how, int samples) {
  const fs::path& path = options.checkpoint;
  std::error_code ignored;
  if (path.empty() || !fs::exists(path, ignored)) {
    if (options.resume)
      say(fmt::format("{}: no checkpoint yet, starting from the first sample", path.string()));
    return std::nullopt;
  }
  if (!options.resume)
    throw Error(ErrorCode::output, path.string(), "holds an earlier render: --resume goes on with it");
  RenderPart part = read_checkpoint(path);
  require_same_film(path, part.identity, identity);
  if (!part.areas.empty())
    throw Error(ErrorCode::input, path.string(),
                "has pixels with different samples, which merge alone completes");
  require_no_more(path, part.result.samples, how, samples);
  if (!options.quiet) say(fmt::format("{}: going on after {}", path.string(), in_words(part.result)));
  return std::move(part.result);
}

// A checkpoint that fails costs no more than itself: the render goes on, and the last one is not forgiven.
void try_to_save(const fs::path& path, const FilmIdentity& identity, const RenderResult& result) {
  try {
    write_part(path, identity, result);
  } catch (const Error& error) {
    if (error.code != ErrorCode::output) throw;
    say(fmt::format("warning: no checkpoint: {}", error.what()));
  }
}

// Standard input, which mpirun gives to the first process alone, would be an empty scene to all others.
void require_scene_of_all(const RenderOptions& options, const Crew& crew) {
  if (crew.size > 1 && options.scene == kStandardStream)
    throw Error(ErrorCode::usage, kStandardInputName,
                "comes to the first process alone: give all of mpirun a scene in a file");
}

// Where all fail, the first process tells why and ends the others, which wait for it here.
Scene load_together(const RenderOptions& options, Inputs& inputs, const Crew& crew) {
  std::optional<Error> failure;
  std::optional<Scene> scene;
  try {
    require_scene_of_all(options, crew);
    scene = load(options, inputs);
  } catch (const Error& error) {
    if (crew.rank == 0) throw;
    failure = error;
  }
  if (crew.size > 1) (void)crew.follow(0);
  if (failure) throw *failure;
  return *std::move(scene);
}

/// Those who watch the render, of whom there may be none.
struct Watchers {
  std::optional<Preview> page = {};
  std::optional<TevViewer> viewer = {};

  [[nodiscard]] bool page_wants() { return page && page->wants_to_see(); }
  [[nodiscard]] bool viewer_wants() { return viewer && viewer->wants_to_see(); }
  void show(const RenderResult& result) {
    if (page_wants()) page->show(result);
    if (viewer_wants()) viewer->show(result);
  }
  void end(const RenderResult& result) {
    if (viewer) viewer->end(result);
    if (page) page->end(result);
  }
};

// Lets them follow the render, beside what follows it already.
void show_to(Watchers& watchers, abbe::RenderOptions& how) {
  if (!watchers.page && !watchers.viewer) return;
  how.wants_to_see = [&watchers] { return watchers.page_wants() || watchers.viewer_wants(); };
  how.show = [&watchers](const RenderResult& result) { watchers.show(result); };
  if (watchers.page)
    how.progress = [&watchers, before = how.progress](const Progress& progress) {
      if (before) before(progress);
      watchers.page->tell(progress);
    };
}

RenderPart develop(const Scene& scene, const RenderOptions& options,
                   const std::shared_ptr<const Guides>& guides, const InterruptWatch& watch,
                   Watchers& watchers, ProgressDisplay& display) {
  abbe::RenderOptions how = how_to_render(options, scene);
  const FilmIdentity identity = identity_of(scene, name_of(options.scene), how);
  how.stop = &watch.stop();
  how.guides = guides;
  how.crew = crew();
  if (!options.quiet && how.crew.rank == 0)
    how.progress = [&display](const Progress& progress) { display(progress); };
  show_to(watchers, how);
  const fs::path& checkpoint = options.checkpoint;
  if (!checkpoint.empty())
    how.checkpoint = [&](const RenderResult& result) {
      try_to_save(checkpoint, identity, result);
      if (watch.stop() && result.unfinished) say("ending with the sample begun; another signal ends at once");
    };
  std::optional<RenderResult> start = earlier(options, identity, how, scene.render.samples);
  require_same_render(how.crew, identity, how, start);
  if (how.progress) display.prepare();
  RenderPart part{identity, abbe::render(scene, how, std::move(start))};
  display.finish();
  return part;
}

ViewOptions chosen_view(const RenderOptions& options) {
  ViewOptions view = options.view;
  if (view.config.empty()) view.config = users_configuration();
  return view;
}

// What they are shown is a copy of the planes, and the next copy of them.
void call_watchers(Watchers& watchers, const Scene& scene, const RenderOptions& options, Inputs& inputs) {
  const std::size_t pixels =
      static_cast<std::size_t>(scene.camera.width) * static_cast<std::size_t>(scene.camera.height);
  const std::size_t bytes = 2 * sizeof(float) * pixels * scene.film_planes().size();
  const int threads = thread_count(options.threads);
  const auto identity = [&] {
    return identity_of(scene, name_of(options.scene), how_to_render(options, scene));
  };
  if (options.preview) {
    inputs.take_memory("the preview", bytes);
    watchers.page.emplace(scene, identity(), chosen_view(options), *options.preview, threads);
    say("watch the render at " + watchers.page->url());
  }
  if (options.tev) {
    inputs.take_memory("the viewer", bytes);
    watchers.viewer.emplace(scene, identity(), *options.tev, threads,
                            [](const std::string& warning) { say("warning: " + warning); });
  }
}

// To standard output where there is no file.
void write_stats(const fs::path& path, const std::string& stats) {
  if (path.empty())
    fmt::print("{}", stats);
  else
    write_atomically(path, stats);
}

/// A display, and the film value that it shows as white; nothing for the automatic one.
struct Showing {
  DisplayTransform display;
  std::optional<double> shown_as_white;
};

// The display exposure that the film of --exposure-of records, else the one chosen from that film.
double exposure_of_film(const fs::path& path, const Scene& scene, const DisplayTransform& display,
                        Inputs& inputs) {
  const Image film = read_film(path, &inputs);
  if (const auto recorded = recorded_display_exposure(film, path)) return *recorded;
  for (const std::string& plane : scene.spectral ? std::vector<std::string>{} : scene.film_planes())
    if (film.find(plane) == nullptr)
      throw Error(ErrorCode::input, path.string(),
                  fmt::format("--exposure-of needs a film of the same sensor: has no channel \"{}\"", plane));
  return 1 / display.automatic_scale(shown_film(scene, film));
}

Showing showing_of(const Scene& scene, const RenderOptions& options, Inputs& inputs) {
  Showing showing{display_of(scene, chosen_view(options)), scene.output.display_exposure};
  if (!options.exposure_of.empty())
    showing.shown_as_white = exposure_of_film(options.exposure_of, scene, showing.display, inputs);
  return showing;
}

// The film value that the pictures show as white.
double write_pictures(const Outputs& outputs, const Showing& showing, const Image& film, bool quiet) {
  const std::optional<double>& white = showing.shown_as_white;
  const DisplayPicture picture = showing.display(film, white ? std::optional(1 / *white) : std::nullopt);
  if (!outputs.display.empty()) write_picture(outputs.display, picture.image);
  if (!outputs.gamut.empty()) write_picture(outputs.gamut, picture.outside);
  if (!quiet && picture.outside_share + picture.clipped_share > 0)
    say(fmt::format("{:.1f} % of the pixels lay outside the display's gamut, {:.1f} % were too bright for it",
                    100 * picture.outside_share, 100 * picture.clipped_share));
  if (!quiet && !white)
    say(fmt::format("the picture shows the film value {:.4g} as white", 1 / picture.scale));
  return 1 / picture.scale;
}

void write_results(const RenderOptions& options, const Outputs& outputs,
                   const std::optional<Showing>& showing, const Scene& scene, const RenderPart& part,
                   Costs& costs) {
  std::optional<double> shown_as_white;
  const auto write_display = [&] {
    shown_as_white = write_pictures(outputs, *showing, shown_film(scene, film_image(part)), options.quiet);
  };
  std::vector<std::function<void()>> writers;
  if (!options.checkpoint.empty())
    writers.emplace_back(
        metered(costs.write, [&] { write_part(options.checkpoint, part.identity, part.result); }));
  writers.emplace_back(metered(costs.write, [&] { write_film(outputs.film, part); }));
  if (showing) writers.emplace_back(metered(costs.display, write_display));
  if (!options.stats.empty())
    writers.emplace_back(
        [&] { write_stats(outputs.stats, stats_text(scene, part.result, costs, shown_as_white)); });
  write_all(writers);
}

void tell_results(const RenderOptions& options, const fs::path& film, const Scene& scene,
                  const RenderResult& result, const Cost& plan) {
  const RenderStats& stats = result.stats;
  if (!options.quiet)
    say(fmt::format("{} after {} samples per pixel in {:.3g} s{}", film.string(), stats.samples_per_pixel,
                    plan.wall_s + stats.wall_s, error_text(stats.error, ", ")));
  if (options.target_error && !options.time_limit_s && !stats.interrupted &&
      !std::isfinite(stats.error.median))
    say("warning: a pilot found no light on the film: --error had nothing to wait for");
  for (const std::string& loss : left_out(scene, result)) say("warning: " + loss);
}

}  // namespace

int render(const RenderOptions& options) {
  Costs costs;
  Inputs inputs(options.max_memory_bytes);
  const LeaderTells silence(crew());
  Scene scene = load_together(options, inputs, crew());
  const int threads = thread_count(options.threads);
  if (crew().rank != 0) {
    const IntegratorChoice choice = choose_integrator(scene, threads);
    scene.render.integrator = choice.integrator;
    Watchers none;
    ProgressDisplay display;
    (void)develop(scene, options, choice.guides, InterruptWatch(), none, display);
    return 0;
  }
  const Outputs outputs = choose_outputs(options, scene, inputs);
  check_ranges(options, scene);
  (void)how_to_render(options, scene);  // tells wrong layers before any pilot is traced
  const InterruptWatch watch;
  std::deque<FileLock> locks;
  for (const fs::path& output : files_of(outputs, options))
    if (!output.empty()) locks.emplace_back(output);
  const bool leaves_integrator = scene.render.integrator == Integrator::automatic;
  costs.load = costs.command.spent();
  const CostMeter planning;
  ProgressDisplay progress;
  if (!options.quiet) progress.prepare();
  const IntegratorChoice choice = choose_integrator(scene, threads);
  scene.render.integrator = choice.integrator;
  settle_white(scene, options.scene, threads, choice.guides);
  progress.clear();
  costs.plan = planning.spent();
  std::optional<Showing> showing;
  if (!outputs.display.empty() || !outputs.gamut.empty())
    metered(costs.display, [&] { showing = showing_of(scene, options, inputs); })();
  if (showing) require_distinct(files_of(outputs, options), showing->display.files());
  if (options.explain) tell(describe(scene, choice));
  if (!options.quiet) note_polarisation(scene);
  warn_of_unpolarised_measurement(scene, options.strict);
  warn_of_dark_camera(scene, options.strict);
  warn_of_hidden_sheet(scene, options.strict);
  warn_of_hidden_lamp(scene, options.strict);
  warn_of_lost_light(scene, options.strict && !leaves_integrator);
  warn_of_rare_photons(choice.guides.get());
  warn_of_unused_settings(scene);

  inputs.take_memory("the film", film_bytes(scene, how_to_render(options, scene)));
  inputs.take_memory("the paths from lights of a sample", bytes_of_light_paths(scene));
  Watchers watchers;
  call_watchers(watchers, scene, options, inputs);
  const RenderPart part = develop(scene, options, choice.guides, watch, watchers, progress);
  write_results(options, outputs, showing, scene, part, costs);
  watchers.end(part.result);
  const RenderStats& stats = part.result.stats;
  tell_results(options, outputs.film, scene, part.result, costs.plan);
  if (stats.interrupted) return kSignalExit + watch.signal();
  return options.strict && stats.nonfinite_samples > 0 ? static_cast<int>(ErrorCode::internal) : 0;
}

}  // namespace abbe::cli
