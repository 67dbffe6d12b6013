#pragma once

#include <string>

namespace abbe::cli {

/// Text of `abbe --version`, one fact per line: the version, the tables in use and their hash, the compiler,
/// and the libraries. Throws Error{input} if there are no tables.
[[nodiscard]] std::string version_text();

}  // namespace abbe::cli
