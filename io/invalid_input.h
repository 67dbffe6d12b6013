#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/diagnostics.h"

namespace abbe {

/// Thrown if the inputs of a command contain errors. It carries all diagnostics. Its text is
/// `Diagnostics::text`, with or without a first line "invalid input".
struct InvalidInput : Error {
  InvalidInput(ErrorCode code, const std::string& message, std::vector<Diagnostic> all)
      : Error(code, "", message), diagnostics(std::move(all)) {}

  std::vector<Diagnostic> diagnostics;  ///< Errors and warnings, in the order in which they were found.
};

/// Throws InvalidInput with all diagnostics if there is an error among them. Its code is that of the first
/// error. A first error of the code `scene` without a source, such as an unknown name from the command line,
/// becomes `input`.
void require_no_errors(const Diagnostics& diagnostics);

}  // namespace abbe
