#pragma once

#include <atomic>

namespace abbe::cli {

/// Added to the number of a signal to form the exit code of an interrupted command.
inline constexpr int kSignalExit = 128;

/// Records the first signal that requests or announces the end of the program: SIGINT, SIGTERM, SIGHUP,
/// SIGUSR1, SIGUSR2, SIGXCPU, SIGALRM or SIGPWR. A second SIGINT or SIGTERM kills the program as usual; the
/// others are then ignored. Signals other than SIGINT and SIGTERM that were ignored before stay ignored. Only
/// one watch may exist at a time.
class InterruptWatch {
 public:
  /// Installs the handlers and forgets earlier signals.
  InterruptWatch();
  /// Restores the default action of the signals, except of those that are ignored.
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  /// True from the first signal on. The reference is valid for the lifetime of the program.
  [[nodiscard]] const std::atomic<bool>& stop() const;
  /// Number of the first signal; 0 if there was none.
  [[nodiscard]] int signal() const;
};

}  // namespace abbe::cli
