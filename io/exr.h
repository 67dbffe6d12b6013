#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/image.h"
#include "io/inputs.h"

namespace abbe {

/// One of several images in a file.
struct ExrPart {
  std::string name;
  Image image;
};

/// Writes every channel as 32-bit float, ZIP compressed, metadata as string attributes, but numbers under the
/// names that OpenEXR defines so (EV, aperture, expTime, isoSpeed, whiteLuminance) as 32-bit float;
/// atomically, and re-read before it appears. Throws Error{output}.
void write_exr(const std::filesystem::path& path, const Image& image);
/// Writes several images of one size as the parts of one file, each under a name of its own, as `write_exr`
/// writes one. Throws Error{output}.
void write_exr(const std::filesystem::path& path, std::span<const ExrPart> parts);

/// The attribute of an image whose file tells its primaries, as an EXR does by `chromaticities`: x and y of
/// its red, green, blue and white, with blanks between them. Those of an ICC profile are adapted to D50.
inline constexpr const char* kPrimariesKey = "primaries_xy";

/// Reads a single-part scan-line or tiled EXR, all channels as float, string attributes, those numbers and
/// chromaticities (`kPrimariesKey`) as metadata. Throws Error{input} for a missing, truncated or malformed
/// file and Error{resource} for one beyond the limits of `io/image.h`, or beyond the memory that `inputs` has
/// left, told by its header.
[[nodiscard]] Image read_exr(const std::filesystem::path& path, Inputs* inputs = nullptr);
/// Reads an EXR of one part or more, which together keep within the limits that `read_exr` has for one, with
/// the same errors; a single part may have no name.
[[nodiscard]] std::vector<ExrPart> read_exr_parts(const std::filesystem::path& path,
                                                  Inputs* inputs = nullptr);

}  // namespace abbe
