#pragma once

#include <cxxabi.h>
#include <unistd.h>

#include <functional>

#include <pybind11/pybind11.h>

namespace abbe::python {

/// Calls `take`, which acquires the GIL, and returns after it. If the interpreter has ended meanwhile, Python
/// ends threads that acquire the GIL; up to 3.13 it unwinds their stacks. Destructors would then release
/// Python objects without the GIL, and the program would abort. Instead, the thread calls `last` and sleeps
/// until the process exits, which is what Python does from 3.14 on.
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

/// Holds the GIL during its lifetime, on a thread that Python started. It acquires the GIL if a `GilReleased`
/// has released it, and does nothing otherwise. `last` is that of `unless_python_ends`.
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
