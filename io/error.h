#pragma once

#include <stdexcept>
#include <string>

namespace abbe {

/// Classes of failure. The values are exit codes of the program.
enum class ErrorCode : int {
  /// The command line, or an argument of a function, cannot be used.
  usage = 2,
  /// The scene file, or another JSON file of the user, is invalid.
  scene = 3,
  input = 4,      ///< An input file is missing or corrupt.
  output = 5,     ///< An output cannot be written, or an address cannot be used.
  resource = 6,   ///< A limit on memory or size would be exceeded.
  internal = 70,  ///< A bug in Abbe.
};

/// A failure that ends the current operation. The program prints its text and exits with `code`; the Python
/// module raises the exception class of that code.
struct Error : std::runtime_error {
  /// `where` names the file, option or device concerned and precedes the text; it may be empty. `message`
  /// describes what is wrong.
  Error(ErrorCode code, const std::string& where, const std::string& message)
      : std::runtime_error(where.empty() ? message : where + ": " + message), code(code) {}

  ErrorCode code;
};

}  // namespace abbe
