#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "importers/shared/scene_importer.h"
#include "importers/shared/spectra.h"
#include "spectral/rgb.h"

namespace abbe::importers {

/// Microfacet roughness with alpha `along` the surface coordinate u and `across` it. Values outside [0, 1]
/// are clamped, which is noted. Nothing if both are then 0: the surface is smooth.
[[nodiscard]] std::optional<spec::Roughness> roughness_of(double along, double across,
                                                          FacetShape distribution,
                                                          const SourcePosition& where,
                                                          SceneImporter& importer);

/// The complex index with n = 1 and k = 2 sqrt(R/(1 - R)), whose reflectance at normal incidence is R. It is
/// formed at each wavelength, with R clamped to [0, 0.9996], and noted as a guess. Reports a temperature or a
/// shipped table.
[[nodiscard]] spec::Ior index_of_reflectance(const Spectrum& reflectance, const SourcePosition& where,
                                             SceneImporter& importer);

/// True if this material of the scene, or a component of its mixture, has an image as its reflectance, normal
/// map or bump map.
[[nodiscard]] bool is_textured(const std::string& material, const SceneImporter& importer);
/// True if this material of the scene is a dielectric or a medium, which fills closed shapes.
[[nodiscard]] bool fills_interior(const std::string& material, const SceneImporter& importer);
/// Name of a copy of the material with reflectance 0.5 in place of images and without normal or bump map. The
/// copy, and those of the components of a mixture, are added at the first call.
[[nodiscard]] std::string without_images(const std::string& material, SceneImporter& importer);

/// Replaces materials of the scene by those of the JSON file `map`, an object of materials by name. Materials
/// without a replacement stay. Reports an unreadable or invalid file, and unknown names with the nearest.
void replace_materials(const std::filesystem::path& map, SceneImporter& importer);

/// Note about images that are mirrored outside [0, 1].
inline constexpr const char* kNoMirroredImages =
    "mirrored repetition of an image is not supported: it repeats";

/// Note about height and normal maps stored as integer codes.
inline constexpr const char* kLinearRelief =
    "values of a height or normal map are taken as linear: the source renderer decodes them as sRGB";

/// True if files of that name have integer codes, sRGB-encoded unless they declare otherwise. False for .exr,
/// .hdr and .pfm, which have linear floats. Only the extension counts.
[[nodiscard]] bool holds_codes(const std::filesystem::path& file);

/// Replacement for an image that Abbe rejects because of its declared colours, in a source format that takes
/// all images as sRGB: the mean linear Rec.709 colour of the codes decoded as sRGB, which is noted. Nothing
/// for an image that Abbe accepts; if that declares another encoding than sRGB, this is noted. Nothing after
/// an error: an unreadable image, missing channels, or values that are not finite.
[[nodiscard]] std::optional<LinearRgb> colour_of_rejected_image(const std::filesystem::path& file,
                                                                const SourcePosition& where,
                                                                SceneImporter& importer);

/// Mean linear Rec.709 colour of an image, each component 0 or more. Integer codes are decoded as declared,
/// by default as sRGB; negative values count as 0. An image with Y instead of R is grey. Nothing after an
/// error: an unreadable file, missing channels, other primaries, or values that are not finite.
[[nodiscard]] std::optional<LinearRgb> mean_colour(const std::filesystem::path& file,
                                                   const SourcePosition& where, SceneImporter& importer);

}  // namespace abbe::importers
