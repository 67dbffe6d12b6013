#pragma once

#include <atomic>

namespace abbe::cli {

/// What is added to a signal's number where it ends a command early.
inline constexpr int kSignalExit = 128;

/// Remembers the first signal that asks the program to end or announces that it will be ended: SIGINT,
/// SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU, SIGALRM or SIGPWR. After it another SIGINT or SIGTERM kills as
/// usual, and the others are ignored. A signal of these others that was ignored before stays so. One watch at
/// a time.
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
