#include "cli/interrupt.h"

#include <array>
#include <csignal>

namespace abbe::cli {
namespace {

// Signal handlers can reach only globals; lock-free atomics are the ones they may write.
std::atomic<bool> stop_asked{false};
std::atomic<int> signal_seen{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

// Requests of users: a second one ends the program at once.
constexpr std::array kRequests{SIGINT, SIGTERM};
// Announcements of an end to come, which may arrive several times. A terminal closes (SIGHUP), or the power
// fails (SIGPWR). Batch systems send what their users choose (SIGUSR1, SIGUSR2). A limit of CPU time is
// reached (SIGXCPU, each second from then on), or a timer ends (SIGALRM).
constexpr std::array kAnnouncements{SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU, SIGALRM, SIGPWR};

void use_default() {
  for (const int number : kRequests) std::signal(number, SIG_DFL);
}

void remember(int number) {
  signal_seen = number;
  stop_asked = true;
  use_default();
  for (const int announcement : kAnnouncements) std::signal(announcement, SIG_IGN);
}

}  // namespace

InterruptWatch::InterruptWatch() {
  signal_seen = 0;
  stop_asked = false;
  for (const int number : kRequests) std::signal(number, remember);
  for (const int number : kAnnouncements)
    if (std::signal(number, remember) == SIG_IGN) std::signal(number, SIG_IGN);  // as nohup wants it
}

InterruptWatch::~InterruptWatch() {
  use_default();
  for (const int number : kAnnouncements)
    if (std::signal(number, SIG_IGN) == remember) std::signal(number, SIG_DFL);
}

const std::atomic<bool>& InterruptWatch::stop() const {
  return stop_asked;
}

int InterruptWatch::signal() const {
  return signal_seen;
}

}  // namespace abbe::cli
