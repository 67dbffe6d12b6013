#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "transport/render/render.h"

namespace abbe::cli {

/// `prefix`, followed by the error of a film: the noise of its pixels and of its mean in %. If the error
/// is not known (`is_known`), a note about that takes the place of both. The text is "" without the prefix
/// only if the error is known and nothing was measured.
[[nodiscard]] std::string error_text(const RelativeError& error, std::string_view prefix);

/// Progress of a render in one line: percentage, samples per pixel and their rate, noise, time left. A log
/// contains all of it. A terminal of `columns` columns also has a bar. Rate, noise, samples and percentage
/// are omitted in this order until the line fits; the time left always stays.
[[nodiscard]] std::string progress_line(const Progress& progress, std::optional<int> columns = {});

/// Shows progress on stderr. A terminal has one line that is redrawn at most five times a second; otherwise
/// there is a line per tenth of the work. Calls must come from one thread at a time.
class ProgressDisplay {
 public:
  ProgressDisplay();
  ~ProgressDisplay() { clear(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;
  /// Shows on a terminal that pilot rays are being traced, until the next call.
  void prepare();
  /// Shows the progress of the render, unless the last line is too recent.
  void operator()(const Progress& progress);
  /// Removes the line of `prepare` from a terminal before other text is printed.
  void clear();
  /// Ends the progress line on a terminal, so that it remains visible.
  void finish();

 private:
  bool terminal_;
  int tenths_ = 0;
  bool preparing_ = false;
  bool open_line_ = false;
  std::chrono::steady_clock::time_point last_drawn_{};
};

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
  [[nodiscard]] int signal() const;
};

}  // namespace abbe::cli
