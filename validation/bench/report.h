#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "validation/bench/baseline.h"
#include "validation/bench/machine.h"
#include "validation/bench/rivals.h"
#include "validation/plot/log_plot.h"

namespace abbe {

/// Everything a benchmark found.
struct BenchReport {
  Machine machine;
  BenchSettings settings;
  std::vector<SuiteRun> runs;
  std::vector<Rival> rivals;    ///< To stand beside; empty when the films are not those they rendered.
  std::vector<Change> changes;  ///< Against the baseline, if there is one.
};

/// One line per render, the first names the columns.
[[nodiscard]] std::string csv_text(std::span<const SuiteRun> runs);

/// One JSON object, every digit kept.
[[nodiscard]] std::string json_text(const BenchReport& report);

/// The report for reading: per suite the means over seeds, what equal error costs by each of several
/// integrators, the times at the rivals' errors, and then the changes.
[[nodiscard]] std::string readable_text(const BenchReport& report);

/// relRMSE against CPU time of one suite by each integrator, with its rivals.
[[nodiscard]] LogPlot error_plot(const SuiteRun& run, std::span<const Rival> rivals);

/// The files of a report on those suites.
[[nodiscard]] std::vector<std::filesystem::path> report_files(const std::filesystem::path& folder,
                                                              std::span<const BenchSuite> suites);

/// Makes the folder of a report if need be. Throws Error{output} now if nothing can be written there later.
void require_report_folder(const std::filesystem::path& folder);

/// Writes `bench.csv`, `bench.json` and `<suite>.svg` to a folder that is there. Throws Error{output}.
void write_report(const std::filesystem::path& folder, const BenchReport& report);

}  // namespace abbe
