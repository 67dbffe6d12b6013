#pragma once

#include <functional>
#include <string>
#include <vector>

#include "transport/render/cost.h"
#include "validation/bench/machine.h"
#include "validation/cases/case.h"

namespace abbe {

/// A case with what it measured.
struct Outcome {
  const Case* item;
  CaseResult result;
};

/// A picture that shows something and judges nothing.
struct Specimen {
  std::string caption;
  Image picture;  ///< For display.
};

/// Everything a validation found.
struct ValidationReport {
  Machine machine;
  std::string version;
  std::string data_sha256;
  bool quick;
  std::vector<Outcome> outcomes;
  std::vector<Specimen> specimens;
  Cost cost;  ///< Of the whole run, loading and specimens included.

  [[nodiscard]] std::size_t failures() const;
  [[nodiscard]] std::size_t unreached() const;  ///< Outcomes of techniques that lose the film's light.
};

/// What to validate.
struct ValidationSettings {
  std::vector<Suite> suites;  ///< Empty: all, but of the techniques' matrix a quick run takes a few cells.
  bool quick = false;         ///< Films at the margins of the tests instead of the fine ones.
  bool specimens = false;     ///< Also render some scenes for the report.
  int threads = 0;            ///< 0: one per processor.
  std::string version;
  std::function<void(const std::string&)> say;  ///< Told each case before it runs, if set.
};

/// Runs the cases of the suites, in their order. Throws as `run_case`.
[[nodiscard]] ValidationReport validate(const ValidationSettings& settings);

/// The report for reading: a line per case, its figure furthest from the reference, then what is not covered.
[[nodiscard]] std::string readable_text(const ValidationReport& report);

/// One JSON object with every figure, every digit kept.
[[nodiscard]] std::string json_text(const ValidationReport& report);

/// One HTML document that needs nothing else.
[[nodiscard]] std::string html_text(const ValidationReport& report);

/// "optics" and so on.
[[nodiscard]] std::string suite_name(Suite suite);
/// "pass", "FAIL" or "UNDECIDED".
[[nodiscard]] std::string verdict_name(Verdict verdict);
/// How far the worst figure is from its reference, as a share of what is allowed; infinite without figures.
[[nodiscard]] double worst_share(const CaseResult& result);

/// A figure's deviation and its margin in one unit: per cent or a fraction of the reference for a relative
/// margin, the figure's own unit for an absolute one.
struct DeviationText {
  std::string deviation;  ///< "0.31 %", "2.1e-12" or "0.016".
  std::string margin;     ///< "1 %", "1e-09 of it" or "0.15 ΔE".
};
[[nodiscard]] DeviationText deviation_text(const Outcome& outcome, const Figure& figure);

/// Colour differences ΔE2000 of a rendered chart.
struct ChartSummary {
  double mean;   ///< Of its patches.
  double worst;  ///< Of one patch.
};
/// Summary of a case measured by `RenderedChart`.
[[nodiscard]] ChartSummary chart_summary(const CaseResult& result);
/// All rendered charts as the table of README.md in Markdown: a column for each illuminant. Empty without
/// any.
[[nodiscard]] std::string chart_table(const std::vector<Outcome>& outcomes);

}  // namespace abbe
