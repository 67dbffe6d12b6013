#pragma once

namespace abbe::test {

/// How many times as much the nightly tests do.
#ifdef ABBE_NIGHTLY
inline constexpr int kEffort = 100;
#else
inline constexpr int kEffort = 1;
#endif

}  // namespace abbe::test
