#pragma once

#include <filesystem>
#include <optional>

#include "importers/shared/scene_importer.h"
#include "spectral/rgb.h"

namespace abbe::importers {

// Errors go to `importer.diagnostics`; approximations and losses go to `SceneImporter::note`. Functions throw
// Error{resource} if the memory limit of `importer.inputs` is exceeded.

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
/// all images as sRGB. It is the mean linear Rec.709 colour of the codes decoded as sRGB, and is noted.
/// Returns nothing for an image that Abbe accepts; if that declares another encoding than sRGB, this is
/// noted. Reports an unreadable image, missing channels and values that are not finite at `where`, and
/// returns nothing.
[[nodiscard]] std::optional<LinearRgb> colour_of_rejected_image(const std::filesystem::path& file,
                                                                const SourcePosition& where,
                                                                SceneImporter& importer);

/// Mean linear Rec.709 colour of an image, each component 0 or more. Integer codes are decoded as declared,
/// by default as sRGB; negative values count as 0. An image with Y instead of R is grey. Reports at `where`:
/// - a missing or unreadable file;
/// - an image without channels R, G, B or Y, or with other primaries;
/// - values that are not finite.
/// Returns nothing after an error.
[[nodiscard]] std::optional<LinearRgb> mean_colour(const std::filesystem::path& file,
                                                   const SourcePosition& where, SceneImporter& importer);

}  // namespace abbe::importers
