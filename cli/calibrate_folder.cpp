#include "cli/calibrate_folder.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "calibration/output/ocio.h"
#include "io/error.h"
#include "io/text.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::array kReportFiles{"report.json", "response.csv",       "config.ocio",
                                  "dng.json",    "sensitivities.json", "report.html"};
constexpr std::array kCameraSuffixes{".spi1d", ".cube", ".clf", "_to_aces.clf"};

// True if the calibration with this report can have written a file of this name.
bool is_calibration_file(const std::string& report, const std::string& name) {
  if (std::find(kReportFiles.begin(), kReportFiles.end(), name) != kReportFiles.end()) return true;
  const std::string begin = camera_file({}, "");
  return std::ranges::any_of(kCameraSuffixes, [&](std::string_view end) {
    if (!name.starts_with(begin) || !name.ends_with(end) || name.size() < begin.size() + end.size())
      return false;
    const std::string illuminant = name.substr(begin.size(), name.size() - begin.size() - end.size());
    return report.find('"' + illuminant + '"') != std::string::npos;
  });
}

}  // namespace

std::vector<fs::path> calibration_files(const fs::path& folder, const std::string& illuminants) {
  std::vector<fs::path> files;
  for (const char* name : kReportFiles) files.push_back(folder / name);
  for (const std::string& illuminant : split(illuminants, ',')) {
    CameraProfile profile;
    profile.light = illuminant;
    for (const char* end : kCameraSuffixes) files.push_back(folder / camera_file(profile, end));
  }
  return files;
}

std::vector<fs::path> earlier_files(const fs::path& folder) {
  std::error_code failure;
  Diagnostics none;  // an unreadable report means no earlier calibration
  const auto report = read_text(folder / kReportFiles[0], none);
  if (!report) return {};
  std::vector<fs::path> earlier;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure))
    if (entry.is_regular_file(failure) && is_calibration_file(report->text, entry.path().filename().string()))
      earlier.push_back(folder / entry.path().filename());
  return earlier;
}

void remove_unless_written(std::span<const fs::path> earlier, std::span<const fs::path> written) {
  for (const fs::path& file : earlier) {
    std::error_code failure;
    if (std::find(written.begin(), written.end(), file) == written.end()) fs::remove(file, failure);
    if (failure)
      throw Error(ErrorCode::output, file.string(),
                  "cannot remove a file of an earlier calibration: " + failure.message());
  }
}

}  // namespace abbe::cli
