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
#include "preview/snapshot.h"
#include "scene/scene.h"

namespace abbe {

/// The film that viewers look at: the latest snapshot, and what they have asked of it so far, each made once.
/// Any thread may call all of it.
class ViewerFilm {
 public:
  /// Of a scene that outlives it, as the options' display shows it.
  ViewerFilm(const Scene& scene, ViewOptions options);

  /// What `picture` can show: views of the display; of a sensor that no display shows, its channels.
  [[nodiscard]] const std::vector<std::string>& views() const { return views_; }

  void replace(Snapshot snapshot);
  /// Snapshots so far, and the samples per pixel of the latest.
  [[nodiscard]] std::uint64_t number() const;
  [[nodiscard]] std::uint64_t samples() const;

  /// The snapshot as a PNG, through one of the views, so many stops brighter than the scene asks for or than
  /// is chosen for it; nothing before the first snapshot and for a view there is not.
  [[nodiscard]] std::shared_ptr<const std::string> picture(const std::string& view, double stops);

  /// What the film's file would hold of a pixel after so many samples.
  struct Pixel {
    struct Value {
      std::string channel;
      float value;
      std::optional<double> wavelength_nm;  ///< Of the middle of a spectrum's band.
    };
    std::uint64_t samples;
    std::vector<Value> values;
  };
  /// Nothing before the first snapshot and for a pixel that is not rendered.
  [[nodiscard]] std::optional<Pixel> pixel(int x, int y);

  /// Time spent on what was asked [s], since the last call.
  [[nodiscard]] double take_time_spent() { return spent_s_.exchange(0); }

 private:
  /// A snapshot, and what has been made of it.
  struct Shown {
    std::uint64_t number = 0;
    std::uint64_t samples = 0;
    Crop crop{};
    Image film;        // planes until `made`, then as the film's file holds it
    Image demosaiced;  // what displays are given of a mosaic's
    bool made = false;
    std::map<std::pair<std::string, double>, std::shared_ptr<const std::string>> pictures = {};
  };

  [[nodiscard]] std::shared_ptr<Shown> latest() const;
  void make_film(Shown& shown) const;
  [[nodiscard]] const DisplayTransform& transform(const std::string& view);

  const Scene& scene_;
  ViewOptions options_;
  bool displayable_ = true;
  std::vector<std::string> views_;
  std::atomic<double> spent_s_{0};
  std::mutex work_;  // of what is made of snapshots, and by what
  std::map<std::string, DisplayTransform> transforms_;
  mutable std::mutex swap_;  // of the pointer alone: a render waits for no picture
  std::shared_ptr<Shown> latest_ = std::make_shared<Shown>();
};

}  // namespace abbe
