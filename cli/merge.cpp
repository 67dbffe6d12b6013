#include <algorithm>
#include <deque>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/answer.h"
#include "cli/command_options.h"
#include "cli/output_files.h"
#include "cli/progress.h"
#include "develop/film_file.h"
#include "develop/radiance.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "results/rendered_film.h"
#include "transport/render/part_films.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

struct MergeOptions {
  std::vector<fs::path> parts;
  std::vector<fs::path> outputs;
  std::optional<Crop> crop;
  fs::path display;
  bool partial = false;
  std::size_t max_memory_bytes = default_memory_limit();
};

/// Header of the merged film, and the memory that its largest part needs.
struct Headers {
  PartHeader sum;
  std::size_t largest_bytes = 0;
};

// Checks all parts by their headers before the first sum is read, since there may be thousands.
Headers read_headers(const MergeOptions& options) {
  std::vector<std::string> absent;
  std::error_code ignored;
  for (const fs::path& part : options.parts)
    if (!fs::exists(part, ignored)) absent.push_back(part.string());
  if (!absent.empty())
    throw Error(ErrorCode::input, fmt::format("{}", fmt::join(absent, ", ")), "no such file");
  std::optional<Headers> all;
  for (const fs::path& path : options.parts) {
    PartHeader part = read_part_header(path);
    const std::size_t bytes = bytes_of_sums(part);
    if (options.crop && !contains(*options.crop, pixels_of(part.shape)))
      throw Error(ErrorCode::input, path.string(),
                  fmt::format("has pixels outside --crop (got {}, allowed {})",
                              to_text(pixels_of(part.shape)), to_text(*options.crop)));
    if (!all) {
      all = Headers{std::move(part), bytes};
      continue;
    }
    abbe::merge(all->sum, part, path);
    all->largest_bytes = std::max(all->largest_bytes, bytes);
  }
  return *std::move(all);
}

// Memory holds the sum, the film of one part and the bytes from which it is read.
RenderPart sum_of(const MergeOptions& options, const Headers& headers) {
  Inputs inputs(options.max_memory_bytes);
  inputs.reserve_memory(options.parts.front().string(),
                        bytes_of_sums(headers.sum) + 2 * headers.largest_bytes);
  RenderPart sum = empty_part(headers.sum);
  for (const fs::path& path : options.parts) abbe::merge(sum, read_part(path), path);
  return sum;
}

// Sensor for the picture, from the attributes of the film before any sums are read. Like `render`, it omits
// the readout, so that the picture shows the light without noise.
FilmSensor display_sensor(const FilmIdentity& identity, const fs::path& part) {
  const Image header{0, 0, {}, identity};
  const ViewOptions view{users_configuration(), {}, {}};
  FilmSensor sensor;
  if (identity.contains(kSpectralBinsKey)) {
    sensor = observer_of(header, part, view, {});
  } else {
    Diagnostics diagnostics;
    sensor = accepted(read_film_sensor(header, part, {}, view, {}, diagnostics), diagnostics);
    sensor.readout.reset();
  }
  require_display(sensor);
  return sensor;
}

// Output files, which are checked before any part is read.
std::vector<fs::path> check_outputs(const MergeOptions& options) {
  std::vector<fs::path> files = options.outputs;
  for (const fs::path& output : options.outputs) require_film_output(output);
  if (!options.display.empty()) {
    require_picture_extension(options.display);
    require_writable(options.display);
    files.push_back(options.display);
  }
  require_distinct(files, options.parts);
  return files;
}

// Adds parts of one render, which are ranges of samples and crops, and writes their film.
void merge(const MergeOptions& options) {
  std::deque<FileLock> locks;
  for (const fs::path& file : check_outputs(options)) locks.emplace_back(file);
  const Headers headers = read_headers(options);
  const PartHeader& all = headers.sum;
  const SampledAreas missing = missing_samples(all, options.crop);
  if (!missing.empty() && !options.partial)
    throw Error(ErrorCode::input, options.outputs.front().string(),
                fmt::format("{} are missing from the whole render (--partial writes the film without them)",
                            describe_samples(missing, all.shape)));
  std::optional<FilmSensor> sensor;
  if (!options.display.empty()) sensor = display_sensor(all.identity, options.parts.front());
  const RenderPart sum = sum_of(options, headers);
  std::vector<std::function<void()>> writers;
  for (const fs::path& output : options.outputs) writers.emplace_back([&] { write_film(output, sum); });
  if (sensor)
    writers.emplace_back(
        [&] { write_display(options.display, display_planes(*sensor, film_image(sum)), *sensor); });
  write_all(writers);
  const double error = frame_mean_error(sum).value_or(std::numeric_limits<double>::infinity());
  print_message(
      fmt::format("{} from {} parts: {}{}{}", options.outputs.front().string(), options.parts.size(),
                  describe_samples(all.areas, all.shape, " of every pixel"),
                  missing.empty() ? "" : fmt::format("; missing: {}", describe_samples(missing, all.shape)),
                  error_text({.frame_mean = error, .few_samples = few_samples(sum)}, ", ")));
}

}  // namespace

void add_merge(CLI::App& app, Command& command) {
  const Subcommand<MergeOptions> sub(app, "merge", "Merge parts of one render into its film", command, merge);
  add_value(*sub.app, "parts", sub->parts, "Partial films of one render, in any order", "PART.abbepart...")
      ->required();
  add_value(*sub.app, "-o,--output", sub->outputs,
            "Film (.exr) or partial film with exact sums (.abbepart) to write; may be repeated",
            "FILE.exr|FILE.abbepart")
      ->required()
      ->allow_extra_args(false);
  add_value(*sub.app, "--display", sub->display, "Also write a picture for a display, like that of render",
            "FILE.png");
  add_parsed(
      *sub.app, "--crop", sub->crop,
      [](const auto& option, const auto& text) { return parse_crop(option, text); },
      "Pixels that the film must contain, X0 <= x < X1 and Y0 <= y < Y1 (default: all)", "X0,Y0,X1,Y1");
  sub.app->add_flag("--partial", sub->partial,
                    "Write the film even if it has fewer samples than --spp or the scene states");
  add_max_memory(*sub.app, sub.options);
}

}  // namespace abbe::cli
