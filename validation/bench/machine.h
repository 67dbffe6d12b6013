#pragma once

#include <string>

namespace abbe {

/// The machine, and the compiler that built this program.
struct Machine {
  std::string cpu;       ///< Model name as the operating system reports it; "unknown" without one.
  int cores;             ///< Number of logical processors; 0 if unknown.
  std::string compiler;  ///< Name and version of the compiler that built this program.
  std::string flags;     ///< Options with which that compiler built it.
  std::string date;      ///< Time of the call to `this_machine` in UTC, such as "2026-05-31T12:00:00Z".
};

/// Machine, compiler and time of this call.
[[nodiscard]] Machine this_machine();

}  // namespace abbe
