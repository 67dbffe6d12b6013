#pragma once

#include <cstdint>

namespace abbe {

/// The most that a render may be asked for, by scene files, the command and Python alike.
inline constexpr std::int64_t kMaxSamples = 1 << 24;  ///< As many as a float counts exactly.
inline constexpr std::int64_t kMaxSeed =
    (std::int64_t{1} << 53) - 1;  ///< The largest that JSON tells from the next.
inline constexpr std::int64_t kMaxThreads = 1024;
inline constexpr std::int64_t kMaxPhotons = std::int64_t{1} << 31;  ///< Of a sample.

}  // namespace abbe
