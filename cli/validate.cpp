#include "cli/validate.h"

#include <algorithm>
#include <array>
#include <system_error>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/output_files.h"
#include "io/atomic_file.h"
#include "io/text.h"
#include "validation/report/report.h"

namespace abbe::cli {
namespace {

void require_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  const std::array files{folder / "report.html", folder / "report.json"};
  for (const std::filesystem::path& file : files) require_writable(file);
  require_distinct(files, {});
}

}  // namespace

std::vector<Suite> parse_suites(const std::string& option, const std::string& text) {
  const std::vector<std::string> names(kSuiteNames.begin(), kSuiteNames.end());
  std::vector<Suite> suites;
  for (const std::string& piece : split(text, ',')) {
    const auto name = std::find(names.begin(), names.end(), piece);
    if (name == names.end()) throw Error(ErrorCode::usage, option, unknown_name("suite", piece, names));
    suites.push_back(static_cast<Suite>(name - names.begin()));
  }
  return suites;
}

int validate(const ValidateOptions& options) {
  const bool written = !options.output.empty();
  if (written) require_folder(options.output);
  const ValidationReport report =
      abbe::validate({options.suites, options.quick, written && options.suites.empty(), options.threads,
                      ABBE_VERSION, print_message});
  if (written) {
    write_atomically(options.output / "report.html", html_text(report));
    write_atomically(options.output / "report.json", json_text(report));
  }
  fmt::print("{}", options.json ? json_text(report) : readable_text(report));
  return report.failures() > 0 ? 1 : 0;
}

}  // namespace abbe::cli
