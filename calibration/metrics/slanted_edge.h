#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace abbe {

/// Edge response of a picture: angle, edge spread function and modulation transfer function.
struct EdgeResponse {
  double angle_deg;    ///< Angle of the edge to the columns of pixels, or to the rows if it is horizontal.
  bool is_horizontal;  ///< True if the edge lies along the rows.
  std::vector<double> edge;  ///< Mean values by distance from the edge, every quarter of a pixel.
  std::vector<double> mtf;   ///< Modulation at the frequencies `frequency(i)`, 1 at 0.
  /// Frequency of half the modulation [cycles/pixel]; empty if there is none.
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
/// Throws Error{input} for a picture that
/// - is smaller than 16 x 16 or has a value that is not finite;
/// - has no edge, or one along the pixels (less than 1 degree) or near the diagonal (more than 40 degrees);
/// - shows more than one edge, such as a chart or a line: its values must depend on the distance from one
///   edge, but for a tenth of their variance, and differ between its sides.
[[nodiscard]] EdgeResponse slanted_edge(std::span<const double> values, int width, int height);

}  // namespace abbe
