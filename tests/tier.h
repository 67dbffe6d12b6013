#pragma once

#include <cstdlib>

namespace abbe::test {

/// Whether the tests of the night run, which have the time to do more.
[[nodiscard]] inline bool nightly() {
  static const bool kSaid = std::getenv("ABBE_NIGHTLY") != nullptr;
  return kSaid;
}

}  // namespace abbe::test
