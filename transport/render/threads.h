#pragma once

#include <functional>

namespace abbe {

/// Threads a render runs on: as many as asked for, or one per processor when asked for none.
[[nodiscard]] int thread_count(int asked);

/// Calls `task` once on each of that many threads and waits for all; the exception of one of them is thrown
/// again here.
void run_on_threads(int threads, const std::function<void()>& task);

}  // namespace abbe
