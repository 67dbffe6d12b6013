#include "cli/calibrate.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "calibration/chart/measured_patches.h"
#include "calibration/chart/photographed_series.h"
#include "calibration/fit/balance.h"
#include "calibration/output/ocio.h"
#include "calibration/output/sensitivities.h"
#include "cli/bench_plots.h"
#include "cli/calibrate_page.h"
#include "cli/calibrate_report.h"
#include "cli/output_files.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/text.h"
#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

// Every file that may be written.
std::vector<fs::path> output_files(const CalibrateOptions& options) {
  const fs::path& folder = options.output;
  if (folder.empty()) return {};
  std::vector<fs::path> files{folder / "report.json", folder / "response.csv", folder / "config.ocio"};
  for (const std::string& illuminant : split(options.illuminants, ',')) {
    CameraProfile profile;
    profile.light = illuminant;
    for (const char* end : {".spi1d", ".cube", ".clf", "_to_aces.clf"})
      files.push_back(folder / camera_file(profile, end));
  }
  for (const char* name : {"dng.json", "sensitivities.json", "report.html"}) files.push_back(folder / name);
  return files;
}

void require_named_once(const std::string& illuminants) {
  std::set<std::string> seen;
  for (const std::string& illuminant : split(illuminants, ','))
    if (!seen.insert(illuminant).second)
      throw Error(ErrorCode::usage, "--illuminant", fmt::format("{} is named twice", illuminant));
}

// "400-500": the two wavelengths of an ideal filter.
Curve box_filter(const std::string& text) {
  const std::vector<std::string> ends = split(text, '-');
  const auto end = [&](std::size_t i) { return ends.size() == 2 ? parse_number(ends[i]).value_or(-1) : -1; };
  if (!(kMinWavelengthNm <= end(0) && end(0) < end(1) && end(1) <= kMaxWavelengthNm))
    throw Error(ErrorCode::usage, "--camera",
                fmt::format("expected bands low-high in nm within [{}, {}] (got {})", kMinWavelengthNm,
                            kMaxWavelengthNm, text));
  return band(end(0), end(1));
}

// "400-500,500-600,600-700": ideal filters from B to R, in the order R, G, B.
std::vector<Channel> box_channels(const std::string& bands) {
  const std::vector<std::string> pieces = split(bands, ',');
  if (pieces.size() != 3)
    throw Error(ErrorCode::usage, "--camera", fmt::format("expected three bands (got {})", pieces.size()));
  return {energy_channel("R", box_filter(pieces[2])), energy_channel("G", box_filter(pieces[1])),
          energy_channel("B", box_filter(pieces[0]))};
}

std::optional<std::vector<Channel>> camera_channels(const std::string& camera, Diagnostics& diagnostics) {
  constexpr std::string_view kBox = "box:";
  if (camera.starts_with(kBox)) return box_channels(camera.substr(kBox.size()));
  if (camera == "observer:1931") return observer_channels(Observer::cie1931);
  if (camera == "observer:1964") return observer_channels(Observer::cie1964);
  return load_camera(camera, {}, diagnostics);
}

// All patches of several tables of reflectances.
Chart load_training(const CalibrateOptions& options, Diagnostics& diagnostics) {
  Chart all{options.training, {}};
  if (options.training.empty()) return all;
  for (const std::string& name : split(options.training, ',')) {
    if (name == options.chart)
      throw Error(
          ErrorCode::usage, "--training",
          fmt::format("got {}, the chart itself, which is shown by a fit that has not seen it", name));
    auto chart = load_chart(name, {}, diagnostics);
    if (chart) std::move(chart->patches.begin(), chart->patches.end(), std::back_inserter(all.patches));
  }
  return all;
}

