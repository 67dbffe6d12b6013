#include "python/job.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "description/render.h"
#include "io/error.h"
#include "python/gil.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

// Interval at which the caller checks for signals and reports progress; long enough to cost nothing.
constexpr std::chrono::milliseconds kPause{50};

/// A render on another thread, so that the calling thread can serve Python.
class Job {
 public:
  Job(const abbe::Scene& scene, RenderOptions how, bool reports_progress) : how_(std::move(how)) {
    how_.stop = &stop_;
    if (reports_progress) how_.progress = [this](const Progress& progress) { store(progress); };
    thread_ = std::jthread([this, &scene] { run(scene); });
  }

  /// Calls `listen` periodically with the latest progress and the stop flag until the render ends. If it
  /// throws, the render stops after the current pass and the exception is rethrown. Requires that the caller
  /// does not hold the GIL.
  template <typename F>
  RenderResult wait(F listen) {
    std::exception_ptr interruption;
    std::unique_lock lock(mutex_);
    while (!done_) {
      changed_.wait_for(lock, kPause, [this] { return done_; });
      const std::optional<Progress> latest = std::exchange(latest_, std::nullopt);
      lock.unlock();
      if (!interruption) try {
          listen(latest, stop_);
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

  void store(const Progress& progress) {
    const std::scoped_lock lock(mutex_);
    latest_ = progress;
  }

  RenderOptions how_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Progress> latest_;
  bool done_ = false;
  std::optional<RenderResult> result_;
  std::exception_ptr failure_;
  std::jthread thread_;  // last, because it uses all other members
};

// Lets Python handle its signals and reports progress. If the interpreter ends, the render stops, because
// nobody can receive its film.
void listen(const py::object& callback, const std::optional<Progress>& latest, std::atomic<bool>& stop) {
  const auto stop_render = [&stop] { stop = true; };
  const GilAcquired gil(stop_render);
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!latest || callback.is_none()) return;
  const py::object argument = py::cast(*latest);
  py::object answer;
  unless_python_ends(
      [&] {
        answer = py::reinterpret_steal<py::object>(PyObject_CallOneArg(callback.ptr(), argument.ptr()));
      },
      stop_render);
  if (!answer) throw py::error_already_set();
}

void require_within(const char* argument, std::int64_t value, std::int64_t low, std::int64_t high) {
  if (value < low || value > high)
    throw Error(ErrorCode::usage, argument,
                fmt::format("got {}, allowed whole numbers in [{}, {}]", value, low, high));
}

}  // namespace

RenderResult render_listening(const abbe::Scene& scene, RenderOptions how, const py::object& progress) {
  Job job(scene, std::move(how), !progress.is_none());
  return job.wait([&](const std::optional<Progress>& latest, std::atomic<bool>& stop) {
    listen(progress, latest, stop);
  });
}

void require(bool holds, const char* argument, const std::string& got, const char* allowed) {
  if (!holds) throw Error(ErrorCode::usage, argument, fmt::format("got {}, allowed {}", got, allowed));
}

void require_seed(const std::optional<std::int64_t>& seed) {
  if (seed) require_within("seed", *seed, 0, kMaxSeed);
}

void require_valid(const Request& request) {
  if (request.spp) require_within("spp", *request.spp, 1, kMaxSamples);
  require_seed(request.seed);
  require_within("threads", request.threads, 0, kMaxThreads);
  require(!request.error || (*request.error > 0 && *request.error < 1), "error",
          fmt::format("{}", request.error.value_or(0)), "(0, 1)");
  require(!request.time || *request.time > 0, "time", fmt::format("{}", request.time.value_or(0)), "above 0");
  // The number of samples is either given or determined by the limits of time and error.
  const char* const given = request.spp ? "spp" : request.samples ? "sample_range" : nullptr;
  const char* const limit = request.error ? "error" : request.time ? "time" : nullptr;
  if (given != nullptr && limit != nullptr)
    throw Error(ErrorCode::usage, "", fmt::format("{} excludes {}", given, limit));
}

RenderOptions render_limits(const Request& request) {
  RenderOptions how;
  how.threads = static_cast<int>(request.threads);
  how.target_error = request.error;
  how.time_limit_s = request.time;
  return how;
}

}  // namespace abbe::python
