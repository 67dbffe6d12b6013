#include "cli/interrupt.h"

#include <array>
#include <csignal>

namespace abbe::cli {
namespace {

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
