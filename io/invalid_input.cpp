#include "io/invalid_input.h"

#include <algorithm>

namespace abbe {

void require_sound(const Diagnostics& diagnostics) {
  if (!diagnostics.has_errors()) return;
  std::string all = diagnostics.text();
  if (all.ends_with('\n')) all.pop_back();
  const auto first =
      std::find_if(diagnostics.all().begin(), diagnostics.all().end(),
                   [](const Diagnostic& d) { return d.severity == Diagnostic::Severity::error; });
  const bool placed = first->where.source != nullptr;
  const ErrorCode code =
      !placed && diagnostics.code() == ErrorCode::scene ? ErrorCode::input : diagnostics.code();
  // Complaints with a place each begin their own line, as editors look for them.
  throw InvalidInput(code, placed ? "invalid input\n" + all : all,
                     {diagnostics.all().begin(), diagnostics.all().end()});
}

}  // namespace abbe
