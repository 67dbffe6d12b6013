#include "io/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "io/atomic_file.h"
#include "io/error.h"
#include "io/exr.h"
#include "io/extension.h"
#include "io/picture_codec.h"
#include "io/png.h"
#include "io/text.h"

namespace abbe {
namespace {

/// NaN becomes 0.
std::uint8_t code_value(float x) {
  return x > 0 ? static_cast<std::uint8_t>(std::lround(255 * std::min(x, 1.0F))) : std::uint8_t{0};
}

std::uint16_t whole_number(float x) {
  if (!(x >= 0 && x <= 65535 && x == std::floor(x)))
    throw Error(ErrorCode::internal, "raw picture", "a code is not a 16-bit integer");
  return static_cast<std::uint16_t>(x);
}

template <typename Code>
std::vector<Code> interleaved(const Image& image, std::size_t channels, Code (*code)(float)) {
  std::vector<Code> values;
  values.reserve(image.pixels() * channels);
  for (std::size_t i = 0; i < image.pixels(); ++i)
    for (std::size_t c = 0; c < channels; ++c) values.push_back(code(image.channels[c].values[i]));
  return values;
}

bool is_tiff(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".tif" || extension == ".tiff";
}

bool is_exr(const std::filesystem::path& path) {
  return extension_of(path) == ".exr";
}

// Header of a picture with the first `channels` channels. Throws Error{internal} for an image without pixels.
PictureHeader described(const std::filesystem::path& path, const Image& image, std::size_t channels) {
  if (image.channels.empty() || image.pixels() == 0)
    throw Error(ErrorCode::internal, path.string(), "a picture without pixels");
  PictureHeader header{image.width, image.height, {}, image.metadata};
  for (std::size_t c = 0; c < channels; ++c) header.channels.push_back(image.channels[c].name);
  std::string lines;
  for (const auto& [key, value] : image.metadata) lines += key + ": " + value + "\n";
  if (is_tiff(path)) header.metadata["ImageDescription"] = lines;  // TIFF has no tags for other metadata.
  return header;
}

// PNG needs no module, and almost every picture is a PNG.
std::string encode(const std::filesystem::path& path, const PictureHeader& header,
                   const PictureCodes& codes) {
  return extension_of(path) == ".png" ? encode_png(path.string(), header, codes)
                                      : picture_codec().encode(path.string(), header, codes);
}

std::string display_bytes(const std::filesystem::path& path, const Image& image) {
  const std::size_t channels = image.channels.size() < 3 ? 1 : 3;
  PictureHeader header = described(path, image, channels);
  header.metadata.emplace(kColorSpace, "sRGB");
  // An untagged 8-bit TIFF means sRGB. OpenImageIO would write the tag into an Exif folder, which breaks its
  // TIFF output to memory.
  if (is_tiff(path)) header.metadata.erase(kColorSpace);
  return encode(path, header, interleaved(image, channels, code_value));
}

/// Splits `values`, which are pixel by pixel, into channels.
Image planes(const PictureHeader& header, const std::vector<float>& values) {
  Image image{static_cast<int>(header.width), static_cast<int>(header.height), {}, header.metadata};
  const std::size_t channels = header.channels.size();
  for (std::size_t c = 0; c < channels; ++c) {
    ImageChannel& channel = image.channels.emplace_back(ImageChannel{header.channels[c], {}});
    channel.values.reserve(image.pixels());
    for (std::size_t i = c; i < values.size(); i += channels) channel.values.push_back(values[i]);
  }
  return image;
}

}  // namespace

void write_picture(const std::filesystem::path& path, const Image& image) {
  write_atomically(path, display_bytes(path, image));
}

std::string encoded_picture(const std::string& extension, const Image& image) {
  return display_bytes("picture" + extension, image);
}

void write_raw_picture(const std::filesystem::path& path, const Image& image) {
  const std::size_t channels = image.channels.size();
  if (!is_tiff(path) && channels != 1 && channels != 3)
    throw Error(ErrorCode::output, path.string(),
                "this format stores one or three channels (got " + std::to_string(channels) +
                    "; a .tif stores any number)");
  PictureHeader header = described(path, image, channels);
  if (!is_tiff(path)) header.metadata[kColorSpace] = kLinear;  // An untagged PNG means sRGB.
  write_atomically(path, encode(path, header, interleaved(image, channels, whole_number)));
}

Image read_picture(const std::filesystem::path& path, Inputs* inputs) {
  require_file(path);
  PictureHeader header;
  std::vector<float> values;
  MemoryReservation reservation(inputs, 0);
  picture_codec().read(path.string(), [&](const PictureHeader& read_header) {
    header = read_header;
    const std::size_t channels = header.channels.size();
    require_image_size(path.string(), header.width, header.height, channels);
    const std::size_t floats = static_cast<std::size_t>(header.width * header.height) * channels;
    reservation.reserve(path.string(), floats * sizeof(float));
    if (inputs)
      inputs->reserve_memory(path.string(),
                             floats * sizeof(float));  // The memory of the image, which stays reserved.
    values.resize(floats);
    return values.data();
  });
  return planes(header, values);
}

Image read_image(const std::filesystem::path& path, Inputs* inputs) {
  if (!is_exr(path)) return read_picture(path, inputs);
  Image image = read_exr(path, inputs);
  image.metadata[kColorSpace] = kLinear;
  return image;
}

}  // namespace abbe
