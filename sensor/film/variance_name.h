#pragma once

#include <string>

namespace abbe {

/// The name of the channel of a film that holds the variance of the values of another.
[[nodiscard]] inline std::string variance_of(const std::string& channel) {
  return "Variance." + channel;
}

}  // namespace abbe
