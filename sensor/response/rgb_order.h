#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

namespace abbe {

/// Where R, G and B stand among these names, in that order, which pictures and tables have; nothing unless
/// the names are these three.
[[nodiscard]] std::optional<std::array<std::size_t, 3>> rgb_order(std::span<const std::string> names);

}  // namespace abbe
