#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "description/importers/shared/scene_importer.h"
#include "description/importers/shared/spectra.h"

namespace abbe::importers {

/// Microfacet widths along u and v, clamped to [0, 1], which is noted. Nothing if both are 0: the surface is
/// smooth.
[[nodiscard]] std::optional<spec::Roughness> roughness_of(double along, double across,
                                                          FacetShape distribution,
                                                          const SourcePosition& where,
                                                          SceneImporter& importer);

/// The complex index with n = 1 and k = 2 sqrt(R/(1 - R)), whose reflectance at normal incidence is R.
/// Reports spectra of lights.
[[nodiscard]] spec::Ior index_of_reflectance(const Spectrum& reflectance, const SourcePosition& where,
                                             SceneImporter& importer);

/// True if a material of the scene, or a component of its mixture, has an image.
[[nodiscard]] bool is_textured(const std::string& material, const SceneImporter& importer);
/// True if a material of the scene is a dielectric or a medium, which fills closed shapes.
[[nodiscard]] bool fills_interior(const std::string& material, const SceneImporter& importer);
/// Name of a copy of the material with reflectance 0.5 in place of images. The copy is added at the first
/// call.
[[nodiscard]] std::string without_images(const std::string& material, SceneImporter& importer);

/// Replaces materials of the scene by those of a JSON file, an object of materials by name. Reports an
/// invalid file, and unknown names with the nearest.
void replace_materials(const std::filesystem::path& map, SceneImporter& importer);

}  // namespace abbe::importers
