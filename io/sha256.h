#pragma once

#include <span>
#include <string>
#include <string_view>

namespace abbe {

/// SHA-256 of pieces of bytes, one after another, as `sha256` tells it of one.
[[nodiscard]] std::string sha256_of_pieces(std::span<const std::string_view> pieces);

}  // namespace abbe
