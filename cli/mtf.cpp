#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "calibration/chart/raw_scale.h"
#include "calibration/judge/slanted_edge.h"
#include "cli/answer.h"
#include "cli/arguments.h"
#include "cli/bench_measurements.h"
#include "cli/bench_plots.h"
#include "cli/output_files.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/extension.h"

namespace abbe::cli {
namespace {

// The channel asked for, else G, else Y, else the first.
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
  return image.channels.front();
}

EdgeResponse measure_edge(const MtfOptions& options, Inputs& inputs) {
  inputs.add_file(options.image);
  const auto [image, told] = read_raw_image(options.image, &inputs);
  if (told && told->mosaic && image.channels.size() == 1)
    throw Error(ErrorCode::input, options.image.string(),
                "is a mosaic, whose neighbours are of other channels: take the film, or a file of its parts");
  const Crop crop = asked_pixels(image, options.crop);
  const ImageChannel& channel = channel_of(image, options.channel);
  std::vector<double> values;
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x)
      values.push_back(static_cast<double>(
          channel.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(x)]));
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
