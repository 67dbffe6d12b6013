#include "cli/convert.h"

#include <algorithm>
#include <array>
#include <system_error>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/output_files.h"
#include "description/convert.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/extension.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

// Whether a scene of that folder names the file by where it is from there.
bool is_beside(const fs::path& file, const fs::path& folder) {
  return file.is_relative() ||
         (folder.is_absolute() &&
          std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end());
}

// What is written into another folder than the scene's would look there for the files it names.
void require_same_folder(const ConvertOptions& options, const Inputs& inputs) {
  const auto real = [](const fs::path& folder) { return folder.empty() ? fs::path(".") : folder; };
  const fs::path folder = options.scene.parent_path();
  std::error_code ignored;
  if (fs::equivalent(real(folder), real(options.output.parent_path()), ignored)) return;
  for (const fs::path& file : inputs.files())
    if (file != options.scene && is_beside(file, folder))
      throw Error(
          ErrorCode::usage, options.output.string(),
          fmt::format("is in another folder than the scene, which names {}: allowed {} or standard output",
                      file.string(), real(folder).string()));
}

}  // namespace

int convert(const ConvertOptions& options) {
  const bool is_file = options.output != kStandardStream;
  if (is_file) {
    require_extension(options.output, {".json"});
    require_writable(options.output);
  }
  Diagnostics diagnostics;
  Inputs inputs(options.max_memory_bytes);
  const std::string text =
      accepted(canonical_scene(options.scene, options.overrides, diagnostics, &inputs), diagnostics);
  if (!is_file) {
    fmt::print("{}", text);
    return 0;
  }
  require_distinct(std::array{options.output}, inputs.files());
  require_same_folder(options, inputs);
  write_atomically(options.output, text);
  return 0;
}

}  // namespace abbe::cli
