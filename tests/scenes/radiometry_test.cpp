// Every case that renders.
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/text.h"
#include "tests/source_tree.h"
#include "tests/tier.h"
#include "tests/validation/cases_run.h"
#include "validation/report/report.h"

namespace abbe {
namespace {

class RenderedCase : public testing::TestWithParam<Case> {};

// The numbers of a Markdown table by their column, row by row.
std::map<std::string, std::vector<double>> columns_of(std::istream& text, const std::string& first_cell) {
  std::map<std::string, std::vector<double>> columns;
  std::vector<std::string> names;
  for (std::string line; std::getline(text, line);) {
    const std::vector<std::string> cells = split(line, '|');
    if (names.empty() && line.starts_with("| " + first_cell + " |")) names = cells;
    if (names.empty()) continue;
    if (!line.starts_with('|')) break;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (const auto number = parse_number(cells[i])) columns[names.at(i)].push_back(*number);
  }
  return columns;
}

// README's table is what the run prints. Builds for other processors may round the last digit otherwise.
void expect_column_of_readme(const RenderedChart& chart, const CaseResult& result) {
  std::ifstream readme(test::source_tree() / "README.md");
  const auto columns = columns_of(readme, "ΔE2000");
  const auto column = columns.find(chart.illuminant);
  ASSERT_NE(column, columns.end()) << chart.illuminant;
  ASSERT_EQ(column->second.size(), 2U) << chart.illuminant;
  constexpr double kHalfOfLastDigit = 0.0005 + 1e-4;
  constexpr const char* kHow = ": replace README's table by that of `abbe validate --quick --suite colour`";
  const ChartSummary summary = chart_summary(result);
  EXPECT_NEAR(column->second[0], summary.mean, kHalfOfLastDigit) << "mean of " << chart.illuminant << kHow;
  EXPECT_NEAR(column->second[1], summary.worst, kHalfOfLastDigit) << "worst of " << chart.illuminant << kHow;
}

TEST_P(RenderedCase, AgreesWithItsReference) {
  CaseResult result{};
  test::expect_passes(GetParam(), {.thorough = test::nightly()}, result);
  if (const auto* chart = std::get_if<RenderedChart>(&GetParam().method))
    expect_column_of_readme(*chart, result);
}

// Those that take long, and of each kind another one by day.
const std::set<std::string> kByNight{"T1-0.95",
                                     "T8",
                                     "T10-lower",
                                     "T14-3",
                                     "T16-outside",
                                     "ball-meter",
                                     "layer-1",
                                     "chart-A",
                                     "chart-D50",
                                     "chart-FL2",
                                     "chart-FL11",
                                     "chart-LED-B1",
                                     "T3-x",
                                     "T12-FL11",
                                     "flat-bessell_B-5000",
                                     "flat-bessell_R-5000",
                                     "flat-bessell_I-5000",
                                     "flat-bessell_V-2856",
                                     "flat-bessell_R-2856",
                                     "flat-bessell_I-2856",
                                     "flat-bessell_B-6500",
                                     "flat-bessell_V-6500"};

std::vector<Case> cases(bool by_night) {
  std::vector<Case> chosen = test::cases_by<FilmMean, RenderedChart>();
  std::erase_if(chosen, [&](const Case& item) { return kByNight.contains(item.id) != by_night; });
  return chosen;
}

INSTANTIATE_TEST_SUITE_P(Cases, RenderedCase, testing::ValuesIn(cases(false)), test::case_name);
INSTANTIATE_TEST_SUITE_P(Nightly, RenderedCase, testing::ValuesIn(cases(true)), test::case_name);

}  // namespace
}  // namespace abbe
