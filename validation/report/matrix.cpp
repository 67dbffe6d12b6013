#include "validation/report/matrix.h"

#include <algorithm>

#include <fmt/format.h>

#include "report/svg.h"

namespace abbe {
namespace {

// Number of a note, counted from 1.
std::size_t number_of(const TechniqueMatrix& matrix, const PathClass& path_class) {
  const auto found = std::find(matrix.unsampled.begin(), matrix.unsampled.end(), path_class);
  return static_cast<std::size_t>(found - matrix.unsampled.begin()) + 1;
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
    if (matrix.rows.empty() || matrix.rows.back().film != cell->case_id)
      matrix.rows.push_back({cell->case_id, std::vector<const Outcome*>(kIntegratorNames.size())});
    matrix.rows.back().cells.at(static_cast<std::size_t>(cell->integrator)) = &outcome;
    for (const PathClass& path_class : outcome.result.unsampled)
      if (number_of(matrix, path_class) > matrix.unsampled.size()) matrix.unsampled.push_back(path_class);
  }
  return matrix;
}

std::string cell_text(const TechniqueMatrix& matrix, const Outcome* cell) {
  if (cell == nullptr) return "–";
  std::string numbers;
  for (const PathClass& path_class : cell->result.unsampled)
    numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", number_of(matrix, path_class));
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
  if (!matrix.unsampled.empty()) all += "\n";
  for (std::size_t i = 0; i < matrix.unsampled.size(); ++i)
    all += fmt::format("{}. `{}\n", i + 1,
                       std::string(matrix.unsampled[i]).replace(matrix.unsampled[i].find(':'), 1, "`:"));
  for_each_failure(matrix, [&](const Outcome& cell) { all += failure_text(cell) + "\n"; });
  return all;
}

std::string matrix_html(const TechniqueMatrix& matrix) {
  if (matrix.rows.empty()) return "";
  std::string all =
      "<p class=\"soft\">Each film by each integrator: the deviation from the closed form in per cent, "
      "“lost” with the number of the note if the integrator cannot sample the light, or a dash if nothing "
      "ran."
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
  for (const PathClass& path_class : matrix.unsampled) all += fmt::format("<li>{}</li>", escaped(path_class));
  all += "</ol>\n";
  for_each_failure(matrix, [&](const Outcome& cell) {
    all += fmt::format("<p class=\"failure\">{}</p>\n", escaped(failure_text(cell)));
  });
  return all;
}

}  // namespace abbe
