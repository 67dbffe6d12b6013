#pragma once

#include <cstddef>
#include <filesystem>

#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe {

/// Extension of files that hold exact sums.
inline constexpr const char* kPartExtension = ".abbepart";

/// Attributes that distinguish the film of this scene from any other, from the name of its scene file to its
/// crop.
[[nodiscard]] FilmIdentity identity_of(const Scene& scene, const std::filesystem::path& scene_file,
                                       const RenderOptions& options);

/// Memory [bytes] of the exact sums of the scene's film.
[[nodiscard]] std::size_t film_bytes(const Scene& scene, const RenderOptions& options = {});

/// Writes the exact sums if the extension is `.abbepart`, else the film's image. Throws Error{output}.
void write_film(const std::filesystem::path& path, const RenderPart& part);

}  // namespace abbe
