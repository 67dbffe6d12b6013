#include "transport/render/render.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "description/render_limits.h"
#include "film/rendered_film.h"
#include "film/shortcomings.h"
#include "python/arguments.h"
#include "python/errors.h"
#include "python/film.h"
#include "python/render.h"
#include "python/scene.h"
#include "transport/render/collect.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

// How often the caller looks for signals and tells its callback: seldom enough to cost nothing.
constexpr std::chrono::milliseconds kPause{50};

/// A render on a thread of its own, so that the thread that called it can listen to Python.
class Job {
 public:
  Job(const abbe::Scene& scene, RenderOptions how, bool tells) : how_(std::move(how)) {
    how_.stop = &stop_;
    if (tells) how_.progress = [this](const Progress& progress) { remember(progress); };
    thread_ = std::jthread([this, &scene] { run(scene); });
  }

  /// Calls `listen` with what is new every moment until the render ends; where it throws, the render stops
  /// after the pass that runs, and that exception is thrown again. To be called without Python's lock.
  template <typename F>
  RenderResult wait(F listen) {
    std::exception_ptr interruption;
    std::unique_lock lock(mutex_);
    while (!done_) {
      changed_.wait_for(lock, kPause, [this] { return done_; });
      const std::optional<Progress> news = std::exchange(news_, std::nullopt);
      lock.unlock();
      if (!interruption) try {
          listen(news);
        } catch (...) {
          interruption = std::current_exception();
          stop_ = true;
        }
      lock.lock();
    }
    if (interruption) std::rethrow_exception(interruption);
    if (failure_) std::rethrow_exception(failure_);
    return *std::move(result_);
  }

 private:
  void run(const abbe::Scene& scene) {
    try {
      result_ = abbe::render(scene, how_);
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    done_ = true;
    changed_.notify_all();
  }

  void remember(const Progress& progress) {
    const std::scoped_lock lock(mutex_);
    news_ = progress;
  }

  RenderOptions how_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Progress> news_;
  bool done_ = false;
  std::optional<RenderResult> result_;
  std::exception_ptr failure_;
  std::jthread thread_;  // last, since it uses all of the others
};

/// The arguments of `render`.
struct Request {
  std::optional<std::int64_t> spp;
  std::optional<std::int64_t> seed;
  std::int64_t threads;
  std::optional<double> error;
  std::optional<double> time;
  std::optional<std::pair<std::uint64_t, std::uint64_t>> samples;
};

void require_within(const char* argument, std::int64_t value, std::int64_t low, std::int64_t high) {
  if (value < low || value > high)
    throw Error(ErrorCode::usage, argument,
                fmt::format("got {}, allowed whole numbers in [{}, {}]", value, low, high));
}

// Time and error decide how many samples there are, unless these are given.
void require_compatible(const Request& request) {
  const std::pair<bool, const char*> fixed[]{{request.spp.has_value(), "spp"},
                                             {request.samples.has_value(), "sample_range"}};
  const std::pair<bool, const char*> open[]{{request.error.has_value(), "error"},
                                            {request.time.has_value(), "time"}};
  for (const auto& [given, argument] : fixed)
    for (const auto& [also, other] : open)
      if (given && also) throw Error(ErrorCode::usage, "", fmt::format("{} excludes {}", argument, other));
}

void require(bool holds, const char* argument, const std::string& got, const char* allowed) {
  if (!holds) throw Error(ErrorCode::usage, argument, fmt::format("got {}, allowed {}", got, allowed));
}

void require_valid(const Request& request) {
  if (request.spp) require_within("spp", *request.spp, 1, kMaxSamples);
  if (request.seed) require_within("seed", *request.seed, 0, kMaxSeed);
  require_within("threads", request.threads, 0, kMaxThreads);
  require(!request.error || (*request.error > 0 && *request.error < 1), "error",
          fmt::format("{}", request.error.value_or(0)), "(0, 1)");
  require(!request.time || *request.time > 0, "time", fmt::format("{}", request.time.value_or(0)), "above 0");
  require_compatible(request);
}

RenderOptions how_to_render(const Request& request, int stated) {
  RenderOptions how;
  how.threads = static_cast<int>(request.threads);
  how.target_error = request.error;
  how.time_limit_s = request.time;
  how.adaptive = how.time_limit_s && !how.target_error;
  how.measure_error = false;
  if (!request.samples) return how;
  const auto [first, last] = *request.samples;
  require(first < last && last <= static_cast<std::uint64_t>(stated), "sample_range",
          fmt::format("({}, {})", first, last), "first < last, up to the samples of the whole render");
  how.samples = SampleRange{first, last};
  return how;
}

// The scene with the settings asked for; a copy only where they are not its own.
std::optional<abbe::Scene> changed(const abbe::Scene& scene, const Request& request) {
  RenderSettings settings = scene.render;
  if (request.spp) settings.samples = static_cast<int>(*request.spp);
  if (request.seed) settings.seed = static_cast<std::uint64_t>(*request.seed);
  if (settings.samples == scene.render.samples && settings.seed == scene.render.seed) return std::nullopt;
  std::optional<abbe::Scene> copy = scene;
  copy->render = settings;
  return copy;
}

// Lets Python handle its signals, and tells what is new.
void listen(const py::object& callback, const std::optional<Progress>& news) {
  const py::gil_scoped_acquire held;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (news && !callback.is_none()) callback(*news);
}

FilmHandle render_scene(SceneHandle& handle, const Request& request, const py::object& progress) {
  require_valid(request);
  const py::gil_scoped_release released;
  const abbe::Scene& own = handle.with_white(static_cast<int>(request.threads));
  const std::optional<abbe::Scene> copy = changed(own, request);
  const abbe::Scene& scene = copy ? *copy : own;
  const RenderOptions how = how_to_render(request, scene.render.samples);
  Inputs inputs = handle.inputs();
  inputs.take_memory("the film", film_bytes(scene, how));
  inputs.take_memory("the paths from lights of a sample", bytes_of_light_paths(scene));
  FilmIdentity identity = identity_of(scene, handle.name(), how);
  for (const auto& shortcoming : {dark_camera(scene), lost_light(scene)})
    if (shortcoming) warn(*shortcoming);
  Job job(scene, how, !progress.is_none());
  RenderResult result = job.wait([&](const std::optional<Progress>& news) { listen(progress, news); });
  for (const std::string& loss : left_out(scene, result.stats)) warn(loss);
  return FilmHandle(RenderPart{std::move(identity), std::move(result)});
}

}  // namespace

