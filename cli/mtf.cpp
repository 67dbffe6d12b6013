#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "calibration/chart/measured_patches.h"
#include "calibration/chart/raw_scale.h"
#include "calibration/chart/white_level.h"
#include "calibration/judge/slanted_edge.h"
#include "cli/answer.h"
#include "cli/arguments.h"
#include "cli/bench_measurements.h"
#include "cli/bench_plots.h"
#include "cli/output_files.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/extension.h"
#include "sensor/film/defective_pixels.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_mosaic.h"

namespace abbe::cli {
namespace {

// A mosaic is a plane alone, or with what a film has beside it, such as its variance. Pictures that were
// developed of one tell of it too, but have not its plane.
void require_no_mosaic(const RawImage& read, const std::filesystem::path& path) {
  if (!(read.scale && read.scale->mosaic) && !recorded_mosaic(read.image.metadata)) return;
  const std::vector<std::string> planes = plane_names(read.image);
  if (read.image.channels.size() != 1 && (planes.size() != 1 || !read.image.find(planes.front()))) return;
  throw Error(ErrorCode::input, path.string(),
              "is a mosaic, whose neighbours are of other channels (allowed a film of a sensor without "
              "a mosaic, or the linear picture that a raw converter makes of a raw file)");
}

// The channel asked for, else G, else Y, else the first plane.
const ImageChannel& channel_of(const Image& image, const std::string& asked) {
  if (!asked.empty()) {
    if (const ImageChannel* found = image.find(asked)) return *found;
    std::vector<std::string> names;
    for (const ImageChannel& channel : image.channels) names.push_back(channel.name);
    throw Error(ErrorCode::usage, "--channel",
                fmt::format("got \"{}\", allowed {}", asked, fmt::join(names, ", ")));
  }
  for (const char* name : {"G", "Y"})
    if (const ImageChannel* found = image.find(name)) return *found;
  for (const std::string& plane : plane_names(image))
    if (const ImageChannel* found = image.find(plane)) return *found;
  return image.channels.front();
}

// Warns of values at the end of the codes, where brighter ones are cut off; but for hot pixels, which reach
// it beside any edge.
void warn_of_cut_codes(const RawImage& read, std::span<const double> values,
                       const std::filesystem::path& path) {
  if (extension_of(path) == ".exr") return;
  const std::optional<EndOfCodes> end = end_of_codes(read);
  if (!end) return;
  const auto pixels = static_cast<double>(values.size());
  const auto saturated = static_cast<double>(std::count_if(values.begin(), values.end(), [&](double value) {
    return code_of(static_cast<float>(value)) >= end->dn;
  }));
  if (exceeds_defects(saturated, pixels))
    say(fmt::format(
        "warning: {}: the bright side of the edge {} saturated (got {:.3g} % of its pixels at {}, "
        "allowed {} %), so that its mtf is not that of the light: expose it less",
        path.string(), end->is_told ? "is" : "may be", 100 * saturated / pixels,
        end->is_told ? "the white level or above" : "the highest code", 100 * kMostDefective));
}

EdgeResponse measure_edge(const MtfOptions& options, Inputs& inputs) {
  inputs.add_file(options.image);
  const RawImage read = read_raw_image(options.image, &inputs);
  for (const std::string& warning : read.warnings) say("warning: " + warning);
  require_no_mosaic(read, options.image);
  const Image& image = read.image;
  Diagnostics diagnostics;
  warn_unless_linear(image, options.image,
                     "measure a film, a raw file, or a picture that says that it is linear", diagnostics);
  check(diagnostics);
  const Crop crop = asked_pixels(image, options.crop);
  const ImageChannel& channel = channel_of(image, options.channel);
  std::vector<double> values;
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x)
      values.push_back(static_cast<double>(
          channel.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(x)]));
  warn_of_cut_codes(read, values, options.image);
  return slanted_edge(values, crop.x1 - crop.x0, crop.y1 - crop.y0);
}

}  // namespace

int mtf(const MtfOptions& options) {
  if (!options.plot.empty()) require_extension(options.plot, {".svg"});
  Inputs inputs(options.max_memory_bytes);
  const EdgeResponse found = measure_edge(options, inputs);
  Json answer;
  answer["angle_deg"] = found.angle_deg;
  answer["edge"] = found.is_horizontal ? "horizontal" : "vertical";
  answer["mtf50"] = found.mtf50 ? Json(*found.mtf50) : Json();
  for (std::size_t i = 0; i < found.mtf.size(); ++i) {
    answer["frequency"].push_back(found.frequency(i));
    answer["mtf"].push_back(found.mtf[i]);
  }
  if (!options.plot.empty()) {
    require_distinct(std::array{options.plot}, inputs.files());
    write_atomically(options.plot, mtf_plot(answer));
  }
  print(answer, options.json);
  return 0;
}

}  // namespace abbe::cli
