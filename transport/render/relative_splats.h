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
  std::size_t cell;    ///< Index in `RelativeErrorCells`, below its `count()`.
  double value;        ///< Film value, or linear sRGB value for an observer.
};

/// Cells of a film inside which errors are relative to the same mean: every plane of every block of pixels.
/// There are at most 32 x 32 blocks. The planes of an observer are those of linear sRGB.
class RelativeErrorCells {
 public:
  /// Cells for the film of a scene, which must outlive them.
  explicit RelativeErrorCells(const Scene& scene);

  /// Number of cells: blocks times planes.
  [[nodiscard]] std::size_t count() const;
  /// Appends to `splats` what the film values at a film point, one per plane, contribute to their cells.
  /// `source` is `Splat::source` of all. Values of 0 are omitted.
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
/// squared sum of its cell plus `kUsualFloor` times the squared mean of these sums. Sources are below
/// `count`.
[[nodiscard]] std::vector<double> relative_squares(std::span<const Splat> splats,
                                                   const RelativeErrorCells& cells, std::size_t count);

}  // namespace abbe
