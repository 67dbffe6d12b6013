#pragma once

#include <cstdlib>

namespace abbe::test {

/// Whether the tests of the night run, which have the time to do more.
[[nodiscard]] inline bool nightly() {
  static const bool kSaid = std::getenv("ABBE_NIGHTLY") != nullptr;
  return kSaid;
}

/// What is enough by day, as at night only with more time.
template <typename T>
[[nodiscard]] T by_night(T at_night, T by_day) {
  return nightly() ? at_night : by_day;
}

}  // namespace abbe::test
