#pragma once

#include <filesystem>
#include <optional>

#include "description/importers/shared/scene_importer.h"
#include "spectral/rgb.h"

namespace abbe::importers {

/// Note about images that are mirrored outside [0, 1].
inline constexpr const char* kNoMirroredImages =
    "mirrored repetition of an image is not supported: it repeats";

/// Note about height and normal maps stored as integer codes.
inline constexpr const char* kLinearRelief =
    "values of a height or normal map are taken as linear: the source renderer decodes them as sRGB";

/// True if files of that name have integer codes, sRGB-encoded unless they declare otherwise; false if they
/// have linear floats.
[[nodiscard]] bool holds_codes(const std::filesystem::path& file);

/// Replacement for an image that Abbe rejects because of its declared colours, where the source format takes
/// all images as sRGB: its mean as sRGB, which is noted. Nothing for other images; a declared encoding other
/// than sRGB is noted. Reports an unreadable image at `where`.
[[nodiscard]] std::optional<LinearRgb> colour_of_rejected_image(const std::filesystem::path& file,
                                                                const SourcePosition& where,
                                                                SceneImporter& importer);

/// Mean linear Rec.709 colour of an image. Integer codes are decoded as declared, by default as sRGB;
/// negative values count as 0. Reports at `where`, and returns nothing for, a missing or unreadable file, one
/// without channels R, G, B or Y, other primaries, and values that are not finite.
[[nodiscard]] std::optional<LinearRgb> mean_colour(const std::filesystem::path& file,
                                                   const SourcePosition& where, SceneImporter& importer);

}  // namespace abbe::importers
