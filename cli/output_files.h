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

/// Checks before any work that a film can be written to `path`, an `.exr` or an `.abbepart`: throws
/// Error{usage} for another extension, Error{output} for a place that cannot be written.
void require_film_output(const std::filesystem::path& path);

/// The same for pictures that displays show.
void require_picture_extension(const std::filesystem::path& path);

/// Throws Error{usage} for a view that is asked for where nothing is shown by it; `pictures` names the
/// options that show something.
void require_no_view(const ViewOptions& view, std::string_view pictures);

/// Throws Error{usage} for an output that is the same file as another output, as an input or as a table of
/// the data directory, by whatever name or link, hard ones too; empty paths are none.
void require_distinct(std::span<const std::filesystem::path> outputs,
                      std::span<const std::filesystem::path> inputs);

/// The outputs that can be written; the others fail when their turn comes, which is no reason to lose these.
/// Throws the first failure, Error{output}, where there are outputs and none can be written.
[[nodiscard]] std::vector<std::filesystem::path> writable_among(
    std::span<const std::filesystem::path> outputs);

/// Calls them all, since one that fails is no reason to lose the others; throws the first failure in the end.
void write_all(std::span<const std::function<void()>> writers);

/// The files among `names`, which may also be names of tables: "FILE", or "FILE.csv:COLUMN".
[[nodiscard]] std::vector<std::filesystem::path> files_among(std::initializer_list<std::string> names);

}  // namespace abbe::cli
