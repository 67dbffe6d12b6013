#include <algorithm>
#include <array>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/arguments.h"
#include "cli/command_options.h"
#include "cli/output_files.h"
#include "io/atomic_file.h"
#include "io/text.h"
#include "validation/bench/report.h"
#include "validation/bench/scale.h"
#include "validation/bench/soak/soak.h"
#include "validation/report/report.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

struct BenchOptions : BenchSettings {
  std::vector<std::string> suites;
  fs::path output;
  fs::path baseline;
  bool strict = false;
  bool list = false;
  bool scale = false;
  std::uint64_t soak_paths = 0;
  std::uint64_t soak_seed = 0;
  bool json = false;
};

struct ValidateOptions {
  std::vector<Suite> suites;
  bool quick = false;
  fs::path output;
  int threads = 0;
  bool json = false;
};

fs::path default_cache() {
  const char* home = std::getenv("HOME");
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0')
    return fs::path(cache) / "abbe" / "bench";
  if (home == nullptr)
    throw Error(ErrorCode::usage, "--cache", "is required if neither XDG_CACHE_HOME nor HOME is set");
  return fs::path(home) / ".cache" / "abbe" / "bench";
}

BenchSettings settings_of(const BenchOptions& options) {
  BenchSettings settings = options;
  if (settings.cache.empty()) settings.cache = default_cache();
  settings.version = ABBE_VERSION;
  settings.say = print_message;
  return settings;
}

int list_suites(bool as_json) {
  Json answer;
  for (const BenchSuite& suite : bench_suites()) answer[suite.name] = suite.description;
  for (const BenchSuite& suite : bright_rooms()) answer[suite.name] = suite.description;
  print(answer, as_json);
  return 0;
}

int scale(const BenchOptions& options) {
  const fs::path folder = settings_of(options).cache / "scale";
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const std::vector<ScaleRow> rows = measure_scale(folder, options.threads, options.quick);
  Json answer = Json::array();
  for (const ScaleRow& row : rows)
    answer.push_back({{"subject", row.subject},
                      {"count", row.count},
                      {"load_cpu_s", row.load_cpu_s},
                      {"build_cpu_s", row.build_cpu_s},
                      {"plan_cpu_s", row.plan_cpu_s},
                      {"bytes_per_count", row.bytes},
                      {"rays_per_cpu_s", row.rays_per_cpu_s}});
  fmt::print("{}", options.json ? text(answer, true) : readable_text(rows));
  return 0;
}

// Runs the soak test. Its failures are written to the output folder, or to the cache.
int soak(const BenchOptions& options) {
  if (!options.output.empty() && !options.cache.empty())
    throw Error(ErrorCode::usage, "--cache",
                "has no effect on --soak with --output, which names the folder (allowed without --output)");
  const fs::path folder = options.output.empty() ? settings_of(options).cache / "soak" : options.output;
  require_report_folder(folder);
  const SoakResult result = run_soak({options.soak_paths, options.soak_seed, folder, print_message});
  const Json answer{{"scenes", result.scenes},
                    {"paths", result.paths},
                    {"rays", result.rays},
                    {"failures", result.failures},
                    {"seed", options.soak_seed}};
  print(answer, options.json);
  return result.failures > 0 ? 1 : 0;
}

Baseline read_baseline(const fs::path& path) {
  if (path.empty()) return {};
  Diagnostics diagnostics;
  return accepted(load_baseline(path, diagnostics), diagnostics);
}

// Loads the scenes of the suites once more, so that a suite that cannot be compared is reported before any
// render.
void require_comparable_suites(const Baseline& before, const std::vector<BenchSuite>& suites,
                               const BenchSettings& settings) {
  Diagnostics diagnostics;
  for (const BaselineSuite& recorded : before.suites)
    for (const BenchSuite& suite : suites)
      if (suite.name == recorded.name)
        require_comparable(recorded, conditions_of(suite, settings), diagnostics);
  check(diagnostics);
}

