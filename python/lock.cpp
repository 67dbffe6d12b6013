#include "python/lock.h"

#include <utility>

namespace abbe::python {
namespace {

// What the thread is to Python while it has given up the lock; nullptr while it holds it. Kept here, since an
// interpreter that has ended tells it no more.
thread_local PyThreadState* released_state = nullptr;

void take_again(const std::function<void()>& last) {
  PyThreadState* const state = std::exchange(released_state, nullptr);
  unless_python_ends([state] { PyEval_RestoreThread(state); }, last);
}

}  // namespace

Released::Released() {
  released_state = PyEval_SaveThread();
}

Released::~Released() {
  take_again([] {});
}

Held::Held(const std::function<void()>& last) : took_(released_state != nullptr) {
  if (took_) take_again(last);
}

Held::~Held() {
  if (took_) released_state = PyEval_SaveThread();
}

}  // namespace abbe::python
