#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "transport/render/render.h"

namespace abbe::cli {

/// `before` and the relative error in percent: of the median lit value, of the 95th percentile and of the
/// mean of the film; what is not known is left out, and all of it after one sample.
[[nodiscard]] std::string error_text(const RelativeError& error, std::string_view before);

/// One line on how far a render has come: share, samples and their rate, error, time left; with a bar for a
/// terminal.
[[nodiscard]] std::string progress_line(const Progress& progress, bool with_bar);

/// Shows progress on stderr: on a terminal one line redrawn at most five times a second, otherwise a line per
/// tenth of the work.
class ProgressDisplay {
 public:
  ProgressDisplay();
  void operator()(const Progress& progress);
  /// Ends the line on a terminal.
  void finish();

 private:
  bool terminal_;
  int tenths_ = 0;
  bool open_line_ = false;
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace abbe::cli
