#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "description/doors/shared/door.h"
#include "description/doors/shared/spectra.h"

namespace abbe::doors {

/// Widths of slopes along and across, cut to [0, 1], which is noted; nothing where both are so small that the
/// surface is smooth.
[[nodiscard]] std::optional<spec::Roughness> roughness_of(double along, double across,
                                                          FacetShape distribution,
                                                          const SourcePosition& where, Door& door);

/// The index with n = 1 whose reflectance R along the normal is that: k = 2 sqrt(R/(1 - R)). Reports the
/// spectrum of a lamp.
[[nodiscard]] spec::Ior index_for(const Spectrum& reflectance, const SourcePosition& where, Door& door);

/// Whether a material of the scene, or a part of its mixture, varies over surfaces by an image.
[[nodiscard]] bool is_textured(const std::string& material, const Door& door);
/// Whether a material of the scene is matter, which fills shapes.
[[nodiscard]] bool is_matter(const std::string& material, const Door& door);
/// The name of the same material with a reflectance of 0.5 in place of images, which is added once.
[[nodiscard]] std::string without_images(const std::string& material, Door& door);

/// Replaces materials of the scene by those of a file, an object of materials by name. Reports a file that is
/// no such object, and names that the scene has not, with the nearest.
void replace_materials(const std::filesystem::path& map, Door& door);

}  // namespace abbe::doors
