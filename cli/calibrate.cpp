#include "cli/calibrate.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "calibration/output/camera_profile.h"
#include "calibration/output/ocio.h"
#include "cli/calibrate_report.h"
#include "cli/output_files.h"
#include "io/atomic_file.h"
#include "io/diagnostics.h"
#include "io/error.h"
#include "io/text.h"
#include "spectral/library.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::array kReportFiles{"report.json", "response.csv",       "config.ocio",
                                  "dng.json",    "sensitivities.json", "report.html"};
constexpr std::array kCameraSuffixes{".spi1d", ".cube", ".clf", "_to_aces.clf"};

// True if the calibration with this report can have written a file of this name.
bool is_calibration_file(const std::string& report, const std::string& name) {
  if (std::ranges::find(kReportFiles, name) != kReportFiles.end()) return true;
  const std::string begin = camera_file({}, "");
  return std::ranges::any_of(kCameraSuffixes, [&](std::string_view end) {
    if (!name.starts_with(begin) || !name.ends_with(end) || name.size() < begin.size() + end.size())
      return false;
    const std::string illuminant = name.substr(begin.size(), name.size() - begin.size() - end.size());
    return report.find('"' + illuminant + '"') != std::string::npos;
  });
}

// Files in the folder that an earlier `abbe calibrate` wrote, as `folder` / name. They have the name of one
// of its outputs; names with an illuminant count only if its `report.json` contains that illuminant. Empty
// if that report cannot be read. Call it before the report is replaced.
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

// Deletes the `earlier` files that are not among the `written` ones, since they may belong to another
// camera. Paths are compared as text, so both lists must begin with the same folder. Throws Error{output} if
// a file cannot be deleted.
void remove_unless_written(std::span<const fs::path> earlier, std::span<const fs::path> written) {
  for (const fs::path& file : earlier) {
    std::error_code failure;
    if (std::ranges::find(written, file) == written.end()) fs::remove(file, failure);
    if (failure)
      throw Error(ErrorCode::output, file.string(),
                  "cannot remove a file of an earlier calibration: " + failure.message());
  }
}

// All files that `abbe calibrate` may write. It writes only some of them, and they need not exist.
std::vector<fs::path> output_files(const CalibrateOptions& options) {
  std::vector<fs::path> files;
  if (options.output.empty()) return files;
  for (const char* name : kReportFiles) files.push_back(options.output / name);
  for (const std::string& illuminant : split(options.illuminants, ',')) {
    CameraProfile profile;
    profile.light = illuminant;
    for (const char* end : kCameraSuffixes) files.push_back(options.output / camera_file(profile, end));
  }
  return files;
}

// Rejects illuminants that are named twice. Written files compare the names without case, as OpenColorIO does
// for colour spaces: one illuminant would replace the other.
void require_named_once(const std::string& illuminants, bool are_written) {
  std::map<std::string, std::string> by_key;
  for (const std::string& illuminant : split(illuminants, ',')) {
    const auto [earlier, is_new] =
        by_key.emplace(are_written ? lower_case(illuminant) : illuminant, illuminant);
    if (is_new) continue;
    if (earlier->second == illuminant)
      throw Error(ErrorCode::usage, "--illuminant", fmt::format("{} is named twice", illuminant));
    throw Error(
        ErrorCode::usage, "--illuminant",
        fmt::format("{} differs from {} only in case, which OpenColorIO ignores in names: rename one of them",
                    illuminant, earlier->second));
  }
}

// Recovers the response of a series without measured values, and writes its curves.
void calibrate_response(const CalibrateOptions& options) {
  Inputs inputs(options.max_memory_bytes);
  Diagnostics diagnostics;
  const std::vector<ChannelResponse> responses =
      recover_responses(options.series, inputs, diagnostics).channels;
  check(diagnostics);
  require_distinct(output_files(options), inputs.files());
  Json report{{"series", options.series.string()}, {"responses", Json::array()}};
  for (const ChannelResponse& r : responses) report["responses"].push_back(json_of(r));
  if (!options.output.empty()) {
    make_folder(options.output);
    const std::vector<fs::path> earlier = earlier_files(options.output);
    const std::vector<fs::path> written{options.output / "response.csv", options.output / "report.json"};
    write_atomically(written[0], csv_of(responses, options.series.string()));
    write_atomically(written[1], text(report, true));
    remove_unless_written(earlier, written);
  }
  fmt::print("{}", options.json ? text(report, true) : table_of(responses));
}

// Prints the quality of every shipped camera.
void calibrate_all(const CalibrateOptions& options) {
  Diagnostics diagnostics;
  const auto light = load_illuminant(options.illuminants, {}, diagnostics);
  const auto chart = load_chart(options.chart, {}, diagnostics);
  check(diagnostics);
  const std::vector<CameraQuality> all = all_camera_qualities(*chart, light->curve);
  fmt::print("{}", options.json ? text(json_of(all), true) : table_of(all));
}

