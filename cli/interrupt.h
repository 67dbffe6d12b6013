#pragma once

#include <atomic>

namespace abbe::cli {

/// While it lives, the first SIGINT or SIGTERM is remembered and the second kills as usual. One at a time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  /// True from the first signal on.
  [[nodiscard]] const std::atomic<bool>& stop() const;
  /// The signal's number, or 0.
  [[nodiscard]] int signal() const;
};

}  // namespace abbe::cli
