#include "validation/report/matrix.h"

#include <algorithm>

#include <fmt/format.h>

#include "validation/plot/svg.h"

namespace abbe {
namespace {

// From 1.
std::size_t number_of(const TechniqueMatrix& matrix, const PathClass& lost) {
  const auto found = std::find(matrix.unreached.begin(), matrix.unreached.end(), lost);
  return static_cast<std::size_t>(found - matrix.unreached.begin()) + 1;
}

template <typename Visit>
void for_each_failure(const TechniqueMatrix& matrix, Visit visit) {
  for (const TechniqueMatrix::Row& row : matrix.rows)
    for (const Outcome* cell : row.cells)
      if (cell != nullptr && !cell->result.passed()) visit(*cell);
}

}  // namespace

TechniqueMatrix technique_matrix(const std::vector<Outcome>& outcomes) {
  TechniqueMatrix matrix;
  for (const Outcome& outcome : outcomes) {
    const auto* cell = std::get_if<TechniqueMean>(&outcome.item->method);
    if (cell == nullptr) continue;
    if (matrix.rows.empty() || matrix.rows.back().film != cell->of)
      matrix.rows.push_back({cell->of, std::vector<const Outcome*>(kIntegratorNames.size())});
    matrix.rows.back().cells.at(static_cast<std::size_t>(cell->by)) = &outcome;
    for (const PathClass& lost : outcome.result.unreached)
      if (number_of(matrix, lost) > matrix.unreached.size()) matrix.unreached.push_back(lost);
  }
  return matrix;
}

std::string cell_text(const TechniqueMatrix& matrix, const Outcome* cell) {
  if (cell == nullptr) return "–";
  std::string numbers;
  for (const PathClass& lost : cell->result.unreached)
    numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", number_of(matrix, lost));
  if (!numbers.empty()) return "lost " + numbers;
  const std::string verdict = cell->result.passed() ? "" : verdict_name(cell->result.verdict) + " ";
  if (cell->result.figures.empty()) return verdict + "no figures";
  const Figure& figure = cell->result.figures.front();
  return fmt::format("{}{:+.2f}", verdict, 100 * figure.deviation() / figure.reference);
}

std::string failure_text(const Outcome& cell) {
  const CaseResult& result = cell.result;
  std::string owned;
  for (const std::string& paths : result.owned) owned += (owned.empty() ? "" : "; ") + paths;
  const std::string deviation =
      result.figures.empty()
          ? "no figures"
          : fmt::format("{:+.3f} ± {:.3f} % of ± {:g} %",
                        100 * result.figures.front().deviation() / result.figures.front().reference,
                        100 * kInterval * result.figures.front().measured.standard_error /
                            result.figures.front().reference,
                        100 * result.margin.value);
  return fmt::format("{} {}: {}, of the paths {}", verdict_name(result.verdict), cell.item->id, deviation,
                     owned);
}

std::string matrix_text(const TechniqueMatrix& matrix) {
  if (matrix.rows.empty()) return "";
  std::string all = "| film |";
  std::string rule = "\n| --- |";
  for (const char* name : kIntegratorNames) {
    all += fmt::format(" {} |", name);
    rule += " --- |";
  }
  all += rule + "\n";
  for (const TechniqueMatrix::Row& row : matrix.rows) {
    all += fmt::format("| {} |", row.film);
    for (const Outcome* cell : row.cells) all += fmt::format(" {} |", cell_text(matrix, cell));
    all += "\n";
  }
  if (!matrix.unreached.empty()) all += "\n";
  for (std::size_t i = 0; i < matrix.unreached.size(); ++i)
    all += fmt::format("{}. `{}\n", i + 1,
                       std::string(matrix.unreached[i]).replace(matrix.unreached[i].find(':'), 1, "`:"));
  for_each_failure(matrix, [&](const Outcome& cell) { all += failure_text(cell) + "\n"; });
  return all;
}

std::string matrix_html(const TechniqueMatrix& matrix) {
  if (matrix.rows.empty()) return "";
  std::string all =
      "<p class=\"soft\">Each film by each technique: its deviation from the closed form in per cent, "
      "“lost” with the number of the note where it does not reach the light, or a dash where nothing ran."
      "</p>\n<table class=\"matrix\"><tr><th>film</th>";
  for (const char* name : kIntegratorNames) all += fmt::format("<th class=\"n\">{}</th>", name);
  all += "</tr>\n";
  for (const TechniqueMatrix::Row& row : matrix.rows) {
    all += fmt::format("<tr><td>{}</td>", escaped(row.film));
    for (const Outcome* cell : row.cells)
      all += fmt::format("<td class=\"n {}\">{}</td>",
                         cell == nullptr || !cell->result.measured() ? "soft"
                         : cell->result.passed()                     ? "pass"
                                                                     : "fail",
                         cell_text(matrix, cell));
    all += "</tr>\n";
  }
  all += "</table>\n<ol class=\"soft\">";
  for (const PathClass& lost : matrix.unreached) all += fmt::format("<li>{}</li>", escaped(lost));
  all += "</ol>\n";
  for_each_failure(matrix, [&](const Outcome& cell) {
    all += fmt::format("<p class=\"failure\">{}</p>\n", escaped(failure_text(cell)));
  });
  return all;
}

}  // namespace abbe
