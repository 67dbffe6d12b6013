#pragma once

#include <string>

namespace abbe::cli {

/// What `abbe --version` prints, a fact a line: version, the tables in use and their hash, the compiler, and
/// the libraries Abbe was built with. Throws Error{input} when there are no tables.
[[nodiscard]] std::string version_text();

}  // namespace abbe::cli
