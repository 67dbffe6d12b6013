#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/diagnostics.h"

namespace abbe {

/// What ends a command whose inputs are no use: everything that is wrong with them.
struct InvalidInput : Error {
  InvalidInput(ErrorCode code, const std::string& message, std::vector<Diagnostic> all)
      : Error(code, "", message), diagnostics(std::move(all)) {}

  std::vector<Diagnostic> diagnostics;  ///< Warnings too, in the order in which they were found.
};

/// Throws the diagnostics as one when there are errors among them. A name given by a caller, in no file, that
/// is not found counts as a missing input.
void require_sound(const Diagnostics& diagnostics);

}  // namespace abbe
