#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "report/plot.h"
#include "validation/bench/baseline.h"
#include "validation/bench/machine.h"
#include "validation/bench/other_renderers.h"

namespace abbe {

struct BenchReport {
  Machine machine;
  BenchSettings settings;
  std::vector<SuiteRun> runs;
  /// Results of other renderers; empty for reduced films, which they did not render.
  std::vector<OtherRendererResult> other_renderers;
  std::vector<Change> changes;  ///< Empty without a baseline.
};

/// CSV with one line per render; the first line names the columns.
[[nodiscard]] std::string csv_text(std::span<const SuiteRun> runs);

/// One JSON object in one line with all digits of every number, as `load_baseline` reads it.
[[nodiscard]] std::string json_text(const BenchReport& report);

[[nodiscard]] std::string readable_text(const BenchReport& report);

/// Plot of relRMSE against CPU time [s] with a curve per integrator and per other renderer. Errors with
/// `kLowFloor` have dashed curves of their own, if another renderer has such a result for the suite.
[[nodiscard]] LogPlot error_plot(const SuiteRun& run, std::span<const OtherRendererResult> other_renderers);

/// Paths of the files that `write_report` would write for these suites: `bench.csv`, `bench.json`, then one
/// `<suite>.svg` per suite.
[[nodiscard]] std::vector<std::filesystem::path> report_files(const std::filesystem::path& folder,
                                                              std::span<const BenchSuite> suites);

/// Creates the folder of a report if it does not exist. Throws Error{output} if `bench.json` cannot be
/// written there.
void require_report_folder(const std::filesystem::path& folder);

/// Writes `report_files` to an existing folder, replacing files of these names. Throws Error{output} if one
/// cannot be written.
void write_report(const std::filesystem::path& folder, const BenchReport& report);

}  // namespace abbe
