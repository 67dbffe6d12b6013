#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/output/display.h"
#include "io/image.h"
#include "results/rendered_film.h"
#include "scene/scene.h"
#include "sensor/film/crop.h"
#include "transport/render/part.h"

namespace abbe {

/// A film in progress, after a whole number of passes.
struct Snapshot {
  std::uint64_t samples = 0;  ///< Samples per pixel.
  Crop crop = {};             ///< Rendered pixels.
  /// Means of `Scene::film_planes`, without variance, and the attributes of the film. It has the full size;
  /// pixels outside the crop are 0.
  Image film = {};
};

/// Copies the film's means on `threads` threads, because the render waits meanwhile. `identity` become the
/// attributes of the image. No thread may add to the film.
[[nodiscard]] Snapshot take_snapshot(const Scene& scene, const FilmIdentity& identity,
                                     const RenderResult& result, int threads);

/// The film that viewers see: the latest snapshot and its cached pictures. Thread-safe.
class ViewerFilm {
 public:
  /// `scene` must outlive it; `options` select the display. Throws Error{usage} for an unknown display or
  /// view, and Error{input} for an unreadable colour configuration. A sensor that no display can show is no
  /// error.
  ViewerFilm(const Scene& scene, ViewOptions options);

  /// Names that `picture` accepts, never empty: the views of the display, the selected one first, or the
  /// channels of a sensor that no display can show.
  [[nodiscard]] const std::vector<std::string>& views() const { return views_; }

  /// Replaces the latest snapshot; it does not wait for a picture in progress.
  void replace(Snapshot snapshot);
  /// Number of snapshots so far; it identifies the latest one.
  [[nodiscard]] std::uint64_t number() const;
  /// Samples per pixel of the latest snapshot; 0 before the first.
  [[nodiscard]] std::uint64_t samples() const;

  /// The latest snapshot as the bytes of a PNG in a view. `stops` multiplies the exposure that the scene
  /// requests, or the automatic one, by 2^stops. nullptr before the first snapshot and for an unknown view.
  [[nodiscard]] std::shared_ptr<const std::string> picture(const std::string& view, double stops);

  /// The values of a pixel, after `samples` samples.
  struct Pixel {
    struct Value {
      std::string channel;
      float value;                          ///< As in the film's file, in its unit.
      std::optional<double> wavelength_nm;  ///< Center of the band of a spectral channel.
    };
    std::uint64_t samples;
    std::vector<Value> values;
  };
  /// The values of the pixel in column `x` and row `y` of the latest snapshot, from 0 at the top left. Empty
  /// before the first snapshot and for a pixel that is not rendered.
  [[nodiscard]] std::optional<Pixel> pixel(int x, int y);

  /// Time spent in `picture` and `pixel` since the last call, summed over threads [s].
  [[nodiscard]] double take_time_spent() { return spent_s_.exchange(0); }

 private:
  /// A snapshot with its cached results.
  struct ProcessedSnapshot {
    std::uint64_t number = 0;
    std::uint64_t samples = 0;
    Crop crop{};
    Image film;        // planes until `made`, then in the form of the film's file
    Image demosaiced;  // planes for displays if the sensor has a mosaic
    bool made = false;
    std::map<std::pair<std::string, double>, std::shared_ptr<const std::string>> pictures = {};
  };

  [[nodiscard]] std::shared_ptr<ProcessedSnapshot> latest() const;
  void make_film(ProcessedSnapshot& snapshot) const;
  [[nodiscard]] const DisplayTransform& transform(const std::string& view);

  const Scene& scene_;
  ViewOptions options_;
  bool displayable_ = true;
  std::vector<std::string> views_;
  std::atomic<double> spent_s_{0};
  std::mutex work_;  // guards the contents of snapshots and `transforms_`
  std::map<std::string, DisplayTransform> transforms_;
  mutable std::mutex swap_;  // guards the pointer only, so that the render never waits for a picture
  std::shared_ptr<ProcessedSnapshot> latest_ = std::make_shared<ProcessedSnapshot>();
};

}  // namespace abbe