MeasurementAnswers read_measurements(const CalibrateOptions& options) {
  Inputs inputs(options.max_memory_bytes);
  MeasurementAnswers measurements;
  if (!options.transfer.empty()) measurements.transfer = read_answer(options.transfer, transfer_plot, inputs);
  if (!options.mtf.empty()) measurements.mtf = read_answer(options.mtf, mtf_plot, inputs);
  return measurements;
}

// Writes configuration, matrices, sensitivities, page and report, and deletes what an earlier calibration
// left.
void write_calibrations(const CalibrateOptions& options, const std::vector<CalibrationCase>& cases,
                        const MeasurementAnswers& measurements, Json& report) {
  std::vector<CameraProfile> profiles;
  for (const CalibrationCase& one : cases) profiles.push_back(one.result.profile);
  const std::vector<fs::path> earlier = earlier_files(options.output);
  WrittenConfig written = write_ocio_config(options.output, profiles);
  const auto write = [&](const char* name, const std::string& content) {
    written.files.push_back(options.output / name);
    write_atomically(written.files.back(), content);
  };
  if (std::ranges::any_of(profiles, [](const CameraProfile& profile) {
        return profile.correction.model != CorrectionModel::linear;
      }))
    report["bake_dE00_max"] = written.bake_error;
  if (const Json dng = dng_json(cases); !dng.is_null()) {
    write("dng.json", text(dng, true));
    report["dng"] = dng;
  }
  std::vector<Channel> channels;
  if (!options.camera.empty()) {
    Diagnostics repeated;  // its warnings were printed with the calibrations
    auto camera = camera_channels(options.camera, options.camera_response, repeated);
    require_no_errors(repeated);
    channels = *std::move(camera);
    write("sensitivities.json", sensitivities_json(options.camera, channels));
  }
  write("report.html", page_of(cases, channels, measurements));
  write("report.json", text(report, true));
  remove_unless_written(earlier, written.files);
}

}  // namespace

void calibrate(const CalibrateOptions& options) {
  const bool is_real = !options.measured.empty() || !options.series.empty();
  // The raw values of the training reflectances are computed with the spectral responses of the photographed
  // camera.
  const bool has_curves = !options.measured.empty() && !options.training.empty();
  if (has_curves && options.camera.empty())
    throw Error(ErrorCode::usage, "--training",
                "needs --camera, whose spectral responses give the raw values of the training reflectances");
  if (int{options.all_cameras} + int{!options.camera.empty() && !has_curves} + int{is_real} != 1)
    throw Error(ErrorCode::usage, "calibrate",
                "needs either --camera, or --all-cameras, or --measured, --series or both (--camera with "
                "--measured only for --training)");
  if ((is_real || options.all_cameras) && options.illuminants.find(',') != std::string::npos)
    throw Error(ErrorCode::usage, "--illuminant",
                fmt::format("got {}, allowed one illuminant, or several with --camera", options.illuminants));
  require_named_once(options.illuminants, !options.output.empty());
  std::vector<fs::path> inputs = files_among({options.camera, options.chart, options.test,
                                              options.measured.string(), options.test_measured.string()});
  for (const std::string& illuminant : split(options.illuminants, ','))
    for (fs::path& file : files_among({illuminant})) inputs.push_back(std::move(file));
  for (const fs::path& file : {options.transfer, options.mtf}) {
    if (file.empty()) continue;
    if (options.output.empty())
      throw Error(ErrorCode::usage, file.string(),
                  "is used only on the page of the report, which needs --output");
    inputs.push_back(file);
  }
  require_distinct(output_files(options), inputs);
  const MeasurementAnswers measurements = read_measurements(options);
  if (options.all_cameras) return calibrate_all(options);
  if (is_real && options.measured.empty()) return calibrate_response(options);
  Inputs photographs(options.max_memory_bytes);
  std::vector<CalibrationCase> cases;
  for (const std::string& illuminant : split(options.illuminants, ',')) {
    Diagnostics diagnostics;
    cases.push_back(is_real ? measured_calibration(options, illuminant, photographs, diagnostics)
                            : simulated_calibration(options, illuminant, diagnostics));
    check(diagnostics);
  }
  require_distinct(output_files(options), photographs.files());
  Json report{{"calibrations", Json::array()}};
  for (const CalibrationCase& one : cases) report["calibrations"].push_back(json_of(one));
  if (!options.output.empty()) write_calibrations(options, cases, measurements, report);
  if (options.json)
    print(one_or_all(report["calibrations"]), true);
  else
    for (const CalibrationCase& one : cases) fmt::print("{}", table_of(one));
}

}  // namespace abbe::cli
