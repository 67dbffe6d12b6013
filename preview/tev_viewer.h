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
#include "preview/viewer_film.h"
#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe {

/// Shows a render in progress in the image viewer tev: all channels of the film's file except variances. A
/// thread of its own sends them. Snapshots and sending take at most 1 % of the CPU time. `viewer_is_ready`,
/// `show` and `end` are called from one thread, that of the render.
class TevViewer {
 public:
  /// Connects to the viewer at `address` for a render of `scene`, which must outlive it, on `threads` threads
  /// (at least 1). `identity` are the attributes of the film.
  /// `warn` is called at most once, from the sending thread, if the viewer closes the connection or takes
  /// nothing for three seconds. The render continues without it. Throws Error{output} if no viewer listens at
  /// the address.
  TevViewer(const Scene& scene, FilmIdentity identity, const ServerAddress& address, int threads,
            std::function<void(const std::string&)> warn);
  /// Sends the queued image, if there is one, and disconnects.
  ~TevViewer();
  TevViewer(const TevViewer&) = delete;
  TevViewer& operator=(const TevViewer&) = delete;

  /// True if the viewer is connected and has received the previous image, and a new one is due: 0.2 s after
  /// the last one, or later if the limit of CPU time requires that.
  [[nodiscard]] bool viewer_is_ready();
  /// Takes a snapshot of the film and queues it in place of one that waits. No thread may add to the film
  /// meanwhile.
  void show(const RenderResult& result);
  /// Sends the last film and waits until it is sent. Returns earlier if the viewer is gone. No thread may add
  /// to the film meanwhile.
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
