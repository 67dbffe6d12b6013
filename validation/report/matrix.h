#pragma once

#include <string>
#include <vector>

#include "validation/report/report.h"

namespace abbe {

/// Outcomes of the suite `techniques` as a table, with a row for each film and a column for each of
/// `kIntegratorNames`.
struct TechniqueMatrix {
  struct Row {
    std::string film;                   ///< Id of the film's case.
    std::vector<const Outcome*> cells;  ///< One cell per column; null if nothing was rendered.
  };
  std::vector<Row> rows;
  /// Path classes that cells cannot sample, each once. Notes number them from 1.
  std::vector<PathClass> unsampled;
};
[[nodiscard]] TechniqueMatrix technique_matrix(const std::vector<Outcome>& outcomes);

/// Text of a cell: the deviation in per cent, preceded by "FAIL" or "UNDECIDED" if the cell does not pass. A
/// cell that was not measured has "lost" with the numbers of its notes. A cell that did not run has a dash.
[[nodiscard]] std::string cell_text(const TechniqueMatrix& matrix, const Outcome* cell);

/// Description of a failed cell: its id, its deviation and the path classes that its techniques sample.
[[nodiscard]] std::string failure_text(const Outcome& cell);

/// The table in Markdown, with notes and failures; empty if no cell ran.
[[nodiscard]] std::string matrix_text(const TechniqueMatrix& matrix);

/// The table in HTML, with notes and failures; empty if no cell ran.
[[nodiscard]] std::string matrix_html(const TechniqueMatrix& matrix);

}  // namespace abbe
