#pragma once

#include <optional>
#include <span>
#include <vector>

namespace abbe {

/// Edge response of a picture: angle, edge spread function and modulation transfer function. Rows count from
/// the top.
struct EdgeResponse {
  /// Angle of the edge to the columns of pixels, positive if the edge moves right from row to row. A
  /// horizontal edge has the angle to the rows, positive if the edge moves down from column to column.
  double angle_deg;
  bool is_horizontal;  ///< True if the edge lies along the rows rather than the columns.
  /// Mean values in bins of a quarter of a pixel, by signed distance from the edge, in the unit of the
  /// picture. The distance rises to the right, or downwards across a horizontal edge. The edge is between the
  /// two central bins.
  std::vector<double> edge;
  /// Modulation at the frequencies `frequency(i)`, from 0 to about one cycle per pixel; 1 at 0.
  std::vector<double> mtf;
  /// Lowest frequency of half the modulation [cycles/pixel], interpolated linearly; empty if there is none.
  std::optional<double> mtf50;

  /// Frequency of entry i of `mtf`, across the edge [cycles/pixel].
  [[nodiscard]] double frequency(std::size_t i) const {
    return 4.0 * static_cast<double>(i) / static_cast<double>(edge.size());
  }
};

/// Modulation transfer function of a slanted edge, from linear values row by row [ISO12233, annex D].
/// - The edge is located in each row as the centroid of its derivative, and a line is fitted to these
///   positions.
/// - Values are binned by their distance from the line, in quarters of a pixel.
/// - The spectrum of the derivative, under a Hamming window, is divided by the responses of binning and
///   difference.
///
/// Throws Error{input} for a picture
/// - that is smaller than 16 x 16 pixels or has a value that is not finite;
/// - whose edge is along the pixels (less than 1 degree) or near the diagonal (more than 40 degrees);
/// - whose edge comes within about two pixels of its border, or crosses too few columns to fill all bins;
/// - without an edge, or with several: the distance from the edge must explain nine tenths of the variance,
///   and the two sides must differ.
[[nodiscard]] EdgeResponse slanted_edge(std::span<const double> values, int width, int height);

}  // namespace abbe
