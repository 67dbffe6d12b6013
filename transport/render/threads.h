#pragma once

#include <functional>

namespace abbe {

/// Number of threads of a render: `requested`, or one per processor if that is 0.
[[nodiscard]] int thread_count(int requested);

/// Calls `task` once on each of `threads` threads and waits for all. Rethrows the exception of one of them.
void run_on_threads(int threads, const std::function<void()>& task);

}  // namespace abbe
