#pragma once

#include <string>

#include "cli/answer.h"
#include "validation/lens/figures.h"

namespace abbe::cli {

/// All figures of a lens, for scripts.
[[nodiscard]] Json lens_answer(const LensFigures& figures);

/// The figures of a lens for reading: of the whole lens, by wavelength, by surface, by field, and of the
/// brightest ghosts.
struct LensTables {
  Json whole;
  Json wavelengths;
  Json surfaces;
  Json fields;
  Json ghosts;
};
[[nodiscard]] LensTables lens_tables(const LensFigures& figures);

/// One HTML page of tables, drawing and plots that needs nothing else.
[[nodiscard]] std::string lens_page(const LensFigures& figures);

}  // namespace abbe::cli
