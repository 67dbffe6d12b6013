#pragma once

#include <functional>
#include <string>
#include <vector>

#include "transport/render/cost.h"
#include "validation/bench/machine.h"
#include "validation/cases/case.h"

namespace abbe {

struct Outcome {
  const Case* item;  ///< Element of `all_cases`.
  CaseResult result;
};

/// All results of a validation.
struct ValidationReport {
  Machine machine;
  std::string version;
  std::string data_sha256;
  bool quick;
  std::vector<Outcome> outcomes;  ///< In the order of `all_cases`.
  Cost cost;                      ///< Of the whole run, including loading scenes.

  /// Number of outcomes that do not pass; inconclusive ones are included.
  [[nodiscard]] std::size_t failures() const;
  /// Number of outcomes whose integrator cannot sample the film's light. They pass and are no failures.
  [[nodiscard]] std::size_t unsampled() const;
};

/// Settings of a validation.
struct ValidationSettings {
  /// Suites to run. If empty, all run, a quick run only with the cells of `techniques` in `Tier::quick`.
  std::vector<Suite> suites;
  /// Judge films by the wider margins of the tests, with accordingly fewer samples. Otherwise the fine
  /// margins apply (`CaseSettings::thorough`).
  bool quick = false;
  int threads = 0;  ///< 0 for one per processor.
  std::string version;
  std::function<void(const std::string&)> say;  ///< Called with the name of each case before it runs, if set.
};

/// Runs the cases of the selected suites in the order of `all_cases`. Throws the errors of `all_cases`,
/// `run_case` and `data_sha256`.
[[nodiscard]] ValidationReport validate(const ValidationSettings& settings);

/// Report in plain text. The last line counts the cases that pass.
[[nodiscard]] std::string readable_text(const ValidationReport& report);

/// One JSON object in one line with all digits.
[[nodiscard]] std::string json_text(const ValidationReport& report);

/// Self-contained HTML document with the figures, plots and pictures of the run.
[[nodiscard]] std::string html_text(const ValidationReport& report);

[[nodiscard]] std::string suite_name(Suite suite);
/// Name of a verdict: "pass", "FAIL", or "UNDECIDED" for `inconclusive`.
[[nodiscard]] std::string verdict_name(Verdict verdict);
/// Absolute deviation of a case's worst figure divided by the margin of that figure; 1 is the limit. Infinite
/// without figures, 0 if the integrator cannot sample the film.
[[nodiscard]] double worst_margin_ratio(const CaseResult& result);

/// Signed deviation and margin of a figure, such as "0.016" and "0.15 ΔE".
struct DeviationText {
  std::string deviation;
  std::string margin;
};
/// Texts for one of the figures of `outcome`. For a relative margin the unit is per cent of the reference, or
/// a fraction of it if the margin is below 1e-4. For an absolute margin it is the unit of the case.
[[nodiscard]] DeviationText deviation_text(const Outcome& outcome, const Figure& figure);

/// Colour differences ΔE2000 of a rendered chart.
struct ChartSummary {
  double mean;   ///< Mean over the patches.
  double worst;  ///< Largest value of a patch.
};
[[nodiscard]] ChartSummary chart_summary(const CaseResult& result);
/// Table of all rendered charts in Markdown, as README.md contains it; empty without charts.
[[nodiscard]] std::string chart_table(const std::vector<Outcome>& outcomes);

/// HTML table of `TechniqueMean` cases with notes and failures; empty without such outcomes.
[[nodiscard]] std::string technique_table_html(const std::vector<Outcome>& outcomes);

}  // namespace abbe
