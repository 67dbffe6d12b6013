#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "spectral/matrix3.h"
#include "transport/path/film_response.h"

namespace abbe {

/// A value that a pilot photon adds to the film.
struct Splat {
  std::size_t source;  ///< Index of the photon, or of the group to which it belongs.
  std::size_t cell;    ///< Index in `RelativeErrorCells`.
  double value;
};

/// Cells of a film inside which errors are relative to the same mean: every plane of every block of pixels.
/// The planes of an observer are those of linear sRGB.
class RelativeErrorCells {
 public:
  explicit RelativeErrorCells(const Scene& scene);

  [[nodiscard]] std::size_t count() const;
  /// Adds to `splats` what the film values at a film point contribute to their cells.
  void add(std::size_t source, const FilmPoint& at, std::span<const double> values,
           std::vector<Splat>& splats) const;

 private:
  const Camera& camera_;
  std::size_t planes_;
  int across_;
  int down_;
  std::optional<Matrix3> from_xyz_;  // to linear sRGB
};

/// Contribution of each of `count` sources to relMSE: the sum of its squared splats, each divided by the
/// squared mean of the cell plus `kUsualFloor` times the squared mean of the film.
[[nodiscard]] std::vector<double> relative_squares(std::span<const Splat> splats,
                                                   const RelativeErrorCells& cells, std::size_t count);

}  // namespace abbe
