#pragma once

#include <string>

#include "cli/answer.h"
#include "report/lens_figures.h"

namespace abbe::cli {

/// All figures of a lens as JSON. Keys name the units; figures that do not exist, such as the focal length of
/// an afocal lens, are null.
[[nodiscard]] Json lens_answer(const LensFigures& figures);

/// Figures of a lens as tables, each an object with a list per column. `whole` has a single value per key.
struct LensTables {
  Json whole;        ///< The whole lens.
  Json wavelengths;  ///< First-order properties by wavelength.
  Json surfaces;     ///< Seidel sums [mm] by surface, counted from 1, and their sum.
  Json fields;       ///< Distortion, spots and modulation by field.
  Json ghosts;       ///< Up to ten ghosts, the brightest first; surfaces are counted from 1.
};
/// Tables of these figures. Numbers are texts of seven digits, except in `whole`, where they are not rounded.
[[nodiscard]] LensTables lens_tables(const LensFigures& figures);

/// Self-contained HTML page with tables, drawing and plots.
[[nodiscard]] std::string lens_page(const LensFigures& figures);

}  // namespace abbe::cli
