#pragma once

#include <cstddef>
#include <filesystem>

#include "scene/scene.h"
#include "transport/render/part.h"

namespace abbe {

/// Extension of files that hold exact sums.
inline constexpr const char* kPartExtension = ".abbepart";

/// Attributes of a film of the scene rendered with these options: version, build, scene, data, seed,
/// integrator, sensor, crop, layers and features. The path `scene_file` contributes its file name only.
[[nodiscard]] FilmIdentity identity_of(const Scene& scene, const std::filesystem::path& scene_file,
                                       const RenderOptions& options);

/// Memory [bytes] of the exact sums of the scene's film, with those of layers and features.
[[nodiscard]] std::size_t film_bytes(const Scene& scene, const RenderOptions& options = {});

/// Writes the exact sums if the extension is `.abbepart`, else the film's image as an EXR file
/// (`film_image`). Throws Error{output}.
void write_film(const std::filesystem::path& path, const RenderPart& part);

}  // namespace abbe
