#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace abbe::description::zemax {

/// True for keywords of a `.zmx` file, in upper case, that do not affect what Abbe reads: notes,
/// polarisation, tolerances, weights, variables, solves with stored values, display and optimisation
/// settings.
[[nodiscard]] bool is_ignored(std::string_view word);

/// All keywords for which `is_ignored` is true, for suggestions in error messages.
[[nodiscard]] std::vector<std::string> ignored_words();

}  // namespace abbe::description::zemax
