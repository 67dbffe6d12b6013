#include "cli/merge.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/film_output.h"
#include "cli/output_files.h"
#include "cli/progress.h"
#include "io/file_lock.h"

namespace abbe::cli {
namespace {

// Its bytes are in memory beside the sums made of them.
RenderPart read_counted(const std::filesystem::path& path, Inputs& inputs) {
  std::error_code missing;
  const std::uintmax_t bytes = std::filesystem::file_size(path, missing);
  if (missing) return read_part(path);  // which says so
  inputs.take_memory(path.string(), 2 * bytes);
  const HeldMemory held(&inputs, bytes);
  return read_part(path);
}

}  // namespace

int merge(const MergeOptions& options) {
  require_film_output(options.output);
  require_distinct(std::array{options.output}, options.parts);
  const FileLock lock(options.output);
  Inputs inputs(options.max_memory_bytes);
  RenderPart sum = read_counted(options.parts.front(), inputs);
  for (std::size_t i = 1; i < options.parts.size(); ++i) {
    const RenderPart part = read_counted(options.parts[i], inputs);
    const HeldMemory held(&inputs, std::filesystem::file_size(options.parts[i]));
    abbe::merge(sum, part, options.parts[i]);
  }
  write_film(options.output, sum);
  say(fmt::format("{} from {} parts: samples {} of every pixel{}", options.output.string(),
                  options.parts.size(), to_text(sum.result.samples),
                  error_text({.frame_mean = frame_mean_error(sum.result.film)}, ", ")));
  return 0;
}

}  // namespace abbe::cli
