#include "io/invalid_input.h"

#include <algorithm>

namespace abbe {

void require_no_errors(const Diagnostics& diagnostics) {
  if (!diagnostics.has_errors()) return;
  std::string all = diagnostics.text();
  if (all.ends_with('\n')) all.pop_back();
  const auto first =
      std::find_if(diagnostics.all().begin(), diagnostics.all().end(),
                   [](const Diagnostic& d) { return d.severity == Diagnostic::Severity::error; });
  const bool placed = first->where.source != nullptr;
  const ErrorCode code =
      !placed && diagnostics.code() == ErrorCode::scene ? ErrorCode::input : diagnostics.code();
  // Each diagnostic with a position begins a line, since editors parse it.
  throw InvalidInput(code, placed ? "invalid input\n" + all : all,
                     {diagnostics.all().begin(), diagnostics.all().end()});
}

}  // namespace abbe
