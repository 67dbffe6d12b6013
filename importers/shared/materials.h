#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "importers/shared/scene_importer.h"
#include "importers/shared/spectra.h"

namespace abbe::importers {

// Errors go to `importer.diagnostics`; approximations and losses go to `SceneImporter::note`. Functions throw
// Error{resource} if the memory limit of `importer.inputs` is exceeded.
/// Microfacet roughness with alpha `along` the surface coordinate u and `across` it. Values outside [0, 1]
/// are clamped, which is noted. Nothing if both are then 0: the surface is smooth.
[[nodiscard]] std::optional<spec::Roughness> roughness_of(double along, double across,
                                                          FacetShape distribution,
                                                          const SourcePosition& where,
                                                          SceneImporter& importer);

/// The complex index with n = 1 and k = 2 sqrt(R/(1 - R)), whose reflectance at normal incidence is R. It is
/// formed at each wavelength of `reflectance`, with R clamped to [0, 0.9996]. Always notes that the index is
/// a guess. Reports a temperature or a shipped table.
[[nodiscard]] spec::Ior index_of_reflectance(const Spectrum& reflectance, const SourcePosition& where,
                                             SceneImporter& importer);

/// True if this material of the scene, or a component of its mixture, has an image as its reflectance, normal
/// map or bump map. False for an unknown name.
[[nodiscard]] bool is_textured(const std::string& material, const SceneImporter& importer);
/// True if this material of the scene is a dielectric or a medium, which fills closed shapes. False for an
/// unknown name.
[[nodiscard]] bool fills_interior(const std::string& material, const SceneImporter& importer);
/// Name of a copy of the material with reflectance 0.5 in place of images and without normal or bump map. The
/// copy, and those of the components of a mixture, are added at the first call. Adds nothing for an unknown
/// name.
[[nodiscard]] std::string without_images(const std::string& material, SceneImporter& importer);

/// Replaces materials of the scene by those of the JSON file `map`, an object of materials by name. Materials
/// without a replacement stay. Reports an unreadable or invalid file, and unknown names with the nearest.
void replace_materials(const std::filesystem::path& map, SceneImporter& importer);

}  // namespace abbe::importers
