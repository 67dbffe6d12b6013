#include "cli/merge.h"

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
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

// What all parts together are, by their headers: thousands of them are judged before the first sum is read.
PartHeader sum_of_headers(const std::vector<fs::path>& parts) {
  std::vector<std::string> absent;
  std::error_code ignored;
  for (const fs::path& part : parts)
    if (!fs::is_regular_file(part, ignored)) absent.push_back(part.string());
  if (!absent.empty())
    throw Error(ErrorCode::input, fmt::format("{}", fmt::join(absent, ", ")), "no such file");
  PartHeader sum = read_part_header(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) abbe::merge(sum, read_part_header(parts[i]), parts[i]);
  return sum;
}

// Of one shape, as their headers have told. Beside the sum are the film of a part and the bytes it is read
// from.
RenderPart sum_of(const std::vector<fs::path>& parts, std::size_t max_memory_bytes) {
  Inputs inputs(max_memory_bytes);
  std::error_code vanished;
  const std::uintmax_t film_bytes = fs::file_size(parts.front(), vanished);
  if (!vanished) inputs.take_memory(parts.front().string(), (parts.size() > 1 ? 3 : 2) * film_bytes);
  RenderPart sum = read_part(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) abbe::merge(sum, read_part(parts[i]), parts[i]);
  return sum;
}

}  // namespace

int merge(const MergeOptions& options) {
  for (const fs::path& output : options.outputs) require_film_output(output);
  require_distinct(options.outputs, options.parts);
  std::deque<FileLock> locks;
  for (const fs::path& output : options.outputs) locks.emplace_back(output);
  const SampleRanges missing = missing_samples(sum_of_headers(options.parts));
  if (!missing.empty() && !options.partial)
    throw Error(
        ErrorCode::input, options.outputs.front().string(),
        fmt::format("samples {} are missing of those that the render is to have; --partial writes what "
                    "the others give",
                    to_text(missing)));
  const RenderPart sum = sum_of(options.parts, options.max_memory_bytes);
  std::vector<std::function<void()>> writers;
  for (const fs::path& output : options.outputs) writers.emplace_back([&] { write_film(output, sum); });
  write_all(writers);
  say(fmt::format("{} from {} parts: samples {} of every pixel{}{}", options.outputs.front().string(),
                  options.parts.size(), to_text(sum.result.samples),
                  missing.empty() ? "" : fmt::format(", {} missing", to_text(missing)),
                  error_text({.frame_mean = frame_mean_error(sum.result.film)}, ", ")));
  return 0;
}

}  // namespace abbe::cli
