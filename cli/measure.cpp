#include <algorithm>
#include <array>
#include <limits>
#include <variant>

#include <fmt/format.h>

#include "calibration/chart/measured_patches.h"
#include "cli/answer.h"
#include "cli/command_options.h"
#include "cli/output_files.h"
#include "description/load.h"
#include "develop/find_chart.h"
#include "develop/linear_image.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/text.h"
#include "scene/chart/readout.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

/// Corners of a chart in images without a scene, in the order and the unit of `outlines_between`.
using Corners = std::array<Imath::V2d, 4>;
/// Request to detect the corners in each image.
struct FindCorners {};
using ChartCorners = std::variant<FindCorners, Corners>;

struct MeasureOptions {
  std::vector<fs::path> images;
  std::string chart;
  std::optional<ChartCorners> corners;
  std::size_t columns = 6;
  fs::path flat;
  fs::path output;
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

/// Chart to measure, with its scene if a scene gives its position.
struct ChartToMeasure {
  std::optional<Scene> scene;
  std::vector<PatchOutline> outlines;  ///< Empty if they are detected in each image.
  std::vector<std::string> names;      ///< Names in the table of the chart.
};

ChartToMeasure chart_of_scene(const fs::path& path, Inputs& inputs) {
  Diagnostics diagnostics;
  ChartToMeasure chart{accepted(load_scene(path, {}, diagnostics, &inputs), diagnostics), {}, {}};
  if (chart.scene->charts.empty()) throw Error(ErrorCode::input, path.string(), "the scene has no chart");
  const ChartInstance& instance = chart.scene->charts.front();
  chart.outlines = chart_outlines(*chart.scene, instance);
  for (const PatchOutline& outline : chart.outlines)
    chart.names.push_back(outline.name.substr(instance.name.size() + 1));
  return chart;
}

ChartToMeasure find_chart(const MeasureOptions& options, Inputs& inputs) {
  std::error_code ignored;
  if (!options.corners && !fs::is_regular_file(options.chart, ignored))
    throw Error(
        ErrorCode::usage, "--chart",
        fmt::format("is not a scene file, and a table of patches needs --corners (got {})", options.chart));
  if (!options.corners) return chart_of_scene(options.chart, inputs);
  for (const fs::path& file : files_among({options.chart})) inputs.add_file(file);
  Diagnostics diagnostics;
  ChartToMeasure chart;
  chart.names = accepted(load_chart_targets(options.chart, Curve(1.0), {}, diagnostics), diagnostics).names;
  if (const auto* corners = std::get_if<Corners>(&*options.corners))
    chart.outlines = outlines_between(*corners, chart.names, options.columns);
  else if (chart.names.size() != 24 || options.columns != 6)
    throw Error(
        ErrorCode::usage, "--corners find",
        fmt::format(
            "detects only ColorCheckers of 24 patches, 6 per row (got {} with {} patches, {} per row)",
            options.chart, chart.names.size(), options.columns));
  return chart;
}

/// Patches of one image.
struct Measurement {
  fs::path file;
  std::vector<std::string> channels;
  std::string unit;
  std::vector<PatchValues> patches;
  std::optional<Corners> detected_corners;          ///< Corners of the chart [pixels], if they were detected.
  std::optional<double> saturation;                 ///< Level that the file declares, in `unit`.
  std::vector<std::optional<double>> clipped_at{};  ///< Clipping level per channel, if below `saturation`.
};

// Outlines of the patches in an image. Detected corners are stored in `measured`.
std::vector<PatchOutline> outlines_in(const LinearImage& image, const ChartToMeasure& chart,
                                      const MeasureOptions& options, Measurement& measured) {
  if (chart.scene) require_film_of(*chart.scene, chart.scene->charts.front(), image.image);
  if (!chart.outlines.empty()) return chart.outlines;
  measured.detected_corners = find_chart(image);
  return outlines_between(*measured.detected_corners, chart.names, options.columns);
}

// Warns of pictures with a tone curve, whose code values divided by those of the flat are not ratios of
// light.
void warn_of_flat(const LinearImage& divided, const fs::path& file) {
  if (divided.unit != kCodeValues) return;
  Diagnostics diagnostics;
  warn_unless_linear(divided.image, file,
                     "--flat divides light, so use raw files, or pictures that declare that they are linear",
                     diagnostics);
  check(diagnostics);
}

// Measures the patches. If they show that the image clips below the declared saturation, measures them again
// with the lower level.
void measure_planes(const LinearImage& linear, const std::vector<PatchOutline>& outlines,
                    Measurement& measured) {
  MeasuredPlanes planes = linear.planes();
  measured.patches = measure_patches(linear.image, planes, outlines);
  if (!planes.saturation) return;
  measured.clipped_at = planes.clipped_at = clipping_levels(linear.image, planes, measured.patches);
  if (std::ranges::any_of(planes.clipped_at, [](const auto& level) { return level.has_value(); }))
    measured.patches = measure_patches(linear.image, planes, outlines);
}

// Measures one image. The name of the image precedes its errors.
Measurement measure_image(const fs::path& file, const ChartToMeasure& chart,
                          const std::optional<LinearImage>& flat, const MeasureOptions& options,
                          Inputs& inputs) {
  LinearImage linear = read_linear_image(file, &inputs);
  for (const std::string& warning : linear.warnings) warn(warning);
  Measurement measured{file, linear.channels, linear.unit, {}, {}, linear.saturation};
  try {
    const std::vector<PatchOutline> outlines = outlines_in(linear, chart, options, measured);
    if (flat) warn_of_flat(linear, file);
    if (flat && linear.exposed.empty()) inputs.reserve_memory(file.string(), linear.image.memory_bytes());
    if (flat) flat_field(linear, *flat, options.flat);
    measure_planes(linear, outlines, measured);
  } catch (const Error& error) {
    throw Error(error.code, file.string(), error.what());
  }
  for (std::size_t i = 0; i < chart.names.size(); ++i) measured.patches[i].name = chart.names[i];
  inputs.release_memory(linear.memory_bytes());
  return measured;
}

// Prints detected corners, so that the user can check them and pass them for images with the same framing.
void report_detected_corners(const Measurement& measured) {
  if (!measured.detected_corners) return;
  std::string numbers;
  for (const Imath::V2d& corner : *measured.detected_corners)
    numbers += fmt::format("{}{:.1f},{:.1f}", numbers.empty() ? "" : ",", corner.x, corner.y);
  print_message(fmt::format("{}: the chart was found at --corners {}", measured.file.string(), numbers));
}

// Warns if the file declares a saturation that is too high, or none.
void warn_of_clipping(const Measurement& measured) {
  std::string levels;
  for (std::size_t k = 0; k < measured.clipped_at.size(); ++k)
    if (const auto& level = measured.clipped_at[k])
      levels += fmt::format("{}{:.6g} in {}", levels.empty() ? "" : ", ", *level, measured.channels[k]);
  if (!levels.empty())
    print_message(
        fmt::format("warning: {}: the picture clips at {}, not at the {:.6g} that the file declares or its "
                    "format allows: patches at its highest value have no noise",
                    measured.file.string(), levels, *measured.saturation));
}

// Highest mean of a channel in patches whose pixels are all saturated but which differ by more than noise.
// Patches that the camera clips do not differ. Empty if there are no such patches.
std::optional<double> unclipped_mean(const Measurement& measured, std::size_t channel) {
  constexpr double kDeviations = 5;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = 0;
  double deviation = 0;
  for (const PatchValues& patch : measured.patches) {
    const PatchChannel& values = patch.channels[channel];
    if (values.saturated < values.pixels) continue;
    lowest = std::min(lowest, values.mean);
    highest = std::max(highest, values.mean);
    deviation = std::max(deviation, values.deviation.value_or(0));
  }
  return deviation > 0 && highest - lowest > kDeviations * deviation ? std::optional(highest) : std::nullopt;
}

// Warns if the file declares a saturation that is too low.
void warn_of_low_saturation(const Measurement& measured) {
  for (std::size_t k = 0; k < measured.channels.size(); ++k)
    if (const auto mean = unclipped_mean(measured, k))
      print_message(
          fmt::format("warning: {}: patches in {} differ at values up to {:.6g}, although the file declares "
                      "saturation from {:.6g}: declare the level at which the camera clips, if it is higher",
                      measured.file.string(), measured.channels[k], *mean, *measured.saturation));
}

void warn_of_saturation(const Measurement& measured) {
  std::vector<std::string> names;
  for (const PatchValues& patch : measured.patches)
    if (std::ranges::any_of(patch.channels,
                            [](const PatchChannel& channel) { return channel.is_saturated(); }))
      names.push_back(patch.name);
  if (names.empty()) return;
  print_message(
      fmt::format("warning: {}: saturated pixels make the means too low in {} (more than {:g} % of the "
                  "pixels; fewer are ignored as defective)",
                  measured.file.string(), fmt::join(names, ", "), 100 * kMaxDefectiveFraction));
}

Json json_of(const Measurement& measured) {
  Json patches = Json::array();
  for (const PatchValues& patch : measured.patches) {
    Json answer{{"patch", patch.name}};
    for (const PatchChannel& channel : patch.channels) {
      answer["pixels"].push_back(channel.pixels);
      answer["mean"].push_back(channel.mean);
      answer["deviation"].push_back(or_null(channel.deviation));
      answer["saturated"].push_back(channel.saturated);
    }
    patches.push_back(std::move(answer));
  }
  Json answer{{"image", measured.file.string()},
              {"unit", measured.unit},
              {"channels", measured.channels},
              {"patches", std::move(patches)}};
  if (measured.detected_corners)
    for (const Imath::V2d& corner : *measured.detected_corners)
      answer["corners"].push_back({corner.x, corner.y});
  return answer;
}

// CSV table for `calibrate --measured`. The first column names the image if there are several.
std::string csv_of(const std::vector<Measurement>& all) {
  const bool several = all.size() > 1;
  std::string text = fmt::format("# unit: {}\n{}patch", all.front().unit, several ? "image," : "");
  for (const char* of : {"", "_deviation", "_pixels", "_saturated"})
    for (const std::string& channel : all.front().channels) text += "," + csv_cell(channel + of);
  text += '\n';
  for (const Measurement& measured : all)
    for (const PatchValues& patch : measured.patches) {
      text += several ? csv_quoted(measured.file.string()) + "," : "";
      text += csv_quoted(patch.name);
      for (const PatchChannel& channel : patch.channels) text += fmt::format(",{}", channel.mean);
      for (const PatchChannel& channel : patch.channels)
        text += channel.deviation ? fmt::format(",{}", *channel.deviation) : ",";
      for (const PatchChannel& channel : patch.channels) text += fmt::format(",{}", channel.pixels);
      for (const PatchChannel& channel : patch.channels) text += fmt::format(",{}", channel.saturated);
      text += '\n';
    }
  return text;
}

void print_table(const Measurement& measured) {
  fmt::print("{} ({})\n{:<24}", measured.file.string(), measured.unit, "patch");
  for (const std::string& channel : measured.channels)
    fmt::print(" {:>12} {:>12} {:>7}", channel, "deviation", "pixels");
  fmt::print("\n");
  for (const PatchValues& patch : measured.patches) {
    fmt::print("{:<24}", patch.name);
    for (const PatchChannel& channel : patch.channels)
      fmt::print(" {:>12.6g} {:>12} {:>7}", channel.mean,
                 channel.deviation ? fmt::format("{:.4g}", *channel.deviation) : "-", channel.pixels);
    fmt::print("\n");
  }
}

void require_one_table(const std::vector<Measurement>& all) {
  for (const Measurement& measured : all)
    if (measured.channels != all.front().channels || measured.unit != all.front().unit)
      throw Error(
          ErrorCode::usage, "-o",
          fmt::format(
              "needs images with the same channels and unit for one table (got {} in {} and {} in {})",
              fmt::join(all.front().channels, ", "), all.front().file.string(),
              fmt::join(measured.channels, ", "), measured.file.string()));
}

void measure(const MeasureOptions& options) {
  Inputs inputs(options.max_memory_bytes);
  for (const fs::path& image : options.images) inputs.add_file(image);
  if (!options.flat.empty()) inputs.add_file(options.flat);
  std::optional<FileLock> lock;
  if (!options.output.empty()) {
    require_extension(options.output, {".csv"});
    require_writable(options.output);
    lock.emplace(options.output);
  }
  const ChartToMeasure chart = find_chart(options, inputs);
  require_distinct(std::array{options.output}, inputs.files());
  std::optional<LinearImage> flat;
  if (!options.flat.empty()) {
    flat = read_linear_image(options.flat, &inputs);
    warn_of_flat(*flat, options.flat);
  }
  std::vector<Measurement> all;
  for (const fs::path& image : options.images) {
    all.push_back(measure_image(image, chart, flat, options, inputs));
    report_detected_corners(all.back());
    warn_of_clipping(all.back());
    warn_of_low_saturation(all.back());
    warn_of_saturation(all.back());
  }
  if (!options.output.empty()) {
    require_one_table(all);
    write_atomically(options.output, csv_of(all));
  }
  Json list = Json::array();
  for (const Measurement& measured : all) list.push_back(json_of(measured));
  if (options.json)
    print(one_or_all(std::move(list)), true);
  else
    for (const Measurement& measured : all) print_table(measured);
}

ChartCorners parse_corners(const std::string& option, const std::string& text) {
  if (text == "find") return FindCorners{};
  const std::vector<double> numbers = parse_numbers(option, text, -1e6, 1e6);
  if (numbers.size() != 8)
    throw Error(ErrorCode::usage, option,
                fmt::format("expected x and y of four corners (got {} numbers, allowed 8)", numbers.size()));
  return Corners{Imath::V2d(numbers[0], numbers[1]), Imath::V2d(numbers[2], numbers[3]),
                 Imath::V2d(numbers[4], numbers[5]), Imath::V2d(numbers[6], numbers[7])};
}

}  // namespace