// Values in ascending order without duplicates.
template <typename T>
std::vector<T> sorted_unique(std::vector<T> values) {
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

// True if CPU time or error rose significantly.
bool is_regression(const Change& change) {
  const auto regressed = [](const Ratio& ratio) { return ratio.changed() && ratio.value > 1; };
  return regressed(change.cpu_per_path) || regressed(change.rel_mse);
}

void require_folder(const fs::path& folder) {
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const std::array files{folder / "report.html", folder / "report.json"};
  for (const fs::path& file : files) require_writable(file);
  require_distinct(files, {});
}

std::vector<int> parse_sample_counts(const std::string& option, const std::string& text) {
  constexpr int kMaxSampleCount = 1 << 20;
  std::vector<int> counts;
  for (const std::string& piece : split(text, ','))
    counts.push_back(static_cast<int>(parse_integer(option, piece, 1, kMaxSampleCount)));
  return sorted_unique(std::move(counts));
}

std::vector<Integrator> parse_integrators(const std::string& option, const std::string& text) {
  std::vector<Integrator> integrators;
  for (const std::string& piece : split(text, ','))
    integrators.push_back(static_cast<Integrator>(
        parse_choice(option, piece, {kIntegratorNames.begin(), kIntegratorNames.end()})));
  return sorted_unique(std::move(integrators));
}

int bench(const BenchOptions& options) {
  if (options.list) return list_suites(options.json);
  if (options.scale) return scale(options);
  if (options.soak_paths > 0) return soak(options);
  const std::vector<BenchSuite> suites = choose_suites(options.suites);
  if (!options.output.empty()) {
    require_report_folder(options.output);
    require_distinct(report_files(options.output, suites), std::array{options.baseline});
  }
  const Baseline before = read_baseline(options.baseline);
  BenchReport report{this_machine(), settings_of(options), {}, {}, {}};
  require_comparable_suites(before, suites, report.settings);
  if (!options.quick) report.other_renderers = load_other_renderers();
  for (const BenchSuite& suite : suites) report.runs.push_back(run_suite(suite, report.settings));
  report.changes = compare_runs(before.rows, baseline_rows(report.runs));
  if (!options.baseline.empty() && report.changes.empty())
    print_message(
        "warning: nothing is compared: no render of the baseline has the same suite, integrator, sample "
        "count and seed");
  if (!options.output.empty()) write_report(options.output, report);
  fmt::print("{}", options.json ? json_text(report) : readable_text(report));
  const bool regressed = std::ranges::any_of(report.changes, is_regression);
  return options.strict && regressed ? 1 : 0;
}

std::vector<Suite> parse_suites(const std::string& option, const std::string& text) {
  const std::vector<std::string> names(kSuiteNames.begin(), kSuiteNames.end());
  std::vector<Suite> suites;
  for (const std::string& piece : split(text, ',')) {
    const auto name = std::ranges::find(names, piece);
    if (name == names.end()) throw Error(ErrorCode::usage, option, unknown_name("suite", piece, names));
    suites.push_back(static_cast<Suite>(name - names.begin()));
  }
  return suites;
}

int validate(const ValidateOptions& options) {
  const bool written = !options.output.empty();
  if (written) require_folder(options.output);
  const ValidationReport report =
      abbe::validate({options.suites, options.quick, options.threads, ABBE_VERSION, print_message});
  if (written) {
    write_atomically(options.output / "report.html", html_text(report));
    write_atomically(options.output / "report.json", json_text(report));
  }
  fmt::print("{}", options.json ? json_text(report) : readable_text(report));
  return report.failures() > 0 ? 1 : 0;
}

// Excludes options that have no effect on --list, --scale and --soak, the other modes of `bench`.
void exclude_from_other_modes(CLI::App& bench) {
  const auto option = [&bench](const std::string& name) { return bench.get_option(name); };
  for (const char* name : {"suite", "--integrator", "--spp", "--seeds", "--reference-spp", "--baseline"})
    option(name)->excludes("--list")->excludes("--scale")->excludes("--soak");
  for (const char* name : {"--threads", "--quick"}) option(name)->excludes("--list")->excludes("--soak");
  option("--output")->excludes("--list")->excludes("--scale");
  option("--cache")->excludes("--list");
  option("--scale")->excludes("--list")->excludes("--soak");
  option("--soak")->excludes("--list");
  option("--strict")->needs("--baseline");
  option("--seed")->needs("--soak");
}

}  // namespace

