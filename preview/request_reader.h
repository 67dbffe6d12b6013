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

/// Reads HTTP requests up to their end, on one thread for all connections. So a slow or silent client does
/// not occupy a thread that answers requests.
///
/// A request ends with an empty line. A connection is closed if its request is longer than 8 KiB or
/// incomplete after two seconds. If there are more than 256 connections, the one with the oldest incomplete
/// request is closed.
class RequestReader {
 public:
  static constexpr std::size_t kMaxRequestBytes = 8192;
  static constexpr std::chrono::seconds kRequestTimeout{2};
  static constexpr std::size_t kMaxConnections = 256;

  /// Starts the thread. `serve` takes over a socket with its complete request, and closes it. It is called by
  /// the reader's thread or within `add`, under the reader's lock: it must neither wait for the client nor
  /// call this object. Throws Error{resource} if too many files are open.
  explicit RequestReader(std::function<void(int socket, std::string request)> serve);
  ~RequestReader();
  RequestReader(const RequestReader&) = delete;
  RequestReader& operator=(const RequestReader&) = delete;

  /// Takes over a connected socket, whose request must arrive within kRequestTimeout. Thread-safe.
  void add(int socket);
  /// Counts a connection that `serve` took over as closed; called once for each, from another thread.
  /// Thread-safe.
  void served();
  /// Ends the thread and closes the connections with incomplete requests. `serve` is not called afterwards.
  /// Called from one thread; a second call does nothing.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;
  struct PendingRequest {
    int socket;
    Clock::time_point until;
    std::string request{};
  };
  using Connections = std::map<std::uint64_t, PendingRequest>;  // by number, the oldest first
  enum class Progress { waits, whole, fails };

  void run();
  void wake() const;
  static Progress read_some(PendingRequest& pending);
  Connections::iterator advance(Connections::iterator at, Progress otherwise);
  void drop_late();
  void make_room();
  [[nodiscard]] int wait_ms() const;

  std::function<void(int, std::string)> serve_;
  const int wake_;  // event that interrupts `poll`
  std::mutex mutex_{};
  Connections pending_{};
  std::uint64_t next_ = 0;
  std::size_t serving_ = 0;
  bool stopped_ = false;
  std::jthread thread_{};
};

}  // namespace abbe
