#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "transport/render/render.h"

namespace abbe::cli {

/// `before` and the error of a film in words: the noise of its pixels and of its mean, or that the error is
/// not yet known. Empty if nothing was measured, as after one sample.
[[nodiscard]] std::string error_text(const RelativeError& error, std::string_view before);

/// One line on how far a render has come: percentage, samples per pixel and their rate, noise, time left. A
/// log gets all of it. A terminal of `columns` columns gets a bar too, and a
/// line that does not wrap: rate, noise, samples and percentage are dropped, in this order, before the time
/// left.
[[nodiscard]] std::string progress_line(const Progress& progress, std::optional<int> columns = {});

/// Shows progress on stderr: on a terminal one line redrawn at most five times a second, otherwise a line per
/// tenth of the work.
class ProgressDisplay {
 public:
  ProgressDisplay();
  ~ProgressDisplay() { clear(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;
  /// Shows on a terminal that pilots run, until the next call.
  void prepare();
  void operator()(const Progress& progress);
  /// Removes the line of `prepare` from a terminal, for other text to take its place.
  void clear();
  /// Ends the line of a progress on a terminal, so that it stays.
  void finish();

 private:
  bool terminal_;
  int tenths_ = 0;
  bool preparing_ = false;
  bool open_line_ = false;
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace abbe::cli
