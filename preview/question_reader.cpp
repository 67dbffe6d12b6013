#include "preview/question_reader.h"

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

QuestionReader::QuestionReader(std::function<void(int, std::string)> serve)
    : serve_(std::move(serve)), wake_(event_counter()) {
  thread_ = std::jthread([this] { run(); });
}

QuestionReader::~QuestionReader() {
  stop();
  (void)::close(wake_);
}

void QuestionReader::add(int socket) {
  {
    const std::scoped_lock lock(mutex_);
    asking_.emplace(next_++, Asking{socket, Clock::now() + kAskWithin});
    make_room();
  }
  wake();
}

void QuestionReader::served() {
  const std::scoped_lock lock(mutex_);
  --serving_;
}

void QuestionReader::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
  }
  wake();
  if (thread_.joinable()) thread_.join();
  for (const auto& [number, asking] : asking_) (void)::close(asking.socket);
  asking_.clear();
}

void QuestionReader::wake() const {
  const std::uint64_t one = 1;
  (void)!::write(wake_, &one, sizeof one);  // fails only if it is due anyway
}

// Reads the bytes of a request that have arrived, without waiting for more.
QuestionReader::Progress QuestionReader::read_some(Asking& asking) {
  std::array<char, 2048> block{};
  while (asking.question.size() < kMaxQuestionBytes) {
    const std::size_t room = std::min(block.size(), kMaxQuestionBytes - asking.question.size());
    const ssize_t got = ::recv(asking.socket, block.data(), room, MSG_DONTWAIT);
    if (got < 0) return errno == EAGAIN || errno == EINTR ? Progress::waits : Progress::fails;
    if (got == 0) return Progress::fails;
    const std::size_t from = asking.question.size() - std::min(asking.question.size(), kEnd.size() - 1);
    asking.question.append(block.data(), static_cast<std::size_t>(got));
    if (asking.question.find(kEnd, from) != std::string::npos) return Progress::whole;
  }
  return Progress::fails;
}

// Reads on, and passes on a question that is whole. `otherwise` is what becomes of one that waits for more.
// Gives the next connection.
QuestionReader::Connections::iterator QuestionReader::advance(Connections::iterator at, Progress otherwise) {
  Progress progress = read_some(at->second);
  if (progress == Progress::waits) progress = otherwise;
  if (progress == Progress::waits) return std::next(at);
  Asking asking = std::move(at->second);
  const auto next = asking_.erase(at);
  if (progress == Progress::whole) {
    ++serving_;
    serve_(asking.socket, std::move(asking.question));
  } else {
    (void)::close(asking.socket);
  }
  return next;
}

// All have the same time, so that the oldest are late first.
void QuestionReader::drop_late() {
  const Clock::time_point now = Clock::now();
  for (auto at = asking_.begin(); at != asking_.end() && at->second.until <= now;)
    at = advance(at, Progress::fails);
}

void QuestionReader::make_room() {
  for (auto at = asking_.begin(); at != asking_.end() && asking_.size() + serving_ > kMaxConnections;)
    at = advance(at, Progress::fails);
}

int QuestionReader::wait_ms() const {
  if (asking_.empty()) return -1;
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(asking_.begin()->second.until - Clock::now());
  return std::max(0, static_cast<int>(left.count()));
}

void QuestionReader::run() {
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
      for (const auto& [number, asking] : asking_) {
        polled.push_back({asking.socket, POLLIN, 0});
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
      // Another thread may have closed it meanwhile.
      if (const auto at = asking_.find(numbers[i]); at != asking_.end()) (void)advance(at, Progress::waits);
    }
  }
}

}  // namespace abbe
