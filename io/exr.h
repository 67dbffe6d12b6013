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
  std::string name;
  Image image;
};

/// Writes an EXR file with ZIP compression, atomically and read back before it appears. Channels are 32-bit
/// floats. Metadata are string attributes, except EV, aperture, expTime, isoSpeed and whiteLuminance, which
/// OpenEXR defines as floats. Throws Error{output}.
void write_exr(const std::filesystem::path& path, const Image& image);
/// Writes several images of equal size as named parts of one file. Throws Error{output}.
void write_exr(const std::filesystem::path& path, std::span<const ExrPart> parts);

/// Metadata key for the primaries of an image: "xr yr xg yg xb yb xw yw" of red, green, blue and white. An
/// EXR file declares them as `chromaticities`. Primaries from an ICC profile are adapted to D50.
inline constexpr const char* kPrimariesKey = "primaries_xy";

/// Reads a single-part scan-line or tiled EXR. Channels become floats; string attributes, the numbers listed
/// at `write_exr` and `chromaticities` (as `kPrimariesKey`) become metadata. Throws Error{input} for a
/// missing, truncated or malformed file. Throws Error{resource}, judging from the header, if the image
/// exceeds the limits of `io/image.h` or the memory left in `inputs`.
[[nodiscard]] Image read_exr(const std::filesystem::path& path, Inputs* inputs = nullptr);
/// Reads all parts of an EXR file. The limits and errors of `read_exr` apply to the parts together. A single
/// part may be unnamed.
[[nodiscard]] std::vector<ExrPart> read_exr_parts(const std::filesystem::path& path,
                                                  Inputs* inputs = nullptr);

}  // namespace abbe
