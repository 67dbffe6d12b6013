#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/diagnostics.h"

namespace abbe {

/// Thrown if the inputs of a command contain errors. It carries all diagnostics.
struct InvalidInput : Error {
  InvalidInput(ErrorCode code, const std::string& message, std::vector<Diagnostic> all)
      : Error(code, "", message), diagnostics(std::move(all)) {}

  std::vector<Diagnostic> diagnostics;  ///< Errors and warnings, in the order in which they were found.
};

/// Throws InvalidInput with all diagnostics if there is an error among them. An error without a source
/// position, such as an unknown name from the command line, has the code ErrorCode::input.
void require_no_errors(const Diagnostics& diagnostics);

}  // namespace abbe
