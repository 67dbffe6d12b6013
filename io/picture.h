#pragma once

#include <filesystem>
#include <string>

#include "io/image.h"
#include "io/inputs.h"

namespace abbe {

/// Writes the first three channels (or the only one, as grey) as an 8-bit file: values are display code
/// values in [0, 1], clamped and rounded, encoded as the attribute `kColorSpace` says, as sRGB without it.
/// The format follows the extension (.png, .jpg, .tif); of encodings and primaries other than those of sRGB a
/// PNG alone tells. Atomic; throws Error{output}.
void write_picture(const std::filesystem::path& path, const Image& image);

/// The bytes `write_picture` would write to a file of that extension, as ".png". Throws Error{output}.
[[nodiscard]] std::string encoded_picture(const std::string& extension, const Image& image);

/// Writes whole numbers from 0 to 65535, such as the codes of a sensor, as a linear 16-bit file: one channel
/// or three as .png, any number as .tif. Throws Error{output}, Error{internal} for other values.
void write_raw_picture(const std::filesystem::path& path, const Image& image);

/// Reads any format OpenImageIO knows, as float channels scaled to [0, 1] for integer files. Pixels stand as
/// in the file, whatever its `kOrientation`; an alpha channel is "A", and the others are as stored beside it.
/// The factors are taken off that a Radiance file says it was multiplied by. Throws Error{input}, or
/// Error{resource} for one beyond the limits of `io/image.h` or beyond the memory that `inputs` has left,
/// told by its header.
[[nodiscard]] Image read_picture(const std::filesystem::path& path, Inputs* inputs = nullptr);

/// Any image file: .exr by `read_exr`, others by `read_picture`. Its attribute `kColorSpace` is "Linear"
/// where the file says so, or holds floats of which an ICC profile does not say otherwise.
[[nodiscard]] Image read_image(const std::filesystem::path& path, Inputs* inputs = nullptr);

}  // namespace abbe
