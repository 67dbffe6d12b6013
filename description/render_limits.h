#pragma once

#include <cstdint>

namespace abbe {

// Largest values that scene files, the command line and Python accept for a render.

/// Samples per pixel: a float counts integers exactly up to here.
inline constexpr std::int64_t kMaxSamples = 1 << 24;
/// Seed of the random numbers: JSON numbers hold integers exactly up to here.
inline constexpr std::int64_t kMaxSeed = (std::int64_t{1} << 53) - 1;
inline constexpr std::int64_t kMaxThreads = 1024;                   ///< Threads of a render.
inline constexpr std::int64_t kMaxPhotons = std::int64_t{1} << 31;  ///< Photons per sample.

}  // namespace abbe
