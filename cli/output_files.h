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

/// Throws Error{usage} unless `path` ends in .png, .jpg or .tif, in either case.
void require_picture_extension(const std::filesystem::path& path);

/// Throws Error{usage} if any view option is set. A command calls it if it writes no picture. The message
/// names `pictures`, the options that would write one.
void require_no_view(const ViewOptions& view, std::string_view pictures);

/// Throws Error{usage} if an output is the same file as another output, an input or a table of the data
/// directory. Names, symbolic links and hard links are resolved. Empty paths are ignored.
void require_distinct(std::span<const std::filesystem::path> outputs,
                      std::span<const std::filesystem::path> inputs);

/// The outputs that can be written (`require_writable`), in their order; the others fail later without
/// affecting these. Throws the first Error{output} if there are outputs and none can be written.
[[nodiscard]] std::vector<std::filesystem::path> writable_among(
    std::span<const std::filesystem::path> outputs);

/// Calls all writers in order, even if some throw an Error. Then throws the first one; later ones are printed
/// to stderr. Other exceptions end it at once.
void write_all(std::span<const std::function<void()>> writers);

/// The existing files among `names`, without the column of "FILE.csv:COLUMN". Other names, such as those of
/// tables in the data directory, are left out.
[[nodiscard]] std::vector<std::filesystem::path> files_among(std::initializer_list<std::string> names);

}  // namespace abbe::cli
