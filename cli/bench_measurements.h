#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/inputs.h"
#include "sensor/film/crop.h"

namespace abbe::cli {

/// What `abbe transfer` was asked for.
struct TransferOptions {
  std::vector<std::filesystem::path> dark;  ///< Raw files, two of each exposure one after the other.
  std::vector<std::filesystem::path> lit;
  std::filesystem::path plot{};  ///< SVG of the photon-transfer curves; empty: none.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};
/// Prints gain, noise and range of a sensor from pairs of flat and dark frames, channel by channel. Returns
/// the exit code.
int transfer(const TransferOptions& options);

/// What `abbe mtf` was asked for.
struct MtfOptions {
  std::filesystem::path image;
  std::optional<Crop> crop{};  ///< Pixels around the edge; all the film has without it.
  std::string channel{};       ///< G, Y or the first when empty.
  std::filesystem::path plot{};
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};
/// Prints the modulation transfer function of a slanted edge. Returns the exit code.
int mtf(const MtfOptions& options);

}  // namespace abbe::cli
