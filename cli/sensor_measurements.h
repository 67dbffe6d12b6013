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
  std::vector<std::filesystem::path> dark;  ///< Raw files; consecutive files form pairs of equal exposure.
  std::vector<std::filesystem::path> flat;
  std::filesystem::path plot{};  ///< SVG of the photon-transfer curves; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};
/// Prints gain, noise and dynamic range per channel from pairs of flat and dark frames. Returns the exit
/// code.
int transfer(const TransferOptions& options);

/// Options of `abbe mtf`.
struct MtfOptions {
  std::filesystem::path image;
  std::optional<Crop> crop{};  ///< Pixels around the edge; the whole film without a crop.
  std::string channel{};       ///< Channel to evaluate; empty for G, Y or the first.
  std::filesystem::path plot{};
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};
/// Prints the modulation transfer function of a slanted edge. Returns the exit code.
int mtf(const MtfOptions& options);

}  // namespace abbe::cli
