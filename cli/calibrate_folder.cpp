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

constexpr std::array kNames{"report.json", "response.csv",       "config.ocio",
                            "dng.json",    "sensitivities.json", "report.html"};
constexpr std::array kCameraEnds{".spi1d", ".cube", ".clf", "_to_aces.clf"};

// Whether a calibration that this was the report of wrote a file of that name.
bool is_of(const std::string& report, const std::string& name) {
  if (std::find(kNames.begin(), kNames.end(), name) != kNames.end()) return true;
  const std::string begin = camera_file({}, "");
  return std::ranges::any_of(kCameraEnds, [&](std::string_view end) {
    if (!name.starts_with(begin) || !name.ends_with(end) || name.size() < begin.size() + end.size())
      return false;
    const std::string light = name.substr(begin.size(), name.size() - begin.size() - end.size());
    return report.find('"' + light + '"') != std::string::npos;
  });
}

}  // namespace

std::vector<fs::path> calibration_files(const fs::path& folder, const std::string& illuminants) {
  std::vector<fs::path> files;
  for (const char* name : kNames) files.push_back(folder / name);
  for (const std::string& illuminant : split(illuminants, ',')) {
    CameraProfile profile;
    profile.light = illuminant;
    for (const char* end : kCameraEnds) files.push_back(folder / camera_file(profile, end));
  }
  return files;
}

std::vector<fs::path> earlier_files(const fs::path& folder) {
  std::error_code failure;
  Diagnostics none;  // without a report that can be read there is no earlier calibration
  const auto report = read_text(folder / kNames[0], none);
  if (!report) return {};
  std::vector<fs::path> earlier;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure))
    if (entry.is_regular_file(failure) && is_of(report->text, entry.path().filename().string()))
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
