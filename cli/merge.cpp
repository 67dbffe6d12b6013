#include "cli/merge.h"

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/film_output.h"
#include "io/file_lock.h"

namespace abbe::cli {

int merge(const MergeOptions& options) {
  require_film_output(options.output);
  const FileLock lock(options.output);
  RenderPart sum = read_part(options.parts.front());
  for (std::size_t i = 1; i < options.parts.size(); ++i)
    abbe::merge(sum, read_part(options.parts[i]), options.parts[i]);
  write_film(options.output, sum);
  say(fmt::format("{} from {} parts: samples {} of every pixel", options.output.string(),
                  options.parts.size(), to_text(sum.result.samples)));
  return 0;
}

}  // namespace abbe::cli
