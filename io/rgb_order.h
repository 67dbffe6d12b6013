#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>

namespace abbe {

/// Where R, G and B stand among these names, in that order, which pictures and tables have; nothing unless
/// the names are these three.
[[nodiscard]] inline std::optional<std::array<std::size_t, 3>> rgb_order(std::span<const std::string> names) {
  constexpr std::array kRgb{"R", "G", "B"};
  if (!std::is_permutation(names.begin(), names.end(), kRgb.begin(), kRgb.end())) return std::nullopt;
  std::array<std::size_t, 3> order{};
  for (std::size_t k = 0; k < 3; ++k)
    order[k] = static_cast<std::size_t>(std::find(names.begin(), names.end(), kRgb[k]) - names.begin());
  return order;
}

}  // namespace abbe
