#include "cli/calibrate_folder.h"

#include <algorithm>
#include <array>
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

bool is_named_by_us(const std::string& name) {
  const auto ends = [&name](const char* end) { return name.ends_with(end); };
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end() ||
         (name.starts_with(camera_file({}, "")) && std::any_of(kCameraEnds.begin(), kCameraEnds.end(), ends));
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

void remove_earlier_files(const fs::path& folder, std::span<const fs::path> written) {
  std::error_code failure;
  std::vector<fs::path> earlier;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure))
    if (entry.is_regular_file() && is_named_by_us(entry.path().filename().string()) &&
        std::find(written.begin(), written.end(), folder / entry.path().filename()) == written.end())
      earlier.push_back(entry.path());
  for (const fs::path& file : earlier)
    if (!failure) fs::remove(file, failure);
  if (failure)
    throw Error(ErrorCode::output, folder.string(),
                "cannot remove files of an earlier calibration: " + failure.message());
}

}  // namespace abbe::cli
