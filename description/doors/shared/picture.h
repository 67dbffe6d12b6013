#pragma once

#include <filesystem>
#include <optional>

#include "description/doors/shared/door.h"
#include "spectral/rgb.h"

namespace abbe::doors {

/// What is noted of an image that is mirrored beyond its edges.
inline constexpr const char* kNoMirroredImages = "an image is not mirrored beyond its edges here: it repeats";

/// What is noted of heights and normals in codes.
inline constexpr const char* kLinearRelief =
    "the values of a relief are linear here, and decoded as sRGB there";

/// Whether files of that name hold codes of 8 or 16 bits, sRGB-encoded unless told otherwise; others hold
/// linear values.
[[nodiscard]] bool holds_codes(const std::filesystem::path& file);

/// The colour that stands for an image whose own words of its colours make it an error here, where the other
/// format takes the codes of all images for sRGB: its mean as sRGB, which is noted. Nothing for any other
/// image; one that is decoded otherwise by its words is noted. Reports, at `where`, a file that is no image.
[[nodiscard]] std::optional<LinearRgb> colour_for_refused(const std::filesystem::path& file,
                                                          const SourcePosition& where, Door& door);

/// The mean linear Rec.709 colour of an image's pixels, those of files with 8 or 16 bits decoded as these
/// say, or as sRGB, and negative values taken as 0. Reports, at `where`, a file that is missing or no image,
/// one without channels R, G, B or Y or of other primaries, and values that are not finite.
[[nodiscard]] std::optional<LinearRgb> mean_colour(const std::filesystem::path& file,
                                                   const SourcePosition& where, Door& door);

}  // namespace abbe::doors
