#include "cli/measure.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "calibration/chart/chart_corners.h"
#include "calibration/chart/measured_patches.h"
#include "cli/answer.h"
#include "cli/output_files.h"
#include "description/load.h"
#include "develop/find_chart.h"
#include "develop/linear_image.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/extension.h"
#include "io/file_lock.h"
#include "scene/chart/readout.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

using Corners = std::array<Imath::V2d, 4>;

/// A chart to be found in images, and the scene that says where, if one does.
struct ChartToMeasure {
  std::optional<Scene> scene;
  std::vector<PatchOutline> outlines;  ///< Empty where they are to be found in each image.
  std::vector<std::string> names;      ///< As the chart's table has them.
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
    throw Error(ErrorCode::usage, "--chart",
                fmt::format("no such scene; a table of patches needs --corners (got {})", options.chart));
  if (!options.corners) return chart_of_scene(options.chart, inputs);
  for (const fs::path& file : files_among({options.chart})) inputs.add_file(file);
  Diagnostics diagnostics;
  ChartToMeasure chart;
  chart.names = accepted(load_chart_targets(options.chart, Curve(1.0), {}, diagnostics), diagnostics).names;
  if (const auto* corners = std::get_if<Corners>(&*options.corners))
    chart.outlines = outlines_between(*corners, chart.names, options.columns);
  else if (chart.names.size() != 24 || options.columns != 6)
    throw Error(ErrorCode::usage, "--corners find",
                fmt::format("finds ColorCheckers of 24 patches alone, 6 to a row (got {} with {} patches, {} "
                            "to a row)",
                            options.chart, chart.names.size(), options.columns));
  return chart;
}

/// One image's patches.
struct Measurement {
  fs::path file;
  std::vector<std::string> channels;
  std::string unit;
  std::vector<PatchValues> patches;
  std::optional<Corners> found;                     // where the chart was, if it had to be found
  std::optional<double> saturation;                 // as the file declares it
  std::vector<std::optional<double>> clipped_at{};  // per channel, where that is lower
};

// Where the chart is in an image, and whether that had to be found.
std::vector<PatchOutline> outlines_in(const LinearImage& image, const ChartToMeasure& chart,
                                      const MeasureOptions& options, Measurement& measured) {
  if (chart.scene) require_film_of(*chart.scene, chart.scene->charts.front(), image.image);
  if (!chart.outlines.empty()) return chart.outlines;
  measured.found = find_chart(image);
  return outlines_between(*measured.found, chart.names, options.columns);
}

// A curve makes of light divided by light no ratio of their codes.
void warn_of_flat(const LinearImage& divided, const fs::path& file) {
  if (divided.unit != kCodeValues) return;
  Diagnostics diagnostics;
  warn_unless_linear(
      divided.image, file,
      "a --flat divides light, so that it needs raw files, or pictures that say that they are linear",
      diagnostics);
  check(diagnostics);
}

// Measures the patches, and once more where they show that the image is clipped below what its file declares.
void measure_planes(const LinearImage& read, const std::vector<PatchOutline>& outlines,
                    Measurement& measured) {
  MeasuredPlanes planes = read.planes();
  measured.patches = measure_patches(read.image, planes, outlines);
  if (!planes.saturation) return;
  measured.clipped_at = planes.clipped_at = clipping_levels(read.image, planes, measured.patches);
  if (std::any_of(planes.clipped_at.begin(), planes.clipped_at.end(),
                  [](const auto& level) { return level; }))
    measured.patches = measure_patches(read.image, planes, outlines);
}

// An image's name stands before what is wrong with it.
Measurement measure_image(const fs::path& file, const ChartToMeasure& chart,
                          const std::optional<LinearImage>& flat, const MeasureOptions& options,
                          Inputs& inputs) {
  LinearImage read = read_linear_image(file, &inputs);
  for (const std::string& warning : read.warnings) say("warning: " + warning);
  Measurement measured{file, read.channels, read.unit, {}, {}, read.saturation};
  try {
    const std::vector<PatchOutline> outlines = outlines_in(read, chart, options, measured);
    if (flat) warn_of_flat(read, file);
    if (flat && read.exposed.empty()) inputs.take_memory(file.string(), read.image.memory_bytes());
    if (flat) flat_field(read, *flat, options.flat);
    measure_planes(read, outlines, measured);
  } catch (const Error& error) {
    throw Error(error.code, file.string(), error.what());
  }
  for (std::size_t i = 0; i < chart.names.size(); ++i) measured.patches[i].name = chart.names[i];
  inputs.give_back_memory(read.memory_bytes());
  return measured;
}

