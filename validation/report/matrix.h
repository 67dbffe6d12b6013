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
    std::vector<const Outcome*> cells;  ///< One cell per column; null if the run did not include it.
  };
  std::vector<Row> rows;  ///< Rows in the order of the outcomes.
  /// Path classes that cells cannot sample, each once. Notes number them from 1.
  std::vector<PathClass> unsampled;
};
/// Matrix of the outcomes of `TechniqueMean` cases; others are ignored. Cells of a film must be consecutive.
/// The matrix refers to `outcomes`, which must outlive it.
[[nodiscard]] TechniqueMatrix technique_matrix(const std::vector<Outcome>& outcomes);

/// Text of a cell of `matrix`: the signed deviation in per cent of the reference, such as "+0.31". A cell
/// that does not pass has "FAIL" or "UNDECIDED" before it. A cell that was not measured has "lost" with the
/// numbers of its notes. A null `cell` has a dash.
[[nodiscard]] std::string cell_text(const TechniqueMatrix& matrix, const Outcome* cell);

/// Description of a failed cell in one line: its verdict, its id, its deviation with interval and margin, and
/// the path classes that its techniques sample.
[[nodiscard]] std::string failure_text(const Outcome& cell);

/// The table in Markdown, with notes and failures; empty for a matrix without rows.
[[nodiscard]] std::string matrix_text(const TechniqueMatrix& matrix);

/// The table as an HTML fragment, with notes and failures; empty for a matrix without rows.
[[nodiscard]] std::string matrix_html(const TechniqueMatrix& matrix);

}  // namespace abbe
