#pragma once

#include <functional>

namespace abbe {

/// Number of threads of a render, at least 1: `requested`, or one per processor if that is 0 or negative.
[[nodiscard]] int thread_count(int requested);

/// Calls `task` once on each of `threads` new threads, concurrently, and waits for all. Does nothing if
/// `threads` is 0 or negative. If calls throw, rethrows the first exception after all have ended.
void run_on_threads(int threads, const std::function<void()>& task);

}  // namespace abbe
