#pragma once

#include <cxxabi.h>
#include <unistd.h>

#include <functional>

#include <pybind11/pybind11.h>

namespace abbe::python {

/// Does what takes Python's lock. Where Python has ended meanwhile, it ends the threads that ask for its
/// lock, up to 3.13 by unwinding their stacks: destructors would give objects back without the lock or ask
/// for it again, and the program abort. Such a thread does `last` and sleeps for the rest of the program, as
/// from 3.14 on Python itself lets it.
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

/// Lets other threads of Python run while it lives. To be made with Python's lock.
class Released {
 public:
  Released();
  ~Released();
  Released(const Released&) = delete;
  Released& operator=(const Released&) = delete;
};

/// Holds Python's lock while it lives, on a thread that came from Python: takes it where a `Released` has
/// given it up. `last` is that of `unless_python_ends`.
class Held {
 public:
  explicit Held(const std::function<void()>& last = [] {});
  ~Held();
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

 private:
  bool took_;
};

}  // namespace abbe::python
