#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "description/load.h"
#include "io/inputs.h"

namespace abbe::cli {

/// What `abbe develop` was asked for.
struct DevelopOptions {
  std::filesystem::path film;
  std::vector<std::filesystem::path> outputs;  ///< Raw pictures and multi-part images.
  std::filesystem::path display;               ///< Empty when no picture is wanted.
  std::filesystem::path scene;                 ///< Whose sensor looks at a spectral film; else empty.
  std::vector<Override> overrides;             ///< Of the read-out and the white.
  std::optional<std::uint64_t> seed;           ///< Of the noise; that of the render when absent.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// A film to digital numbers, files and pictures without rendering; prints what the sensor's noise and the
/// render's own error are. Returns the exit code.
int develop(const DevelopOptions& options);

}  // namespace abbe::cli
