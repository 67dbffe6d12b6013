#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/inputs.h"
#include "sensor/film/crop.h"

namespace abbe::cli {

/// Options of `abbe transfer`.
struct TransferOptions {
  /// Raw files without light; consecutive files form pairs of equal exposure.
  std::vector<std::filesystem::path> dark;
  std::vector<std::filesystem::path> flat;  ///< Raw files in uniform light, also in pairs.
  std::filesystem::path plot{};             ///< SVG of the photon-transfer curves; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};
/// Prints gain, noise and dynamic range per channel from pairs of flat and dark frames. Returns 0. Throws as
/// `measure_transfer`, Error{usage} for a plot other than .svg, Error{output} if it cannot be written.
int transfer(const TransferOptions& options);

/// Options of `abbe mtf`.
struct MtfOptions {
  std::filesystem::path image;   ///< Film or linear picture with a slanted edge.
  std::optional<Crop> crop{};    ///< Pixels around the edge; the whole film without a crop.
  std::string channel{};         ///< Channel to evaluate; empty for G, Y or the first.
  std::filesystem::path plot{};  ///< SVG of the function; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};
/// Prints the modulation transfer function of a slanted edge. Returns 0. Throws Error{usage} for an unknown
/// channel, for a crop outside the recorded pixels and for a plot other than .svg. Throws Error{input} for a
/// mosaic and as `slanted_edge`, Error{output} if the plot cannot be written.
int mtf(const MtfOptions& options);

}  // namespace abbe::cli
