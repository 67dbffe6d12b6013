#include "cli/calibrate_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "calibration/chart/measured_patches.h"
#include "calibration/chart/raw_scale.h"
#include "calibration/chart/transfer_frames.h"
#include "calibration/metrics/slanted_edge.h"
#include "cli/arguments.h"
#include "cli/command_options.h"
#include "cli/output_files.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/text.h"
#include "report/plot.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/patch.h"
#include "sensor/film/recorded_attributes.h"

namespace abbe::cli {

std::string line_color(const std::string& channel, std::size_t i) {
  constexpr std::array kOtherColors{"#333333", "#8e44ad", "#b7791f"};
  return channel == "R"   ? "#c0392b"
         : channel == "G" ? "#2e8b57"
         : channel == "B" ? "#2a5db0"
                          : kOtherColors.at(i % 3);
}

std::string transfer_plot(const Json& answer) {
  LogPlot plot{"Photon transfer", "signal [DN]", "variance [DN^2]", {}};
  for (std::size_t i = 0; i < answer.at("channel").size(); ++i) {
    const auto channel = answer.at("channel").at(i).get<std::string>();
    PlotSeries measured{channel, {}, line_color(channel, i), true, true};
    PlotSeries fitted{channel + ", signal / gain", {}, line_color(channel, i)};
    for (std::size_t k = 0; k < answer.at("signal_dn").at(i).size(); ++k) {
      const double signal = answer.at("signal_dn").at(i).at(k);
      const double variance = answer.at("variance_dn2").at(i).at(k);
      if (!(signal > 0 && variance > 0)) continue;
      measured.points.emplace_back(signal, variance);
      fitted.points.emplace_back(signal, signal / answer.at("gain_e_per_dn").at(i).get<double>());
    }
    plot.series.push_back(std::move(measured));
    plot.series.push_back(std::move(fitted));
  }
  return svg(plot);
}

std::string mtf_plot(const Json& answer) {
  PlotSeries curve{"", {}, line_color("B", 0)};
  for (std::size_t i = 0; i < answer.at("frequency").size(); ++i)
    curve.points.emplace_back(answer.at("frequency").at(i), answer.at("mtf").at(i));
  return svg(LinePlot{"Modulation transfer", "cycles per pixel", "modulation", {curve}});
}

Json read_answer(const std::filesystem::path& path, std::string (*plot)(const Json&), Inputs& inputs) {
  inputs.add_file(path);
  Diagnostics diagnostics;
  const auto source = read_text(path, diagnostics);
  if (!source) throw Error(diagnostics.code(), path.string(), diagnostics.text());
  try {
    Json answer = Json::parse(source->text);
    (void)plot(answer);
    return answer;
  } catch (const Json::exception&) {
    throw Error(ErrorCode::input, path.string(), "is not an answer that the command printed with --json");
  }
}

namespace {

struct TransferOptions {
  std::vector<std::filesystem::path> dark;
  std::vector<std::filesystem::path> flat;
  std::filesystem::path plot;
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

struct MtfOptions {
  std::filesystem::path image;
  std::optional<Crop> crop;
  std::string channel;
  std::filesystem::path plot;
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

void warn_of_missing_saturation(const std::vector<ChannelTransfer>& channels) {
  std::string unsaturated;
  for (const ChannelTransfer& one : channels)
    if (!one.transfer.saturation_e) unsaturated += (unsaturated.empty() ? "" : ", ") + one.channel;
  if (unsaturated.empty()) return;
  print_message(
      fmt::format("warning: no flat pair saturates {}, so that full well and dynamic range are unknown: add "
                  "a pair above saturation",
                  unsaturated));
}

// Warns of a gain that is biased by a response that is not linear.
void warn_of_nonlinearity(const std::vector<ChannelTransfer>& channels) {
  constexpr double kNegligible = 0.01;
  constexpr double kStandardErrors = 3;
  for (const ChannelTransfer& one : channels) {
    const auto& bias = one.transfer.gain_bias;
    const double limit = bias ? std::max(kNegligible, kStandardErrors * bias->standard_error) : 0;
    if (!bias || std::abs(bias->value) <= limit) continue;
    print_message(fmt::format(
        "warning: {} does not respond linearly, so that its gain and all its figures in electrons are {:.2g} "
        "% too {} (the gain in weak light is {:.5g} e/DN): use weaker light, or linearise the response first",
        one.channel, 100 * std::abs(bias->value), bias->value > 0 ? "large" : "small",
        one.transfer.gain_e_per_dn / (1 + bias->value)));
  }
}

// Rejects a mosaic: a single plane, possibly with planes such as its variance. Pictures developed from a
// mosaic also record it, but do not contain its plane.
void require_no_mosaic(const RawImage& read, const std::filesystem::path& path) {
  if (!(read.scale && read.scale->mosaic) && !recorded_mosaic(read.image.metadata)) return;
  const std::vector<std::string> planes = plane_names(read.image);
  if (read.image.channels.size() != 1 && (planes.size() != 1 || !read.image.find(planes.front()))) return;
  throw Error(ErrorCode::input, path.string(),
              "is a mosaic, whose neighbouring pixels belong to different channels (allowed: a film of a "
              "sensor without a mosaic, or a linear picture from a raw converter)");
}

// Requested channel; by default G, otherwise Y, otherwise the first plane.
const ImageChannel& channel_of(const Image& image, const std::string& requested) {
  if (!requested.empty()) {
    if (const ImageChannel* channel = image.find(requested)) return *channel;
    std::vector<std::string> names;
    for (const ImageChannel& channel : image.channels) names.push_back(channel.name);
    throw Error(ErrorCode::usage, "--channel",
                fmt::format("got \"{}\", allowed {}", requested, fmt::join(names, ", ")));
  }
  for (const char* name : {"G", "Y"})
    if (const ImageChannel* channel = image.find(name)) return *channel;
  for (const std::string& plane : plane_names(image))
    if (const ImageChannel* channel = image.find(plane)) return *channel;
  return image.channels.front();
}

// Warns of values at the end of the code range, where brighter ones are clipped. A small fraction is
// accepted, since hot pixels reach it next to any edge.
void warn_of_saturated_edge(const RawImage& read, std::span<const double> values,
                            const std::filesystem::path& path) {
  if (extension_of(path) == ".exr") return;
  const std::optional<ClippingLevel> end = clipping_level(read);
  if (!end) return;
  const auto pixels = static_cast<double>(values.size());
  const auto saturated = static_cast<double>(std::ranges::count_if(
      values, [&](double value) { return code_of(static_cast<float>(value)) >= end->dn; }));
  if (exceeds_defects(saturated, pixels))
    print_message(fmt::format(
        "warning: {}: the bright side of the edge {} saturated, which distorts the MTF (got "
        "{:.3g} % of the pixels at {}, allowed {} %): use a shorter exposure",
        path.string(), end->is_declared ? "is" : "may be", 100 * saturated / pixels,
        end->is_declared ? "the white level or above" : "the highest code", 100 * kMaxDefectiveFraction));
}

EdgeResponse measure_edge(const MtfOptions& options, Inputs& inputs) {
  inputs.add_file(options.image);
  const RawImage read = read_raw_image(options.image, &inputs);
  for (const std::string& warning : read.warnings) warn(warning);
  require_no_mosaic(read, options.image);
  const Image& image = read.image;
  Diagnostics diagnostics;
  warn_unless_linear(image, options.image,
                     "use a film, a raw file, or a picture that declares that it is linear", diagnostics);
  check(diagnostics);
  const Crop crop = requested_pixels(image, options.crop);
  const ImageChannel& channel = channel_of(image, options.channel);
  std::vector<double> values;
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x)
      values.push_back(static_cast<double>(
          channel.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(x)]));
  warn_of_saturated_edge(read, values, options.image);
  return slanted_edge(values, crop.x1 - crop.x0, crop.y1 - crop.y0);
}

void transfer(const TransferOptions& options) {
  if (!options.plot.empty()) require_extension(options.plot, {".svg"});
  Inputs inputs(options.max_memory_bytes);
  std::vector<std::string> warnings;
  const std::vector<ChannelTransfer> channels =
      measure_transfer(options.dark, options.flat, inputs, &warnings);
  for (const std::string& warning : warnings) warn(warning);
  warn_of_missing_saturation(channels);
  warn_of_nonlinearity(channels);
  Json answer;
  for (const ChannelTransfer& one : channels) {
    const PhotonTransfer& transfer = one.transfer;
    answer["channel"].push_back(one.channel);
    answer["gain_e_per_dn"].push_back(transfer.gain_e_per_dn);
    answer["gain_standard_error"].push_back(transfer.gain_standard_error);
    answer["read_noise_e"].push_back(transfer.read_noise_e);
    answer["read_noise_standard_error"].push_back(or_null(transfer.read_noise_standard_error));
    answer["dark_e_per_s"].push_back(transfer.dark_e_per_s);
    answer["prnu_percent"].push_back(transfer.prnu_percent);
    answer["dsnu_e"].push_back(transfer.dsnu_e);
    answer["full_well_e"].push_back(or_null(transfer.full_well_e));
    answer["dynamic_range_db"].push_back(or_null(one.dynamic_range_db));
    answer["snr10_e"].push_back(one.snr10_e);
    answer["linearity_error_percent"].push_back(or_null(transfer.linearity_error_percent));
    answer["snr10_lx_s"].push_back(or_null(one.snr10_lx_s));
    Json signals = Json::array();
    Json variances = Json::array();
    for (const TransferPoint& point : transfer.points) {
      signals.push_back(point.signal_dn);
      variances.push_back(point.variance_dn2);
    }
    answer["signal_dn"].push_back(std::move(signals));
    answer["variance_dn2"].push_back(std::move(variances));
  }
  if (!options.plot.empty()) {
    require_distinct(std::array{options.plot}, inputs.files());
    write_atomically(options.plot, transfer_plot(answer));
  }
  if (!options.json)
    for (const char* curve : {"signal_dn", "variance_dn2"}) answer.erase(curve);
  print(answer, options.json);
}

void mtf(const MtfOptions& options) {
  if (!options.plot.empty()) require_extension(options.plot, {".svg"});
  Inputs inputs(options.max_memory_bytes);
  const EdgeResponse edge = measure_edge(options, inputs);
  Json answer;
  answer["angle_deg"] = edge.angle_deg;
  answer["edge"] = edge.is_horizontal ? "horizontal" : "vertical";
  answer["mtf50"] = or_null(edge.mtf50);
  for (std::size_t i = 0; i < edge.mtf.size(); ++i) {
    answer["frequency"].push_back(edge.frequency(i));
    answer["mtf"].push_back(edge.mtf[i]);
  }
  if (!options.plot.empty()) {
    require_distinct(std::array{options.plot}, inputs.files());
    write_atomically(options.plot, mtf_plot(answer));
  }
  print(answer, options.json);
}

}  // namespace

void add_transfer(CLI::App& app, Command& command) {
  const Subcommand<TransferOptions> sub(
      app, "transfer", "Gain, noise and dynamic range of a sensor from pairs of flat and dark raw files",
      command, transfer);
  add_value(*sub.app, "--dark", sub->dark,
            "Dark frames in successive pairs of equal exposure, with at least two exposure times", "FILE...")
      ->required();
  add_value(*sub.app, "--lit", sub->flat,
            "Uniformly illuminated (flat) frames in successive pairs of equal exposure, from weak "
            "light to above saturation",
            "FILE...")
      ->required();
  add_value(*sub.app, "--plot", sub->plot, "Plot of the photon-transfer curves to write", "FILE.svg");
  add_max_memory(*sub.app, sub.options);
  add_json(*sub.app, sub->json);
}

void add_mtf(CLI::App& app, Command& command) {
  const Subcommand<MtfOptions> sub(
      app, "mtf", "Modulation transfer function of a slanted edge in a linear image", command, mtf);
  add_value(*sub.app, "image", sub->image, "Film or linear picture with a slanted edge", "FILE")->required();
  add_parsed(*sub.app, "--crop", sub->crop, parse_crop,
             "Pixels around the edge, X0 <= x < X1 and Y0 <= y < Y1 (default: all)", "X0,Y0,X1,Y1");
  add_value(*sub.app, "--channel", sub->channel,
            "Channel to evaluate (default: G, otherwise Y, otherwise the first)", "NAME");
  add_value(*sub.app, "--plot", sub->plot, "Plot of the function to write", "FILE.svg");
  add_max_memory(*sub.app, sub.options);
  add_json(*sub.app, sub->json);
}

}  // namespace abbe::cli
