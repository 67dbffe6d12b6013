#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "sensor/film/film.h"

namespace abbe {

/// Processes that render one film together: each traces its share of one list of passes, and
/// the first collects the exact sums. All call the same functions in the same order; a process alone calls
/// none of them.
struct Crew {
  int rank = 0;  ///< Of this process, from 0 to size - 1; 0 keeps the film.
  int size = 1;
  /// Adds the numbers of all processes to those of the first, and sets those of the others to 0.
  std::function<void(std::span<Int128> numbers)> collect = {};
  /// What the first process says.
  std::function<std::uint64_t(std::uint64_t said)> follow = {};
};

}  // namespace abbe