void add_render(py::module_& module) {
  py::class_<Progress> progress(module, "Progress", "How far a render has come.");
  forbid_bare_new(progress);
  progress
      .def_readonly("share", &Progress::share,
                    "The share of the work that is done, in [0, 1]; an estimate where time or error decides.")
      .def_readonly("samples", &Progress::samples, "How many samples of each pixel are finished.")
      .def_readonly("elapsed_s", &Progress::elapsed_s, "The time since the render began, in s.")
      .def_property_readonly(
          "error", [](const Progress& p) { return p.error.median; },
          "The median relative error of the lit values so far; infinite while it is not known.");
  module.def(
      "render",
      [](SceneHandle& scene, std::optional<std::int64_t> spp, std::optional<std::int64_t> seed,
         std::int64_t threads, std::optional<double> error, std::optional<double> time,
         const py::object& progress, std::optional<std::pair<std::uint64_t, std::uint64_t>> samples) {
        return render_scene(scene, {spp, seed, threads, error, time, samples}, progress);
      },
      py::arg("scene"), py::kw_only(), py::arg("spp") = py::none(), py::arg("seed") = py::none(),
      py::arg("threads") = 0, py::arg("error") = py::none(), py::arg("time") = py::none(),
      py::arg("progress") = py::none(), py::arg("sample_range") = py::none(),
      "Renders a scene and returns its film, of the bits that `abbe render` gives, whatever the threads.\n\n"
      "`spp` and `seed` replace what the scene says; `threads` is one per processor unless given. `error` "
      "ends the "
      "render at that median relative error (0.01 for a percent), `time` after so many seconds, both at the "
      "end of "
      "a pass; neither goes with `spp` or `sample_range`. `progress` is called after passes with a Progress, "
      "on the calling thread. `sample_range` "
      "(first, last) "
      "renders these samples only, for `merge`. Other threads of Python run meanwhile. Ctrl-C, and what "
      "`progress` "
      "raises, end the render after the pass that runs and are raised here.");
}

}  // namespace abbe::python
