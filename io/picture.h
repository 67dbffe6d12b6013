#pragma once

#include <filesystem>
#include <string>

#include "io/image.h"
#include "io/inputs.h"

namespace abbe {

/// Writes an 8-bit picture of the first three channels, or of the first as grey, atomically. Values are
/// display code values in [0, 1]; they are clamped and rounded, and NaN is 0. They are sRGB unless
/// `kColorSpace` declares another encoding, which only a PNG file records. The extension chooses the format
/// (.png, .jpg, .tif). Throws Error{output} if the format is unknown or the file cannot be written. Throws
/// Error{input} if the picture module, which formats other than PNG need, does not load, and Error{internal}
/// without pixels.
void write_picture(const std::filesystem::path& path, const Image& image);

/// The bytes that `write_picture` writes to a file with that extension, such as ".png". Throws as
/// `write_picture`.
[[nodiscard]] std::string encoded_picture(const std::string& extension, const Image& image);

/// Writes integers from 0 to 65535, such as the codes of a sensor, as a linear 16-bit picture: one or three
/// channels as .png, any number as .tif. Throws as `write_picture`, also Error{output} for other channel
/// counts and Error{internal} for other values.
void write_raw_picture(const std::filesystem::path& path, const Image& image);

/// Reads a picture in any format of OpenImageIO.
/// - Channels are floats; integer files are scaled to [0, 1].
/// - Pixels are in the order of the file; `kOrientation` is not applied.
/// - An alpha channel is called "A"; the others are as stored, not multiplied or divided by alpha.
/// - The values of a Radiance file are divided by the exposure and colour factors of its header.
/// - `inputs`, if not nullptr, reserves the memory of the channels, which stays reserved.
/// Throws Error{input} if the file is missing or damaged, is not a two-dimensional image, or the picture
/// module does not load. Throws Error{resource}, judging from the header, above the limits of `io/image.h` or
/// the memory left in `inputs`.
[[nodiscard]] Image read_picture(const std::filesystem::path& path, Inputs* inputs = nullptr);

/// Reads an image file: .exr by `read_exr`, other formats by `read_picture`, with their errors. `kColorSpace`
/// is "Linear" for an .exr, for a file that declares it, and for floats unless an ICC profile declares
/// otherwise.
[[nodiscard]] Image read_image(const std::filesystem::path& path, Inputs* inputs = nullptr);

/// Metadata key for the orientation of an image, the number of Exif [Exif, sec. 4.6.4]. Without it, or with
/// 1, rows run from top to bottom and columns from left to right. To display the stored pixels:
/// - 2 and 4 reflect left to right and top to bottom, 3 turns by 180 degrees;
/// - 6 and 8 turn by 90 degrees, clockwise and counter-clockwise;
/// - 5 and 7 transpose at the main and at the other diagonal.
inline constexpr const char* kOrientation = "Orientation";

/// The image as displayed: `kOrientation` is applied to all channels and removed. Pixels are unchanged if it
/// is absent or not a number from 1 to 8.
[[nodiscard]] Image apply_orientation(Image image);

}  // namespace abbe
