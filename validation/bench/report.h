#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "validation/bench/baseline.h"
#include "validation/bench/machine.h"
#include "validation/bench/other_renderers.h"
#include "validation/plot/log_plot.h"

namespace abbe {

/// All results of a benchmark.
struct BenchReport {
  Machine machine;
  BenchSettings settings;
  std::vector<SuiteRun> runs;
  /// Results of other renderers; empty for reduced films, which they did not render.
  std::vector<OtherRendererResult> other_renderers;
  std::vector<Change> changes;  ///< Changes from the baseline, if one was given.
};

/// CSV with one line per render; the first line names the columns.
[[nodiscard]] std::string csv_text(std::span<const SuiteRun> runs);

/// One JSON object with all digits of every number.
[[nodiscard]] std::string json_text(const BenchReport& report);

/// Report in plain text. Each suite lists its means over seeds, the ranking of its integrators and the times
/// at the errors of other renderers. The changes from the baseline follow.
[[nodiscard]] std::string readable_text(const BenchReport& report);

/// Plot of relRMSE against CPU time [s] of one suite, with a curve per integrator and per other renderer.
[[nodiscard]] LogPlot error_plot(const SuiteRun& run, std::span<const OtherRendererResult> other_renderers);

/// Paths of the files that `write_report` would write for these suites.
[[nodiscard]] std::vector<std::filesystem::path> report_files(const std::filesystem::path& folder,
                                                              std::span<const BenchSuite> suites);

/// Creates the folder of a report if it does not exist. Throws Error{output} if no file can be written there.
void require_report_folder(const std::filesystem::path& folder);

/// Writes `bench.csv`, `bench.json` and one `<suite>.svg` per suite to an existing folder. Throws
/// Error{output}.
void write_report(const std::filesystem::path& folder, const BenchReport& report);

}  // namespace abbe