CalibrationCase simulate(const CalibrateOptions& options, const std::string& illuminant) {
  Diagnostics diagnostics;
  const auto channels = camera_channels(options.camera, diagnostics);
  const auto light = load_illuminant(illuminant, {}, diagnostics);
  const auto chart = load_chart(options.chart, {}, diagnostics);
  const auto test = options.test.empty() ? Chart{} : load_chart(options.test, {}, diagnostics);
  const Chart training = load_training(options, diagnostics);
  check(diagnostics);
  CalibrationCase made{options.camera, options.chart, options.planted_response, options.bits, {}, {}};
  made.result = calibrate_camera({options.camera, illuminant, options.planted_response, options.bits,
                                  *channels, light->curve, *chart, training},
                                 options.how);
  if (!options.test.empty())
    made.test = patch_errors(integrate(*test, *channels, light->curve), made.result.correction.correction);
  return made;
}

struct RecoveredResponses {
  std::vector<ChannelResponse> channels;
  std::optional<double> full_scale_dn;  // of which they are, where the series tells
};

RecoveredResponses recover(const CalibrateOptions& options) {
  Diagnostics diagnostics;
  Inputs inputs(options.max_memory_bytes);
  const auto photographs = accepted(read_series(options.series, diagnostics, &inputs), diagnostics);
  require_distinct(output_files(options), inputs.files());
  RecoveredResponses recovered{{}, photographs.full_scale_dn};
  for (std::size_t k = 0; k < photographs.channels.size(); ++k)
    recovered.channels.push_back({photographs.channels[k], recover_response(photographs.series[k]), {}});
  return recovered;
}

// Code values to linear ones.
void linearise_all(MeasuredPatches& patches, const std::vector<ChannelResponse>& responses) {
  if (responses.size() != 3)
    throw Error(ErrorCode::input, "--series",
                fmt::format("expected three channels (got {})", responses.size()));
  for (Raw& value : patches.values)
    for (std::size_t k = 0; k < 3; ++k) value[k] = linearise(responses[k].fit.linear, value[k]);
}

CalibrationCase measure(const CalibrateOptions& options, const std::string& illuminant) {
  Diagnostics diagnostics;
  const auto light = load_illuminant(illuminant, {}, diagnostics);
  const auto chart = light ? load_chart_targets(options.chart, light->curve, {}, diagnostics) : std::nullopt;
  auto patches = load_measured_patches(options.measured, diagnostics);
  const Chart training = load_training(options, diagnostics);
  std::optional<std::vector<Channel>> channels;
  if (!training.patches.empty()) channels = camera_channels(options.camera, diagnostics);
  check(diagnostics);
  MeasuredCamera camera{options.measured.stem().string(), illuminant, {}, {}, {}};
  if (!options.series.empty()) {
    RecoveredResponses recovered = recover(options);
    camera.responses = std::move(recovered.channels);
    scale_to_codes(*patches, recovered.full_scale_dn, options.measured);
    linearise_all(*patches, camera.responses);
  }
  const BalancedPatches balanced = balance(*chart, *patches);
  camera.colors = balanced.colors;
  camera.gains = balanced.gains;
  camera.deviations = balanced.deviations;
  if (channels) camera.training = integrate(training, *channels, light->curve);
  return {camera.name, options.chart, "", 0, calibrate_measured(camera, options.how), {}};
}

int calibrate_response(const CalibrateOptions& options) {
  const std::vector<ChannelResponse> responses = recover(options).channels;
  Json report{{"series", options.series.string()}, {"responses", Json::array()}};
  for (const ChannelResponse& r : responses) report["responses"].push_back(json_of(r));
  if (!options.output.empty()) {
    make_folder(options.output);
    write_atomically(options.output / "response.csv", csv_of(responses, options.series.string()));
    write_atomically(options.output / "report.json", text(report, true));
  }
  if (options.json)
    print(report, true);
  else
    fmt::print("{}", table_of(responses));
  return 0;
}

int calibrate_all(const CalibrateOptions& options) {
  Diagnostics diagnostics;
  const auto light = load_illuminant(options.illuminants, {}, diagnostics);
  const auto chart = load_chart(options.chart, {}, diagnostics);
  check(diagnostics);
  const std::vector<CameraQuality> all = all_camera_qualities(*chart, light->curve);
  if (options.json)
    fmt::print("{}", text(json_of(all), true));
  else
    fmt::print("{}", table_of(all));
  return 0;
}

