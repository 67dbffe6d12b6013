#pragma once

#include <filesystem>
#include <initializer_list>
#include <span>

#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe::cli {

/// Of the files that hold exact sums.
inline constexpr const char* kPartExtension = ".abbepart";

/// What tells the film of this scene from any other, from its scene file's name to its crop.
[[nodiscard]] FilmIdentity identity_of(const Scene& scene, const std::filesystem::path& scene_file,
                                       const abbe::RenderOptions& how);

/// Throws Error{usage} unless the extension is one of the allowed, as ".exr".
void require_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed);

/// Throws Error{usage} when two of the files are one, by whatever names; empty ones are none.
void require_distinct(std::span<const std::filesystem::path> files);

/// Checks before any work that a film can be written to `path`, an `.exr` or an `.abbepart`: throws
/// Error{usage} for another extension, Error{output} for a place that cannot be written.
void require_film_output(const std::filesystem::path& path);

/// Writes the exact sums to an `.abbepart`, the film's image to anything else. Throws Error{output}.
void write_film(const std::filesystem::path& path, const RenderPart& part);

}  // namespace abbe::cli
