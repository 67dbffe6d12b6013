#pragma once

#include <span>
#include <string>
#include <string_view>

namespace abbe {

/// SHA-256 of the concatenated pieces, as 64 lower-case hexadecimal digits. Throws Error{internal} if OpenSSL
/// does not provide it.
[[nodiscard]] std::string sha256_of_pieces(std::span<const std::string_view> pieces);

}  // namespace abbe