BenchAnswers read_bench(const CalibrateOptions& options) {
  Inputs inputs(options.max_memory_bytes);
  BenchAnswers bench;
  if (!options.transfer.empty()) bench.transfer = read_answer(options.transfer, transfer_plot, inputs);
  if (!options.mtf.empty()) bench.mtf = read_answer(options.mtf, mtf_plot, inputs);
  return bench;
}

void write_all(const CalibrateOptions& options, const std::vector<CalibrationCase>& cases,
               const BenchAnswers& bench, Json& report) {
  std::vector<CameraProfile> profiles;
  for (const CalibrationCase& one : cases) profiles.push_back(one.result.profile);
  const WrittenConfig written = write_ocio_config(options.output, profiles);
  if (std::any_of(profiles.begin(), profiles.end(), [](const CameraProfile& profile) {
        return profile.correction.model != CorrectionModel::linear;
      }))
    report["bake_dE00_max"] = written.bake_error;
  if (const Json dng = dng_json(cases); !dng.is_null()) {
    write_atomically(options.output / "dng.json", text(dng, true));
    report["dng"] = dng;
  }
  std::vector<Channel> channels;
  if (!options.camera.empty()) {
    Diagnostics diagnostics;
    channels = accepted(camera_channels(options.camera, diagnostics), diagnostics);
    write_atomically(options.output / "sensitivities.json", sensitivities_json(options.camera, channels));
  }
  write_atomically(options.output / "report.html", page_of(cases, channels, bench));
  write_atomically(options.output / "report.json", text(report, true));
}

}  // namespace

int calibrate(const CalibrateOptions& options) {
  const bool is_real = !options.measured.empty() || !options.series.empty();
  // The training set of a photographed chart is seen through the camera's curves.
  const bool has_curves = !options.measured.empty() && !options.training.empty();
  if (has_curves && options.camera.empty())
    throw Error(ErrorCode::usage, "--training", "needs --camera: the curves that it is seen through");
  if (int{options.all_cameras} + int{!options.camera.empty() && !has_curves} + int{is_real} != 1)
    throw Error(ErrorCode::usage, "calibrate",
                "needs one of --camera, --all-cameras, or --measured, --series or both; --camera with "
                "--measured only "
                "for --training");
  if ((is_real || options.all_cameras) && options.illuminants.find(',') != std::string::npos)
    throw Error(ErrorCode::usage, "--illuminant",
                fmt::format("got {}, allowed one light, or several with --camera", options.illuminants));
  require_named_once(options.illuminants);
  std::vector<fs::path> inputs =
      files_among({options.camera, options.chart, options.test, options.measured.string()});
  for (const std::string& illuminant : split(options.illuminants, ','))
    for (fs::path& file : files_among({illuminant})) inputs.push_back(std::move(file));
  for (const fs::path& file : {options.transfer, options.mtf}) {
    if (file.empty()) continue;
    if (options.output.empty())
      throw Error(ErrorCode::usage, file.string(), "is for the page, which is written with --output alone");
    inputs.push_back(file);
  }
  require_distinct(output_files(options), inputs);
  const BenchAnswers bench = read_bench(options);
  if (options.all_cameras) return calibrate_all(options);
  if (is_real && options.measured.empty()) return calibrate_response(options);
  std::vector<CalibrationCase> cases;
  for (const std::string& illuminant : split(options.illuminants, ','))
    cases.push_back(is_real ? measure(options, illuminant) : simulate(options, illuminant));
  Json report{{"calibrations", Json::array()}};
  for (const CalibrationCase& one : cases) report["calibrations"].push_back(json_of(one));
  if (!options.output.empty()) write_all(options, cases, bench, report);
  if (options.json)
    print(one_or_all(report["calibrations"]), true);
  else
    for (const CalibrationCase& one : cases) fmt::print("{}", table_of(one));
  return 0;
}

}  // namespace abbe::cli
