#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "sensor/film/film.h"

namespace abbe {

/// The MPI processes that render one film together. Each process traces some of the passes, and rank 0 adds
/// up the exact sums. All processes call the same functions in the same order. A single process calls none,
/// and they may be empty.
struct MpiGroup {
  int rank = 0;  ///< Rank of this process, 0 to size - 1. Rank 0 holds the film.
  int size = 1;  ///< Number of processes.
  /// Adds `numbers` of all processes to those of rank 0 and sets those of the other processes to 0.
  std::function<void(std::span<Int128> numbers)> reduce = {};
  /// Returns on every process the `value` that rank 0 passed.
  std::function<std::uint64_t(std::uint64_t value)> broadcast = {};
};

}  // namespace abbe
