#include "cli/convert.h"

#include <algorithm>
#include <array>
#include <system_error>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/output_files.h"
#include "description/load.h"
#include "importers/importers.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/text.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

// True if a scene in this folder names the file by a path relative to the folder.
bool is_inside_folder(const fs::path& file, const fs::path& folder) {
  return file.is_relative() ||
         (folder.is_absolute() &&
          std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end());
}

// Relative file names would refer to other files in another folder.
void require_same_folder(const ConvertOptions& options, const Inputs& inputs) {
  const auto real = [](const fs::path& folder) { return folder.empty() ? fs::path(".") : folder; };
  const fs::path folder = options.scene.parent_path();
  std::error_code ignored;
  if (fs::equivalent(real(folder), real(options.output.parent_path()), ignored)) return;
  for (const fs::path& file : inputs.files())
    if (file != options.scene && is_inside_folder(file, folder))
      throw Error(ErrorCode::usage, options.output.string(),
                  fmt::format("is in another folder than the scene, which names the file {} (allowed: the "
                              "folder {} or standard output)",
                              file.string(), real(folder).string()));
}

void write_out(const std::string& text, const ConvertOptions& options) {
  if (options.output == kStandardStream)
    fmt::print("{}", text);
  else
    write_atomically(options.output, text);
}

// Converts a scene of another renderer. File names become relative to the folder of the output.
std::string converted(const ConvertOptions& options, Inputs& inputs) {
  if (!options.overrides.empty())
    throw Error(
        ErrorCode::usage, "--set",
        "applies to scene files of Abbe only: convert the scene first, then replace values of the result");
  const bool is_file = options.output != kStandardStream;
  const fs::path folder = is_file ? options.output.parent_path() : options.scene.parent_path();
  Diagnostics diagnostics;
  return accepted(convert_scene(options.scene, {folder, options.materials}, diagnostics, &inputs),
                  diagnostics);
}

std::string canonical(const ConvertOptions& options, Inputs& inputs) {
  if (options.materials)
    throw Error(ErrorCode::usage, "--materials", "applies to scenes of other renderers only");
  Diagnostics diagnostics;
  return accepted(canonical_scene(options.scene, options.overrides, diagnostics, &inputs), diagnostics);
}

}  // namespace

int convert(const ConvertOptions& options) {
  const bool is_file = options.output != kStandardStream;
  if (is_file) {
    require_extension(options.output, {".json"});
    require_writable(options.output);
  }
  const bool is_imported = is_importable_scene(options.scene);
  Inputs inputs(options.max_memory_bytes);
  const std::string text = is_imported ? converted(options, inputs) : canonical(options, inputs);
  if (is_file) require_distinct(std::array{options.output}, inputs.files());
  if (is_file && !is_imported) require_same_folder(options, inputs);
  write_out(text, options);
  return 0;
}

}  // namespace abbe::cli
