#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/image.h"
#include "io/inputs.h"

namespace abbe {

/// One part of a multi-part EXR file.
struct ExrPart {
  std::string name;  ///< Unique in the file; may be "" for the only part.
  Image image;
};

/// Writes an EXR file with ZIP compression and 32-bit floats, atomically. Metadata are string attributes,
/// except EV, aperture, expTime, isoSpeed and whiteLuminance: OpenEXR defines these as floats, and texts that
/// are numbers are stored so. Throws Error{output} if the file cannot be written or read back, and
/// Error{resource} above the limits of `io/image.h`. Throws Error{internal} for a repeated channel name or a
/// channel of another size than its image.
void write_exr(const std::filesystem::path& path, const Image& image);
/// Writes several images of equal size as named parts of one file. Throws as above.
void write_exr(const std::filesystem::path& path, std::span<const ExrPart> parts);

/// Metadata key for the primaries of an image: "xr yr xg yg xb yb xw yw" of red, green, blue and white. An
/// EXR file declares them as `chromaticities`. Primaries from an ICC profile are adapted to D50.
inline constexpr const char* kPrimariesKey = "primaries_xy";

/// Reads a single-part EXR. The image is the display window; pixels outside the data window are 0. Channels
/// are in alphabetical order. Metadata are the string attributes, the numbers listed at `write_exr`, and
/// `chromaticities` as `kPrimariesKey`. `inputs`, if not nullptr, reserves the memory of the channels, which
/// stays reserved. Throws Error{input} for a missing, truncated or malformed file, several parts, or
/// subsampled channels. Throws Error{resource}, judging from the header, above the limits of `io/image.h` or
/// the memory left in `inputs`.
[[nodiscard]] Image read_exr(const std::filesystem::path& path, Inputs* inputs = nullptr);
/// Reads all parts of an EXR file, in its order. The limits and errors of `read_exr` apply to the parts
/// together.
[[nodiscard]] std::vector<ExrPart> read_exr_parts(const std::filesystem::path& path,
                                                  Inputs* inputs = nullptr);

}  // namespace abbe
