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

/// A page on which a render is watched while it runs: its picture, the spectrum or the channels of a pixel,
/// and how far it has come. What nobody looks at costs nothing, and all the looking no more than a hundredth
/// of the time.
///
/// `/` is the page itself, `/state` what `tell` and `show` were told last, as JSON, `/picture.png` with
/// `view` and `exposure` [stops] the film, `/pixel` with `x` and `y` its values as JSON.
class Preview {
 public:
  /// Of a scene that outlives it, rendered on so many threads. Throws Error{output} when the address cannot
  /// be listened on, and what `view_names` throws.
  Preview(const Scene& scene, FilmIdentity identity, const ViewOptions& view, const ServerAddress& address,
          int threads);

  [[nodiscard]] std::string url() const { return server_.url(); }

  /// Whether somebody looks and it is time for a new picture.
  [[nodiscard]] bool wants_to_see();
  /// Takes a snapshot of a film that no thread adds to.
  void show(const RenderResult& result);
  void tell(const Progress& progress);
  /// Tells those who look that the film shown last is the whole, and lets them see it for two seconds.
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
  Clock::time_point shown_{};  // when the last snapshot was taken
  double cost_s_ = 0;          // of it and of what was made of it, on all threads
  std::atomic<Clock::time_point> asked_{Clock::time_point::min()};
  std::atomic<bool> ended_{false};
  mutable std::mutex progress_mutex_;
  Progress progress_{};
  PageServer server_;  // last, since it calls the rest
};

}  // namespace abbe
