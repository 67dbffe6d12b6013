#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/output/display.h"

namespace abbe::cli {

/// Checks in advance that a film can be written to `path`, an `.exr` or an `.abbepart`. Throws Error{usage}
/// for another extension and Error{output} if the file cannot be written.
void require_film_output(const std::filesystem::path& path);

/// Throws Error{usage} unless `path` ends in .png, .jpg or .tif.
void require_picture_extension(const std::filesystem::path& path);

/// Throws Error{usage} if a view is requested but no picture uses it. `pictures` names the options that write
/// pictures.
void require_no_view(const ViewOptions& view, std::string_view pictures);

/// Throws Error{usage} if an output is the same file as another output, an input or a table of the data
/// directory. Names, symbolic links and hard links are resolved. Empty paths are ignored.
void require_distinct(std::span<const std::filesystem::path> outputs,
                      std::span<const std::filesystem::path> inputs);

/// The outputs that can be written; the others fail later without affecting these. Throws the first
/// Error{output} if there are outputs and none can be written.
[[nodiscard]] std::vector<std::filesystem::path> writable_among(
    std::span<const std::filesystem::path> outputs);

/// Calls all writers, even if one fails, and then throws the first error.
void write_all(std::span<const std::function<void()>> writers);

/// The files among `names`, which may also be names of tables: "FILE" or "FILE.csv:COLUMN".
[[nodiscard]] std::vector<std::filesystem::path> files_among(std::initializer_list<std::string> names);

}  // namespace abbe::cli
