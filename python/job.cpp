#include "python/job.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "python/lock.h"

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

  /// Calls `listen` with what is new every moment until the render ends, and with what stops it; where it
  /// throws, the render stops after the pass that runs, and that exception is thrown again. To be called
  /// without Python's lock.
  template <typename F>
  RenderResult wait(F listen) {
    std::exception_ptr interruption;
    std::unique_lock lock(mutex_);
    while (!done_) {
      changed_.wait_for(lock, kPause, [this] { return done_; });
      const std::optional<Progress> news = std::exchange(news_, std::nullopt);
      lock.unlock();
      if (!interruption) try {
          listen(news, stop_);
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

// Lets Python handle its signals, and tells what is new. Where Python ends, the render stops, as nobody will
// have its film.
void listen(const py::object& callback, const std::optional<Progress>& news, std::atomic<bool>& stop) {
  const auto stop_render = [&stop] { stop = true; };
  const Held held(stop_render);
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!news || callback.is_none()) return;
  const py::object told = py::cast(*news);
  py::object answer;
  unless_python_ends(
      [&] { answer = py::reinterpret_steal<py::object>(PyObject_CallOneArg(callback.ptr(), told.ptr())); },
      stop_render);
  if (!answer) throw py::error_already_set();
}

}  // namespace

RenderResult render_listening(const abbe::Scene& scene, RenderOptions how, const py::object& progress) {
  Job job(scene, std::move(how), !progress.is_none());
  return job.wait(
      [&](const std::optional<Progress>& news, std::atomic<bool>& stop) { listen(progress, news, stop); });
}

}  // namespace abbe::python
