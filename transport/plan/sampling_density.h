#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace abbe {

/// How many camera paths of a sample go through each pixel, by square blocks of pixels. All samples of a
/// pixel have as many, and each path counts for its share of them, so that the mean over any samples is right
/// whatever the density.
struct SamplingDensity {
  int x0 = 0;                            ///< Where the first block begins: a crop has them within it,
  int y0 = 0;                            ///< and other pixels have 1.
  int edge = 1;                          ///< Of a block, in pixels.
  int across = 0;                        ///< How many blocks there are in a row.
  std::vector<std::uint8_t> paths = {};  ///< Of each block, row by row, at least 1; none for 1 everywhere.

  [[nodiscard]] std::uint32_t at(int x, int y) const {
    if (paths.empty() || x < x0 || y < y0) return 1;
    const int column = (x - x0) / edge;
    const auto block = static_cast<std::size_t>((y - y0) / edge * across + column);
    return column < across && block < paths.size() ? paths[block] : 1U;
  }
};

}  // namespace abbe
