#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace abbe {

/// How well a picture keeps detail across an edge.
struct EdgeResponse {
  double angle_deg;    ///< Of the edge from the columns of pixels, or from the rows if it lies along these.
  bool is_horizontal;  ///< Whether it lies along the rows.
  std::vector<double> edge;  ///< Mean values by distance from the edge, every quarter of a pixel.
  std::vector<double> mtf;   ///< Modulation at the frequencies `frequency(i)`, 1 at 0.
  std::optional<double>
      mtf50;  ///< Frequency of half the modulation [cycles a pixel]; nothing where there is none.

  /// In cycles a pixel, across the edge.
  [[nodiscard]] double frequency(std::size_t i) const {
    return 4.0 * static_cast<double>(i) / static_cast<double>(edge.size());
  }
};

/// The modulation transfer function of a slanted edge, from linear values row by row [ISO12233, annex D]: the
/// edge is found in each row as the centroid of its derivative and a line laid through; the values are binned
/// by their distance from it in quarters of a pixel; the spectrum of the derivative, under Hamming's window,
/// is divided by those of the bin and of the difference. Throws Error{input} for a picture smaller than 16 x
/// 16, one with a value that is not finite, one without an edge, whose edge is along the pixels (less than 1
/// degree) or near the diagonal (more than 40), and one whose values do not go by the distance from one edge
/// (but for a tenth of their variance) from one side to the other, such as a chart or a line.
[[nodiscard]] EdgeResponse slanted_edge(std::span<const double> values, int width, int height);

}  // namespace abbe
