// docs/reference/integrators.md lists every integrator and has a row of the matrix for every film.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/source_tree.h"
#include "validation/cases/case.h"

namespace abbe {
namespace {

// Number of lines of the page that begin with a text, and the number of cells in the first of them.
struct Rows {
  int count = 0;
  std::ptrdiff_t cells = 0;
};
Rows rows_that_begin(const std::string& beginning) {
  std::ifstream page(test::source_tree() / "docs" / "reference" / "integrators.md");
  Rows rows;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with(beginning)) continue;
    if (rows.count++ == 0) rows.cells = std::count(line.begin(), line.end(), '|') - 1;
  }
  return rows;
}

TEST(TechniquesPage, TellsOfEveryIntegrator) {
  std::string columns = "| film |";
  for (const std::string name : kIntegratorNames) {
    EXPECT_EQ(rows_that_begin("| `" + name + "`").count, 1) << name;
    columns += " " + name + " |";
  }
  EXPECT_EQ(rows_that_begin(columns).count, 1) << columns;
}

TEST(TechniquesPage, HasEveryFilmAndAllOfItsCells) {
  int films = 0;
  for (const Case& item : all_cases()) {
    const auto* cell = std::get_if<TechniqueMean>(&item.method);
    if (cell == nullptr || cell->integrator != Integrator::automatic) continue;
    ++films;
    const Rows rows = rows_that_begin("| " + cell->case_id + " |");
    EXPECT_EQ(rows.count, 1) << cell->case_id;
    EXPECT_EQ(rows.cells, static_cast<std::ptrdiff_t>(kIntegratorNames.size()) + 1) << cell->case_id;
  }
  EXPECT_GT(films, 50);
}

TEST(TechniquesPage, ShowsNoCellThatDoesNotPass) {
  std::ifstream page(test::source_tree() / "docs" / "reference" / "integrators.md");
  const std::string text{std::istreambuf_iterator<char>(page), {}};
  for (const char* verdict : {"FAIL", "UNDECIDED"})
    EXPECT_EQ(text.find(verdict), std::string::npos) << verdict;
}

}  // namespace
}  // namespace abbe
