#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "calibration/chart/measured_patches.h"
#include "calibration/chart/raw_scale.h"
#include "calibration/metrics/slanted_edge.h"
#include "cli/answer.h"
#include "cli/arguments.h"
#include "cli/output_files.h"
#include "cli/sensor_measurements.h"
#include "cli/sensor_plots.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/extension.h"
#include "sensor/film/defective_pixels.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_mosaic.h"

namespace abbe::cli {
namespace {

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
  const auto saturated = static_cast<double>(std::count_if(values.begin(), values.end(), [&](double value) {
    return code_of(static_cast<float>(value)) >= end->dn;
  }));
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
  for (const std::string& warning : read.warnings) print_message("warning: " + warning);
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

}  // namespace

int mtf(const MtfOptions& options) {
  if (!options.plot.empty()) require_extension(options.plot, {".svg"});
  Inputs inputs(options.max_memory_bytes);
  const EdgeResponse edge = measure_edge(options, inputs);
  Json answer;
  answer["angle_deg"] = edge.angle_deg;
  answer["edge"] = edge.is_horizontal ? "horizontal" : "vertical";
  answer["mtf50"] = edge.mtf50 ? Json(*edge.mtf50) : Json();
  for (std::size_t i = 0; i < edge.mtf.size(); ++i) {
    answer["frequency"].push_back(edge.frequency(i));
    answer["mtf"].push_back(edge.mtf[i]);
  }
  if (!options.plot.empty()) {
    require_distinct(std::array{options.plot}, inputs.files());
    write_atomically(options.plot, mtf_plot(answer));
  }
  print(answer, options.json);
  return 0;
}

}  // namespace abbe::cli
