#include "python/gil.h"

#include <utility>

namespace abbe::python {
namespace {

// State of the thread while it has released the GIL, otherwise nullptr. It is stored here because an
// interpreter that has ended does not return it.
thread_local PyThreadState* released_state = nullptr;

void reacquire(const std::function<void()>& last) {
  PyThreadState* const state = std::exchange(released_state, nullptr);
  unless_python_ends([state] { PyEval_RestoreThread(state); }, last);
}

}  // namespace

GilReleased::GilReleased() {
  released_state = PyEval_SaveThread();
}

GilReleased::~GilReleased() {
  reacquire([] {});
}

GilAcquired::GilAcquired(const std::function<void()>& last) : reacquired_(released_state != nullptr) {
  if (reacquired_) reacquire(last);
}

GilAcquired::~GilAcquired() {
  if (reacquired_) released_state = PyEval_SaveThread();
}

}  // namespace abbe::python
