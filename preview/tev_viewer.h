#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "io/image.h"
#include "preview/page_server.h"
#include "preview/snapshot.h"
#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe {

/// Shows a render in the viewer tev while it runs: all channels that the film's file will have, but for
/// variances. A thread of its own sends them, and all of it takes no more than a hundredth of the time.
class TevViewer {
 public:
  /// Of a scene that outlives it, rendered on so many threads. `warn` is told, once and from another thread,
  /// when the viewer goes away; the render then goes on without. Throws Error{output} when no viewer listens
  /// there.
  TevViewer(const Scene& scene, FilmIdentity identity, const ServerAddress& address, int threads,
            std::function<void(const std::string&)> warn);
  ~TevViewer();
  TevViewer(const TevViewer&) = delete;
  TevViewer& operator=(const TevViewer&) = delete;

  /// Whether the viewer is there, has taken what it was sent, and it is time for more.
  [[nodiscard]] bool wants_to_see();
  /// Takes a snapshot of a film that no thread adds to.
  void show(const RenderResult& result);
  /// Shows the last film, and waits until it is sent.
  void end(const RenderResult& result);

 private:
  using Clock = std::chrono::steady_clock;

  void send_all();
  [[nodiscard]] bool send_image(const Image& film);
  [[nodiscard]] bool send(const std::string& packet) const;

  const Scene& scene_;
  const FilmIdentity identity_;
  const std::string image_;
  const int threads_;
  const std::function<void(const std::string&)> warn_;
  int socket_ = -1;
  bool created_ = false;
  Clock::time_point shown_{};
  double cost_s_ = 0;  // of the last snapshot, on all threads

  std::mutex mutex_;  // of all that follows
  std::condition_variable changed_;
  std::optional<Image> waiting_;
  double sending_s_ = 0;  // of the last image
  bool busy_ = false;
  bool gone_ = false;
  bool ending_ = false;
  std::jthread sender_;
};

}  // namespace abbe
