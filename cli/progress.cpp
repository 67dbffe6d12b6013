#include "cli/progress.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli/answer.h"
#include "results/scene_warnings.h"

namespace abbe::cli {
namespace {

constexpr std::size_t kMaxBarWidth = 30;
constexpr std::size_t kMinBarWidth = 8;
constexpr std::size_t kBarFrame = 3;  // "[", "] "
constexpr int kDefaultColumns = 80;
constexpr std::chrono::milliseconds kRedrawInterval{200};

std::string duration(double seconds) {
  if (!(seconds < 360000)) return "a long time";
  const auto s = static_cast<int>(std::ceil(seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

// Percentage with two digits, without an exponent above 100 %.
std::string percent(double fraction) {
  const double value = 100 * fraction;
  return value < 99.5 ? fmt::format("{:.2g} %", value) : fmt::format("{:.0f} %", value);
}

enum class Detail { full, brief };

// Relative noise per pixel, or a note while it is unknown; empty if nothing was measured.
std::string pixel_noise(const RelativeError& error, Detail detail) {
  if (const auto unknown = unknown_error_warning(error))
    return detail == Detail::full ? *unknown : "error not yet known";
  if (!std::isfinite(error.median)) return "";
  std::string text = fmt::format("noise {} per pixel", percent(error.median));
  if (detail == Detail::full && std::isfinite(error.p95))
    text += fmt::format(" ({} in the worst 5 %)", percent(error.p95));
  return text;
}

/// Parts that are omitted on a narrow terminal, the least important first. Each implies those before it.
enum Dropped { nothing, rate, error_samples, error_details, error, samples, percentage };

// Progress in one line without the dropped parts.
std::string line_of(const Progress& progress, Dropped dropped) {
  const double done = std::clamp(progress.fraction_done, 0.0, 1.0);
  std::string line;
  const auto append = [&line](const std::string& part) {
    if (!part.empty()) line += (line.empty() ? "" : "  ") + part;
  };
  if (dropped < percentage) append(fmt::format("{:3.0f} %", std::floor(100 * done)));
  if (dropped < samples) append(fmt::format("{} spp", progress.samples));
  if (dropped < rate && progress.rate > 0) append(fmt::format("{:.3g}/s", progress.rate));
  if (dropped < error) {
    const std::string noise =
        pixel_noise(progress.error, dropped < error_details ? Detail::full : Detail::brief);
    const bool is_older = !noise.empty() && progress.error_samples != progress.samples;
    append(is_older && dropped < error_samples ? fmt::format("{} at {} spp", noise, progress.error_samples)
                                               : noise);
  }
  if (done < 1 && !std::isnan(progress.left_s)) append(duration(progress.left_s) + " left");
  return line;
}

// Bar that fills the available columns; empty if they are too few.
std::string bar(double done, std::size_t available) {
  const std::size_t width = std::min(kMaxBarWidth, available < kBarFrame ? 0 : available - kBarFrame);
  if (width < kMinBarWidth) return "";
  const auto filled = static_cast<std::size_t>(done * static_cast<double>(width));
  return fmt::format("[{}{}] ", std::string(filled, '='), std::string(width - filled, ' '));
}

// Columns of the terminal on stderr.
int terminal_columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kDefaultColumns;
}

// Signal handlers can access globals only, and may write lock-free atomics only.
std::atomic<bool> stop_requested{false};
std::atomic<int> received_signal{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

// Requests of users: a second one ends the program at once.
constexpr std::array kRequests{SIGINT, SIGTERM};
// Announcements of an end to come, which may arrive several times. A terminal closes (SIGHUP), or the power
// fails (SIGPWR). Batch systems send what their users choose (SIGUSR1, SIGUSR2). A limit of CPU time is
// reached (SIGXCPU, each second from then on), or a timer ends (SIGALRM).
constexpr std::array kAnnouncements{SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU, SIGALRM, SIGPWR};

void restore_default() {
  for (const int number : kRequests) std::signal(number, SIG_DFL);
}

void record_signal(int number) {
  received_signal = number;
  stop_requested = true;
  restore_default();
  for (const int announcement : kAnnouncements) std::signal(announcement, SIG_IGN);
}

}  // namespace

// An unknown error gives a note, so the text is empty only if nothing was measured.
std::string error_text(const RelativeError& error, std::string_view prefix) {
  std::string text = pixel_noise(error, Detail::full);
  if (is_known(error) && std::isfinite(error.frame_mean))
    text += fmt::format("{}{} of the mean", text.empty() ? "error " : ", error ", percent(error.frame_mean));
  return text.empty() ? "" : std::string(prefix) + text;
}

std::string progress_line(const Progress& progress, std::optional<int> columns) {
  if (!columns) return line_of(progress, nothing);
  const auto width = static_cast<std::size_t>(std::max(*columns - 1, 0));  // some terminals wrap a full line
  std::string line;
  for (const Dropped dropped : {nothing, rate, error_samples, error_details, error, samples, percentage}) {
    line = line_of(progress, dropped);
    if (line.size() <= width) break;
  }
  line.resize(std::min(line.size(), width));
  return bar(std::clamp(progress.fraction_done, 0.0, 1.0), width - line.size()) + line;
}

ProgressDisplay::ProgressDisplay() : terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressDisplay::prepare() {
  if (!terminal_) return;
  print_to_stderr("\rpreparing: tracing pilot rays and photons\x1b[K");
  preparing_ = true;
}

void ProgressDisplay::clear() {
  if (preparing_) print_to_stderr("\r\x1b[K");
  preparing_ = false;
}

void ProgressDisplay::operator()(const Progress& progress) {
  const auto now = std::chrono::steady_clock::now();
  const auto tenths = static_cast<int>(10 * progress.fraction_done);
  if (terminal_) {
    if (now - last_drawn_ < kRedrawInterval && tenths < 10) return;
    print_to_stderr(fmt::format("\r{}\x1b[K", progress_line(progress, terminal_columns())));
    open_line_ = true;
    preparing_ = false;
  } else {
    if (tenths <= tenths_) return;
    print_message(progress_line(progress));
  }
  tenths_ = tenths;
  last_drawn_ = now;
}

void ProgressDisplay::finish() {
  clear();
  if (open_line_) print_to_stderr("\n");
  open_line_ = false;
}

InterruptWatch::InterruptWatch() {
  received_signal = 0;
  stop_requested = false;
  for (const int number : kRequests) std::signal(number, record_signal);
  for (const int number : kAnnouncements)
    if (std::signal(number, record_signal) == SIG_IGN)
      std::signal(number, SIG_IGN);  // stays ignored under nohup
}

InterruptWatch::~InterruptWatch() {
  restore_default();
  for (const int number : kAnnouncements)
    if (std::signal(number, SIG_IGN) == record_signal) std::signal(number, SIG_DFL);
}

const std::atomic<bool>& InterruptWatch::stop() const {
  return stop_requested;
}

int InterruptWatch::signal() const {
  return received_signal;
}

}  // namespace abbe::cli
