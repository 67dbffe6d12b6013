#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "spectral/matrix3.h"
#include "transport/path/film_response.h"

namespace abbe {

/// A value that a photon of a pilot adds to the film.
struct Splat {
  std::size_t of;     ///< The photon, or what it stands for.
  std::size_t place;  ///< Of `RelativePlaces`.
  double value;
};

/// The places of a film at which errors are relative to the same mean: each plane, of an observer those of
/// linear sRGB, of each block of pixels.
class RelativePlaces {
 public:
  explicit RelativePlaces(const Scene& scene);

  [[nodiscard]] std::size_t count() const;
  /// Adds what comes there to `splats`.
  void add(std::size_t of, const FilmPoint& at, std::span<const double> values,
           std::vector<Splat>& splats) const;

 private:
  const Camera& camera_;
  std::size_t planes_;
  int across_;
  int down_;
  std::optional<Matrix3> from_xyz_;  // to linear sRGB
};

/// Of so many photons, or what they stand for, the squares of what they add relative to the squared mean
/// around and the usual part (`kUsualFloor`) of that of the film: what their noise counts in relMSE.
[[nodiscard]] std::vector<double> relative_squares(std::span<const Splat> splats,
                                                   const RelativePlaces& places, std::size_t count);

}  // namespace abbe
