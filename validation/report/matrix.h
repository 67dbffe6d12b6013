#pragma once

#include <string>
#include <vector>

#include "validation/report/report.h"

namespace abbe {

/// The outcomes of the suite `techniques` as a table: a row for each film that any cell is of, a column for
/// each of `kIntegratorNames`.
struct TechniqueMatrix {
  struct Row {
    std::string film;                   ///< Its case's id.
    std::vector<const Outcome*> cells;  ///< By column; null where nothing ran.
  };
  std::vector<Row> rows;
  std::vector<PathClass> unreached;  ///< All that cells lose, each once, as notes number them from 1.
};
[[nodiscard]] TechniqueMatrix technique_matrix(const std::vector<Outcome>& outcomes);

/// The deviation in per cent, "FAIL" or "UNDECIDED" before it where it does not pass; "lost" with the numbers
/// of the notes on what is not reached; or a dash for what did not run.
[[nodiscard]] std::string cell_text(const TechniqueMatrix& matrix, const Outcome* cell);

/// What a cell that failed is about: its id, its deviation and the classes of paths that its techniques own.
[[nodiscard]] std::string failure_text(const Outcome& cell);

/// The matrix as a table of Markdown, with its notes and its failures; empty where no cell ran.
[[nodiscard]] std::string matrix_text(const TechniqueMatrix& matrix);

/// The same as a table of HTML.
[[nodiscard]] std::string matrix_html(const TechniqueMatrix& matrix);

}  // namespace abbe