void add_bench(CLI::App& app, Command& command) {
  const Subcommand<BenchOptions> sub(
      app, "bench", "Measure run time and error of the integrators on benchmark scenes", command, bench);
  CLI::App& options = *sub.app;
  add_value(options, "suite", sub->suites, "Suites to measure, as --list prints them (default: all)",
            "SUITE");
  add_value(options, "-o,--output", sub->output, "Folder for the tables and plots of the report", "FOLDER");
  add_parsed(options, "--integrator", sub->integrators, parse_integrators,
             "Integrators to measure; several render each suite alternately and are compared (default auto)",
             "NAME[,NAME...]");
  add_parsed(options, "--spp", sub->samples, parse_sample_counts, "Samples per pixel (default 4,8,16,32,64)",
             "N[,N...]");
  add_parsed(
      options, "--seeds", sub->seeds, integer_in<int>(1, 1000),
      "Renders with different seeds per suite, integrator and number of samples, 1 to 1000 (default 3)", "N");
  add_parsed(options, "--threads", sub->threads, integer_in<int>(0, kMaxThreads),
             "Number of threads; 0 for one per processor (default 0)", "N");
  add_parsed(options, "--reference-spp", sub->reference_samples, integer_in<int>(2, kMaxSamples),
             "Samples per pixel of the reference renders (default: 64 times the largest of --spp)", "N");
  add_value(options, "--baseline", sub->baseline, "File bench.json of an earlier run to compare with",
            "FILE.json");
  add_value(options, "--cache", sub->cache,
            "Folder for references and generated meshes (default: $XDG_CACHE_HOME/abbe/bench, "
            "otherwise ~/.cache/abbe/bench)",
            "FOLDER");
  options.add_flag("--quick", sub->quick, "Use small films, without the comparison with other renderers");
  options.add_flag("--strict", sub->strict,
                   "Exit with 1 if run time or error became worse than in the baseline");
  options.add_flag("--scale", sub->scale,
                   "Measure the run time and memory of scenes of growing size instead");
  add_parsed(options, "--soak", sub->soak_paths, integer_in<std::uint64_t>(1, kMaxSeed),
             "Search random scenes for faults instead, until this number of paths has been traced", "N");
  add_parsed(options, "--seed", sub->soak_seed, integer_in<std::uint64_t>(0, kMaxSeed),
             "Seed of the first scene of --soak; each further scene uses the next number (default 0)", "N");
  options.add_flag("--list", sub->list, "List the suites");
  exclude_from_other_modes(options);
  add_json(options, sub->json);
}

void add_validate(CLI::App& app, Command& command) {
  const Subcommand<ValidateOptions> sub(
      app, "validate", "Recompute all cases with known answers and report their errors", command, validate);
  CLI::App& options = *sub.app;
  options.add_flag("--quick", sub->quick,
                   "Use wider tolerances for films, which takes less than two minutes");
  add_parsed(options, "--suite", sub->suites, parse_suites,
             fmt::format("Suites to run: {} (default: all)", fmt::join(kSuiteNames, ", ")),
             "SUITE[,SUITE...]");
  add_value(options, "-o,--output", sub->output, "Folder for report.html and report.json", "FOLDER");
  add_parsed(options, "--threads", sub->threads, integer_in<int>(0, kMaxThreads),
             "Number of threads; 0 for one per processor (default 0)", "N");
  add_json(options, sub->json);
}

}  // namespace abbe::cli