void add_measure(CLI::App& app, Command& command) {
  const Subcommand<MeasureOptions> sub(
      app, "measure", "Measure the patches of a chart in films, raw files and pictures", command, measure);
  CLI::App& options = *sub.app;
  add_value(options, "images", sub->images,
            "Films, spectral films, raw files (.dng, .fits, .tif, .png) and other pictures", "FILE")
      ->required();
  add_value(options, "--chart", sub->chart,
            "Scene with the chart, whose camera gives the position of the chart; with --corners, table "
            "of its patches",
            "SCENE|TABLE")
      ->required();
  add_parsed(options, "--corners", sub->corners, parse_corners,
             "Top left, top right, bottom right and bottom left corner of the chart "
             "in pixels; find detects a ColorChecker in each image",
             "X,Y,X,Y,X,Y,X,Y|find");
  add_parsed(options, "--columns", sub->columns, integer_in<std::size_t>(1, 1000),
             "Patches per row of the chart (default 6)", "N")
      ->needs("--corners");
  add_value(options, "--flat", sub->flat,
            "Picture of a uniform surface for flat-fielding, by which each pixel is divided", "FILE");
  add_value(options, "-o,--output", sub->output,
            "Table of the patches to write, as calibrate --measured reads it", "FILE.csv");
  add_max_memory(options, sub.options);
  add_json(options, sub->json);
}

}  // namespace abbe::cli
