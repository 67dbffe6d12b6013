#pragma once

#include <functional>
#include <string>
#include <vector>

#include "transport/render/cost.h"
#include "validation/bench/machine.h"
#include "validation/cases/case.h"

namespace abbe {

/// A case and its result.
struct Outcome {
  const Case* item;
  CaseResult result;
};

/// A picture for illustration, without a verdict.
struct Specimen {
  std::string caption;
  Image picture;  ///< Display code values.
};

/// All results of a validation.
struct ValidationReport {
  Machine machine;
  std::string version;
  std::string data_sha256;
  bool quick;
  std::vector<Outcome> outcomes;
  std::vector<Specimen> specimens;
  Cost cost;  ///< Cost of the whole run, including loading scenes and rendering specimens.

  [[nodiscard]] std::size_t failures() const;
  /// Number of outcomes whose integrator cannot sample the film's light.
  [[nodiscard]] std::size_t unsampled() const;
};

/// Settings of a validation.
struct ValidationSettings {
  /// Suites to run. If empty, all run, but a quick run includes only a few cells of `techniques`.
  std::vector<Suite> suites;
  bool quick = false;      ///< Render films at the margins of the tests instead of the fine ones.
  bool specimens = false;  ///< Also render some scenes as illustrations.
  int threads = 0;         ///< Number of threads; 0 for one per processor.
  std::string version;
  std::function<void(const std::string&)> say;  ///< Called with the name of each case before it runs, if set.
};

/// Runs the cases of the selected suites in their order. Throws the errors of `run_case`.
[[nodiscard]] ValidationReport validate(const ValidationSettings& settings);

/// Report in plain text: a line per case with its worst figure, then the topics that are not covered.
[[nodiscard]] std::string readable_text(const ValidationReport& report);

/// One JSON object with all figures and all digits.
[[nodiscard]] std::string json_text(const ValidationReport& report);

/// Self-contained HTML document.
[[nodiscard]] std::string html_text(const ValidationReport& report);

/// Name of a suite, such as "optics".
[[nodiscard]] std::string suite_name(Suite suite);
/// "pass", "FAIL" or "UNDECIDED".
[[nodiscard]] std::string verdict_name(Verdict verdict);
/// Largest deviation of a case in units of its margin; infinite without figures, 0 if nothing was measured.
[[nodiscard]] double worst_margin_ratio(const CaseResult& result);

/// Deviation and margin of a figure in the same unit. For a relative margin the unit is per cent or a
/// fraction of the reference. For an absolute margin it is the unit of the figure.
struct DeviationText {
  std::string deviation;  ///< For example "0.31 %", "2.1e-12" or "0.016".
  std::string margin;     ///< For example "1 %", "1e-09 relative" or "0.15 ΔE".
};
[[nodiscard]] DeviationText deviation_text(const Outcome& outcome, const Figure& figure);

/// Colour differences ΔE2000 of a rendered chart.
struct ChartSummary {
  double mean;   ///< Mean over the patches.
  double worst;  ///< Largest value of a patch.
};
/// Summary of a case measured by `RenderedChart`.
[[nodiscard]] ChartSummary chart_summary(const CaseResult& result);
/// Table of all rendered charts in Markdown, as README.md contains it, with a column per illuminant. Empty
/// without charts.
[[nodiscard]] std::string chart_table(const std::vector<Outcome>& outcomes);

}  // namespace abbe
