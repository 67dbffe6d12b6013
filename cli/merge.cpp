#include "cli/merge.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/answer.h"
#include "cli/output_files.h"
#include "cli/progress.h"
#include "film/rendered_film.h"
#include "io/error.h"
#include "io/file_lock.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

/// What all parts together are, and the most that one of them takes.
struct Headers {
  PartHeader sum;
  std::size_t largest_bytes = 0;
};

// Thousands of parts are judged by their headers before the first sum is read.
Headers read_headers(const MergeOptions& options) {
  std::vector<std::string> absent;
  std::error_code ignored;
  for (const fs::path& part : options.parts)
    if (!fs::is_regular_file(part, ignored)) absent.push_back(part.string());
  if (!absent.empty())
    throw Error(ErrorCode::input, fmt::format("{}", fmt::join(absent, ", ")), "no such file");
  std::optional<Headers> all;
  for (const fs::path& path : options.parts) {
    PartHeader part = read_part_header(path);
    const std::size_t bytes = bytes_of_sums(part.shape);
    if (options.crop && !contains(*options.crop, pixels_of(part.shape)))
      throw Error(ErrorCode::input, path.string(),
                  fmt::format("has pixels beyond --crop (got {}, allowed {})", to_text(pixels_of(part.shape)),
                              to_text(*options.crop)));
    if (!all) {
      all = Headers{std::move(part), bytes};
      continue;
    }
    abbe::merge(all->sum, part, path);
    all->largest_bytes = std::max(all->largest_bytes, bytes);
  }
  return *std::move(all);
}

// Beside the sum are the film of a part and the bytes it is read from.
RenderPart sum_of(const MergeOptions& options, const Headers& headers) {
  Inputs inputs(options.max_memory_bytes);
  inputs.take_memory("merge", bytes_of_sums(headers.sum.shape) + 2 * headers.largest_bytes);
  RenderPart sum = empty_part(headers.sum);
  for (const fs::path& path : options.parts) abbe::merge(sum, read_part(path), path);
  return sum;
}

// Which samples of which pixels.
std::string in_words(const SampledAreas& areas, const FilmShape& shape, std::string_view of_all) {
  std::string text;
  for (const auto& [pixels, samples] : areas) {
    const bool all = pixels == Crop{0, 0, shape.width, shape.height};
    text += fmt::format("{}samples {}{}", text.empty() ? "" : ", ", to_text(samples),
                        all ? std::string(of_all) : fmt::format(" of pixels {}", to_text(pixels)));
  }
  return text;
}

}  // namespace

int merge(const MergeOptions& options) {
  for (const fs::path& output : options.outputs) require_film_output(output);
  require_distinct(options.outputs, options.parts);
  std::deque<FileLock> locks;
  for (const fs::path& output : options.outputs) locks.emplace_back(output);
  const Headers headers = read_headers(options);
  const PartHeader& all = headers.sum;
  const SampledAreas missing = missing_samples(all, options.crop);
  if (!missing.empty() && !options.partial)
    throw Error(
        ErrorCode::input, options.outputs.front().string(),
        fmt::format(
            "{} are missing of those that the render is to have; --partial writes what the others give",
            in_words(missing, all.shape, "")));
  const RenderPart sum = sum_of(options, headers);
  std::vector<std::function<void()>> writers;
  for (const fs::path& output : options.outputs) writers.emplace_back([&] { write_film(output, sum); });
  write_all(writers);
  say(fmt::format("{} from {} parts: {}{}{}", options.outputs.front().string(), options.parts.size(),
                  in_words(all.areas, all.shape, " of every pixel"),
                  missing.empty() ? "" : fmt::format("; missing: {}", in_words(missing, all.shape, "")),
                  error_text({.frame_mean = frame_mean_error(sum.result.film)}, ", ")));
  return 0;
}

}  // namespace abbe::cli
