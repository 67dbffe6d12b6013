#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace abbe {

/// 0, 1 or 2 for a name of red, green or blue: "R" or "red", in either case. Nothing for other names.
[[nodiscard]] inline std::optional<std::size_t> rgb_index(std::string_view name) {
  constexpr std::array<std::string_view, 3> kNames{"red", "green", "blue"};
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (std::size_t k = 0; k < kNames.size(); ++k)
    if (lower == kNames[k] || lower == kNames[k].substr(0, 1)) return k;
  return std::nullopt;
}

/// Positions of red, green and blue in `names`, in that order. Nothing unless `names` are exactly one name of
/// each (`rgb_index`).
[[nodiscard]] inline std::optional<std::array<std::size_t, 3>> rgb_order(std::span<const std::string> names) {
  constexpr std::size_t kNone = 3;
  std::array<std::size_t, 3> order{kNone, kNone, kNone};
  if (names.size() != order.size()) return std::nullopt;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const auto k = rgb_index(names[i])) order[*k] = i;
  if (std::find(order.begin(), order.end(), kNone) != order.end()) return std::nullopt;
  return order;
}

}  // namespace abbe
