#include "cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/answer.h"

namespace abbe::cli {
namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kRedraw{200};

std::string duration(double seconds) {
  if (!(seconds < 360000)) return "a long time";
  const auto s = static_cast<int>(std::ceil(seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

}  // namespace

std::string error_text(const RelativeError& error, std::string_view before) {
  std::string text;
  const auto tell = [&](double value, std::string_view of) {
    if (std::isfinite(value)) text += fmt::format("{}{:.2g} %{}", text.empty() ? "" : ", ", 100 * value, of);
  };
  tell(error.median, " median");
  tell(error.p95, " p95");
  tell(error.frame_mean, " of the mean");
  return text.empty() ? "" : fmt::format("{}error {}", before, text);
}

std::string progress_line(const Progress& progress, bool with_bar) {
  const double share = std::clamp(progress.share, 0.0, 1.0);
  std::string line;
  if (with_bar) {
    const auto filled = static_cast<std::size_t>(share * kBarWidth);
    line = fmt::format("[{}{}] ", std::string(filled, '='), std::string(kBarWidth - filled, ' '));
  }
  line += fmt::format("{:3.0f} %  {} samples/pixel", std::floor(100 * share), progress.samples);
  if (progress.rate > 0) line += fmt::format("  {:.3g}/s", progress.rate);
  const std::string error = error_text(progress.error, "  ");
  line += error;
  if (!error.empty() && progress.error_samples != progress.samples)
    line += fmt::format(" at {}", progress.error_samples);
  if (share < 1 && !std::isnan(progress.left_s)) line += fmt::format("  {} left", duration(progress.left_s));
  return line;
}

ProgressDisplay::ProgressDisplay() : terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressDisplay::operator()(const Progress& progress) {
  const auto now = std::chrono::steady_clock::now();
  const auto tenths = static_cast<int>(10 * progress.share);
  if (terminal_) {
    if (now - shown_ < kRedraw && tenths < 10) return;
    tell(fmt::format("\r{}\x1b[K", progress_line(progress, true)));
    open_line_ = true;
  } else {
    if (tenths <= tenths_) return;
    say(progress_line(progress, false));
  }
  tenths_ = tenths;
  shown_ = now;
}

void ProgressDisplay::finish() {
  if (open_line_) tell("\n");
  open_line_ = false;
}

}  // namespace abbe::cli
