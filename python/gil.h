#pragma once

#include <cxxabi.h>
#include <unistd.h>

#include <functional>

#include <pybind11/pybind11.h>

namespace abbe::python {

/// Calls `take`, which acquires the GIL. If the interpreter has ended meanwhile, Python up to 3.13 unwinds
/// the stack of the thread. Destructors would then release Python objects without the GIL, and the program
/// would abort. Instead, the thread calls `last` and sleeps until the process exits, as Python does from 3.14
/// on.
template <typename Take>
void unless_python_ends(
    Take take, const std::function<void()>& last = [] {}) {
  try {
    take();
  } catch (const abi::__forced_unwind&) {
    last();
    for (;;) pause();
  }
}

/// Releases the GIL during its lifetime, so that other Python threads run. Requires the GIL; a thread has at
/// most one such object, unless a `GilAcquired` is between them.
class GilReleased {
 public:
  GilReleased();
  ~GilReleased();
  GilReleased(const GilReleased&) = delete;
  GilReleased& operator=(const GilReleased&) = delete;
};

/// Holds the GIL during its lifetime, on a thread that Python started: acquires it if a `GilReleased` has
/// released it. `last` is that of `unless_python_ends`.
class GilAcquired {
 public:
  explicit GilAcquired(const std::function<void()>& last = [] {});
  ~GilAcquired();
  GilAcquired(const GilAcquired&) = delete;
  GilAcquired& operator=(const GilAcquired&) = delete;

 private:
  bool reacquired_;
};

}  // namespace abbe::python
