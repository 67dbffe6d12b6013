#pragma once

#include <cstddef>
#include <filesystem>

#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe {

/// The extension of files that hold exact sums.
inline constexpr const char* kPartExtension = ".abbepart";

/// What tells the film of this scene from any other, from its scene file's name to its crop.
[[nodiscard]] FilmIdentity identity_of(const Scene& scene, const std::filesystem::path& scene_file,
                                       const RenderOptions& how);

/// Memory that the exact sums of the scene's film take.
[[nodiscard]] std::size_t film_bytes(const Scene& scene, const RenderOptions& how = {});

/// Writes the exact sums to an `.abbepart`, the film's image to anything else. Throws Error{output}.
void write_film(const std::filesystem::path& path, const RenderPart& part);

}  // namespace abbe
