#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace abbe::description::zemax {

/// Whether a word of a `.zmx` file changes nothing of what is read of it: notes, polarisation, tolerances,
/// weights, variables, solves whose values stand there, and how Zemax shows and searches.
[[nodiscard]] bool is_idle(std::string_view word);

/// The idle words, for suggestions.
[[nodiscard]] std::vector<std::string> idle_words();

}  // namespace abbe::description::zemax
