#pragma once

#include <string>

namespace abbe {

/// Name of the channel of a film with the variance of another channel.
[[nodiscard]] inline std::string variance_of(const std::string& channel) {
  return "Variance." + channel;
}

}  // namespace abbe
