#pragma once

#include <atomic>

namespace abbe::cli {

/// What is added to a signal's number where it ends a command early.
inline constexpr int kSignalExit = 128;

/// While it lives, the first SIGINT, SIGTERM or SIGHUP is remembered, and another SIGINT or SIGTERM kills as
/// usual. A SIGHUP that was ignored stays so. One at a time.
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
