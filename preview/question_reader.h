#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace abbe {

/// Reads what clients of a server ask until each question is whole, on one thread for all connections. A
/// client that says nothing, or says it slowly, so takes no thread from those that answer.
///
/// A question ends with an empty line. A connection is closed if its question is longer than 8 KiB or not
/// whole within two seconds. If there are more than 256 connections, the one that has waited longest for its
/// question is closed.
class QuestionReader {
 public:
  static constexpr std::size_t kMaxQuestionBytes = 8192;
  static constexpr std::chrono::seconds kAskWithin{2};
  static constexpr std::size_t kMaxConnections = 256;

  /// `serve` takes over a socket with the question that it has sent, without waiting for its client.
  explicit QuestionReader(std::function<void(int socket, std::string question)> serve);
  ~QuestionReader();
  QuestionReader(const QuestionReader&) = delete;
  QuestionReader& operator=(const QuestionReader&) = delete;

  /// Takes over a connected socket. Any thread may call it.
  void add(int socket);
  /// Counts a connection, which `serve` has taken over, as closed. Any thread may call it.
  void served();
  /// Ends the thread and closes the connections whose questions are not whole.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;
  struct Asking {
    int socket;
    Clock::time_point until;
    std::string question{};
  };
  using Connections = std::map<std::uint64_t, Asking>;  // by their number, the oldest first
  enum class Progress { waits, whole, fails };

  void run();
  void wake() const;
  static Progress read_some(Asking& asking);
  Connections::iterator advance(Connections::iterator at, Progress otherwise);
  void drop_late();
  void make_room();
  [[nodiscard]] int wait_ms() const;

  std::function<void(int, std::string)> serve_;
  const int wake_;  // what `poll` waits for beside the sockets
  std::mutex mutex_{};
  Connections asking_{};
  std::uint64_t next_ = 0;
  std::size_t serving_ = 0;
  bool stopped_ = false;
  std::jthread thread_{};
};

}  // namespace abbe
