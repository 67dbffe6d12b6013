#include "cli/interrupt.h"

#include <csignal>

namespace abbe::cli {
namespace {

// Signal handlers can reach only globals; lock-free atomics are the ones they may write.
std::atomic<bool> stop_asked{false};
std::atomic<int> signal_seen{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void use_default() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

void remember(int number) {
  signal_seen = number;
  stop_asked = true;
  use_default();
  std::signal(SIGHUP, SIG_IGN);  // a closing terminal sends it once and its shell once more
}

}  // namespace

InterruptWatch::InterruptWatch() {
  signal_seen = 0;
  stop_asked = false;
  std::signal(SIGINT, remember);
  std::signal(SIGTERM, remember);
  if (std::signal(SIGHUP, remember) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // as nohup wants it
}

InterruptWatch::~InterruptWatch() {
  use_default();
  if (std::signal(SIGHUP, SIG_IGN) == remember) std::signal(SIGHUP, SIG_DFL);
}

const std::atomic<bool>& InterruptWatch::stop() const {
  return stop_asked;
}

int InterruptWatch::signal() const {
  return signal_seen;
}

}  // namespace abbe::cli
