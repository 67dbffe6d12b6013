#pragma once

#include <string>

namespace abbe {

/// Machine and compiler of a benchmark.
struct Machine {
  std::string cpu;  ///< Model name as the operating system reports it.
  int cores;        ///< Number of logical processors.
  std::string compiler;
  std::string flags;
  std::string date;  ///< Time of the call in UTC, ISO 8601.
};

[[nodiscard]] Machine this_machine();

}  // namespace abbe
