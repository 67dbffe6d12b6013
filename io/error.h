#pragma once

#include <stdexcept>
#include <string>

namespace abbe {

/// Classes of failure. The values are exit codes of the program.
enum class ErrorCode : int {
  usage = 2,      ///< The command line cannot be understood.
  scene = 3,      ///< The scene file is invalid.
  input = 4,      ///< An input file is missing or corrupt.
  output = 5,     ///< An output cannot be written.
  resource = 6,   ///< A limit on memory or size would be exceeded.
  internal = 70,  ///< A bug in Abbe.
};

/// An unrecoverable failure. Thrown anywhere, caught only in `cli/main`.
struct Error : std::runtime_error {
  /// `where` names the file, option or device concerned; `message` says what is wrong.
  Error(ErrorCode code, const std::string& where, const std::string& message)
      : std::runtime_error(where.empty() ? message : where + ": " + message), code(code) {}

  ErrorCode code;
};

}  // namespace abbe