// So that one can check them, and give them for others of the same place.
void tell_found(const Measurement& measured) {
  if (!measured.found) return;
  std::string numbers;
  for (const Imath::V2d& corner : *measured.found)
    numbers += fmt::format("{}{:.1f},{:.1f}", numbers.empty() ? "" : ",", corner.x, corner.y);
  say(fmt::format("{}: the chart was found at --corners {}", measured.file.string(), numbers));
}

// Warns of a saturation that the file declares too high, or not at all.
void warn_of_clipping(const Measurement& measured) {
  std::string levels;
  for (std::size_t k = 0; k < measured.clipped_at.size(); ++k)
    if (const auto& level = measured.clipped_at[k])
      levels += fmt::format("{}{:.6g} in {}", levels.empty() ? "" : ", ", *level, measured.channels[k]);
  if (!levels.empty())
    say(fmt::format(
        "warning: {}: patches without any noise hold the highest value of the picture ({}), so that it is "
        "clipped there, not at the {:.6g} that the file declares or its format allows",
        measured.file.string(), levels, *measured.saturation));
}

// The highest mean of a channel in patches that are saturated in all pixels but differ by more than noise, as
// none do that the camera clips; nothing where there are none.
std::optional<double> unclipped_mean(const Measurement& measured, std::size_t channel) {
  constexpr double kDeviations = 5;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = 0;
  double deviation = 0;
  for (const PatchValues& patch : measured.patches) {
    const PatchChannel& own = patch.channels[channel];
    if (own.saturated < own.pixels) continue;
    lowest = std::min(lowest, own.mean);
    highest = std::max(highest, own.mean);
    deviation = std::max(deviation, own.deviation.value_or(0));
  }
  return deviation > 0 && highest - lowest > kDeviations * deviation ? std::optional(highest) : std::nullopt;
}

// Warns of a saturation that the file declares too low.
void warn_of_low_saturation(const Measurement& measured) {
  for (std::size_t k = 0; k < measured.channels.size(); ++k)
    if (const auto mean = unclipped_mean(measured, k))
      say(fmt::format(
          "warning: {}: patches of {} differ up to {:.6g}, above the {:.6g} from which the file declares "
          "pixels to be saturated: declare the level where the camera clips, if that is higher",
          measured.file.string(), measured.channels[k], *mean, *measured.saturation));
}

void warn_of_saturation(const Measurement& measured) {
  std::vector<std::string> names;
  for (const PatchValues& patch : measured.patches)
    if (std::any_of(patch.channels.begin(), patch.channels.end(),
                    [](const PatchChannel& channel) { return channel.is_saturated(); }))
      names.push_back(patch.name);
  if (names.empty()) return;
  say(
      fmt::format("warning: {}: saturated pixels, whose values are too low, in {} (more than {:g} %, up to "
                  "which they are taken for defective and left out)",
                  measured.file.string(), fmt::join(names, ", "), 100 * kMostDefective));
}

Json json_of(const Measurement& measured) {
  Json patches = Json::array();
  for (const PatchValues& patch : measured.patches) {
    Json told{{"patch", patch.name}};
    for (const PatchChannel& channel : patch.channels) {
      told["pixels"].push_back(channel.pixels);
      told["mean"].push_back(channel.mean);
      told["deviation"].push_back(channel.deviation ? Json(*channel.deviation) : Json());
      told["saturated"].push_back(channel.saturated);
    }
    patches.push_back(std::move(told));
  }
  Json told{{"image", measured.file.string()},
            {"unit", measured.unit},
            {"channels", measured.channels},
            {"patches", std::move(patches)}};
  if (measured.found)
    for (const Imath::V2d& corner : *measured.found) told["corners"].push_back({corner.x, corner.y});
  return told;
}

// As `calibrate --measured` takes it; of several images a line each, told by the first column.
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
          fmt::format("one table holds images of the same channels and unit (got {} of {} and {} of {})",
                      fmt::join(all.front().channels, ", "), all.front().file.string(),
                      fmt::join(measured.channels, ", "), measured.file.string()));
}

}  // namespace

int measure(const MeasureOptions& options) {
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
    tell_found(all.back());
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
  return 0;
}

}  // namespace abbe::cli
