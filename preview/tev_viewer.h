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

/// Shows a render in progress in the image viewer tev: all channels of the film's file except variances. A
/// thread of its own sends them. Snapshots and sending take at most 1 % of the CPU time.
class TevViewer {
 public:
  /// Connects to the viewer for a render of `scene`, which must outlive it, on `threads` threads. `warn` is
  /// called once, from another thread, if the viewer closes the connection; the render continues without it.
  /// Throws Error{output} if no viewer listens at the address.
  TevViewer(const Scene& scene, FilmIdentity identity, const ServerAddress& address, int threads,
            std::function<void(const std::string&)> warn);
  ~TevViewer();
  TevViewer(const TevViewer&) = delete;
  TevViewer& operator=(const TevViewer&) = delete;

  /// True if the viewer is connected and has received the previous image, and a new one is due.
  [[nodiscard]] bool viewer_is_ready();
  /// Takes a snapshot of the film and queues it. No thread may add to the film meanwhile.
  void show(const RenderResult& result);
  /// Sends the last film and waits until it is sent.
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
  Clock::time_point last_snapshot_{};
  double cost_s_ = 0;  // CPU time of the last snapshot

  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::optional<Image> waiting_;
  double sending_s_ = 0;  // time to send the last image
  bool busy_ = false;
  bool gone_ = false;
  bool ending_ = false;
  std::jthread sender_;
};

}  // namespace abbe
