#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>

#include "calibration/output/display.h"
#include "preview/page_server.h"
#include "preview/viewer_film.h"
#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe {

/// A web page that shows a render in progress: the picture, the spectrum or channels of a pixel, and the
/// progress. A viewer is a browser that requested something other than the page in the last three seconds.
/// Without viewers it costs nothing; with viewers it takes at most 1 % of the CPU time.
/// - `/` is the page, `/state` the latest progress as JSON.
/// - `/picture.png` is the picture with the parameters `view` and `exposure` [stops, -30 to 30]. By default
///   they are the first view and 0.
/// - `/pixel` is the pixel `x`, `y` as JSON, counted from 0 at the top left.
/// - Every other path or parameter value gets the answer 404, as do pictures and pixels before the first
///   snapshot.
/// `viewer_is_ready`, `show` and `end` are called from one thread, that of the render.
class Preview {
 public:
  /// Starts the server for a render of `scene`, which must outlive it, on `threads` threads (at least 1).
  /// `identity` are the attributes of the film, `view` selects the display. Throws:
  /// - Error{output} if the address cannot be listened on;
  /// - Error{usage} for an unknown display or view;
  /// - Error{input} for an unreadable colour configuration;
  /// - Error{resource} if too many files are open.
  Preview(const Scene& scene, FilmIdentity identity, const ViewOptions& view, const ServerAddress& address,
          int threads);

  [[nodiscard]] std::string url() const { return server_.url(); }

  /// True if there is a viewer and a new snapshot is due. It is due 0.2 s after the last snapshot, or later
  /// if the limit of CPU time requires that.
  [[nodiscard]] bool viewer_is_ready();
  /// Shows a snapshot of the film, which it copies. No thread may add to the film meanwhile.
  void show(const RenderResult& result);
  /// Sets the progress that `/state` reports. Thread-safe.
  void set_progress(const Progress& progress);
  /// Shows the finished film to viewers and waits two seconds, so that they can load it. Returns at once if
  /// there are none. No thread may add to the film meanwhile.
  void end(const RenderResult& result);

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] PageAnswer answer(const PageRequest& request);
  [[nodiscard]] PageAnswer state() const;
  [[nodiscard]] PageAnswer picture(const PageRequest& request);
  [[nodiscard]] PageAnswer pixel(const PageRequest& request);
  [[nodiscard]] bool is_watched() const;

  const Scene& scene_;
  const FilmIdentity identity_;
  const int threads_;
  ViewerFilm film_;
  Clock::time_point last_snapshot_{};  // time of the last snapshot
  double cost_s_ = 0;                  // CPU time of the last snapshot and its pictures
  std::atomic<Clock::time_point> last_request_{Clock::time_point::min()};
  std::atomic<bool> ended_{false};
  mutable std::mutex progress_mutex_;
  Progress progress_{};
  PageServer server_;  // last, because it calls the other members
};

}  // namespace abbe
