#pragma once

#include <string>

#include "cli/answer.h"
#include "validation/lens/figures.h"

namespace abbe::cli {

/// All figures of a lens as JSON.
[[nodiscard]] Json lens_answer(const LensFigures& figures);

/// Figures of a lens as tables in plain text: of the whole lens, by wavelength, by surface, by field, and of
/// the brightest ghosts.
struct LensTables {
  Json whole;
  Json wavelengths;
  Json surfaces;
  Json fields;
  Json ghosts;
};
[[nodiscard]] LensTables lens_tables(const LensFigures& figures);

/// Self-contained HTML page with tables, drawing and plots.
[[nodiscard]] std::string lens_page(const LensFigures& figures);

}  // namespace abbe::cli
