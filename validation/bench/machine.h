#pragma once

#include <string>

namespace abbe {

/// The machine, and the compiler that built this program.
struct Machine {
  std::string cpu;       ///< Model name as the operating system reports it; "unknown" without one.
  int cores;             ///< Number of logical processors; 0 if unknown.
  std::string compiler;  ///< Name and version.
  std::string flags;
  std::string date;  ///< Time of the call to `this_machine` in UTC, such as "2026-05-31T12:00:00Z".
};

[[nodiscard]] Machine this_machine();

}  // namespace abbe
