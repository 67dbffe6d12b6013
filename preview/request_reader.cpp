#include "preview/request_reader.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <utility>
#include <vector>

#include "io/error.h"

namespace abbe {
namespace {

constexpr std::string_view kEnd = "\r\n\r\n";

int event_counter() {
  const int descriptor = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (descriptor < 0) throw Error(ErrorCode::resource, "the preview", "too many files are open");
  return descriptor;
}

}  // namespace

RequestReader::RequestReader(std::function<void(int, std::string)> serve)
    : serve_(std::move(serve)), wake_(event_counter()) {
  thread_ = std::jthread([this] { run(); });
}

RequestReader::~RequestReader() {
  stop();
  (void)::close(wake_);
}

void RequestReader::add(int socket) {
  {
    const std::scoped_lock lock(mutex_);
    pending_.emplace(next_++, PendingRequest{socket, Clock::now() + kRequestTimeout});
    make_room();
  }
  wake();
}

void RequestReader::served() {
  const std::scoped_lock lock(mutex_);
  --serving_;
}

void RequestReader::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
  }
  wake();
  if (thread_.joinable()) thread_.join();
  for (const auto& [number, pending] : pending_) (void)::close(pending.socket);
  pending_.clear();
}

void RequestReader::wake() const {
  const std::uint64_t one = 1;
  (void)!::write(wake_, &one, sizeof one);  // fails only if an event is pending anyway
}

// Reads the bytes of a request that have arrived, without waiting for more.
RequestReader::Progress RequestReader::read_some(PendingRequest& pending) {
  std::array<char, 2048> block{};
  while (pending.request.size() < kMaxRequestBytes) {
    const std::size_t room = std::min(block.size(), kMaxRequestBytes - pending.request.size());
    const ssize_t got = ::recv(pending.socket, block.data(), room, MSG_DONTWAIT);
    if (got < 0) return errno == EAGAIN || errno == EINTR ? Progress::waits : Progress::fails;
    if (got == 0) return Progress::fails;
    const std::size_t from = pending.request.size() - std::min(pending.request.size(), kEnd.size() - 1);
    pending.request.append(block.data(), static_cast<std::size_t>(got));
    if (pending.request.find(kEnd, from) != std::string::npos) return Progress::whole;
  }
  return Progress::fails;
}

// Reads more of a request, and serves it if it is complete. `otherwise` applies if it is still incomplete.
// Returns the next connection.
RequestReader::Connections::iterator RequestReader::advance(Connections::iterator at, Progress otherwise) {
  Progress progress = read_some(at->second);
  if (progress == Progress::waits) progress = otherwise;
  if (progress == Progress::waits) return std::next(at);
  PendingRequest pending = std::move(at->second);
  const auto next = pending_.erase(at);
  if (progress == Progress::whole) {
    ++serving_;
    serve_(pending.socket, std::move(pending.request));
  } else {
    (void)::close(pending.socket);
  }
  return next;
}

// All requests have the same time limit, so the oldest expire first.
void RequestReader::drop_late() {
  const Clock::time_point now = Clock::now();
  for (auto at = pending_.begin(); at != pending_.end() && at->second.until <= now;)
    at = advance(at, Progress::fails);
}

void RequestReader::make_room() {
  for (auto at = pending_.begin(); at != pending_.end() && pending_.size() + serving_ > kMaxConnections;)
    at = advance(at, Progress::fails);
}

int RequestReader::wait_ms() const {
  if (pending_.empty()) return -1;
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(pending_.begin()->second.until - Clock::now());
  return std::max(0, static_cast<int>(left.count()));
}

void RequestReader::run() {
  std::vector<pollfd> polled;
  std::vector<std::uint64_t> numbers;
  for (;;) {
    int wait = 0;
    polled.assign(1, {wake_, POLLIN, 0});
    numbers.clear();
    {
      const std::scoped_lock lock(mutex_);
      if (stopped_) return;
      drop_late();
      for (const auto& [number, pending] : pending_) {
        polled.push_back({pending.socket, POLLIN, 0});
        numbers.push_back(number);
      }
      wait = wait_ms();
    }
    (void)::poll(polled.data(), polled.size(), wait);
    std::uint64_t ignored = 0;
    (void)!::read(wake_, &ignored, sizeof ignored);
    const std::scoped_lock lock(mutex_);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (polled[i + 1].revents == 0) continue;
      // Another thread may have closed the connection meanwhile.
      if (const auto at = pending_.find(numbers[i]); at != pending_.end()) (void)advance(at, Progress::waits);
    }
  }
}

}  // namespace abbe
