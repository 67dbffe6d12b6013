#pragma once

#include <string>

namespace abbe {

/// Where a benchmark ran.
struct Machine {
  std::string cpu;  ///< Model, as the system names it.
  int cores;        ///< Logical processors.
  std::string compiler;
  std::string flags;
  std::string date;  ///< UTC, ISO 8601.
};

[[nodiscard]] Machine this_machine();

}  // namespace abbe
