#include "io/picture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "io/atomic_file.h"
#include "io/error.h"
#include "io/exr.h"

namespace abbe {
namespace {

/// NaN becomes 0.
std::uint8_t code_value(float x) {
  return x > 0 ? static_cast<std::uint8_t>(std::lround(255 * std::min(x, 1.0F))) : std::uint8_t{0};
}

std::uint16_t whole_number(float x) {
  if (!(x >= 0 && x <= 65535 && x == std::floor(x)))
    throw Error(ErrorCode::internal, "raw picture", "a code that is no 16-bit number");
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

/// The bytes of the file, checked to be one. Encoded in memory, since on a full disk some of the library's
/// writers say nothing and one exits.
std::string encoded(const std::filesystem::path& path, const OIIO::ImageSpec& spec, const void* pixels) {
  const auto output = OIIO::ImageOutput::create(path.string());
  if (!output) throw Error(ErrorCode::output, path.string(), OIIO::geterror());
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  if (!output->set_ioproxy(&memory) || !output->open(path.string(), spec) ||
      !output->write_image(spec.format, pixels) || !output->close())
    throw Error(ErrorCode::output, path.string(), output->geterror());

  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  const auto input = OIIO::ImageInput::open(path.string(), nullptr, &reader);
  if (!input || input->spec().width != spec.width || input->spec().height != spec.height ||
      input->spec().nchannels != spec.nchannels)
    throw Error(ErrorCode::output, path.string(),
                "the encoded picture does not read back " + OIIO::geterror());
  return {bytes.begin(), bytes.end()};
}

bool is_tiff(const std::filesystem::path& path) {
  return path.extension() == ".tif" || path.extension() == ".tiff";
}

OIIO::ImageSpec described(const std::filesystem::path& path, const Image& image, std::size_t channels,
                          const OIIO::TypeDesc& format) {
  if (image.channels.empty() || image.pixels() == 0)
    throw Error(ErrorCode::internal, path.string(), "a picture without pixels");
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(channels), format);
  std::string lines;
  for (const auto& [key, value] : image.metadata) {
    spec.attribute(key, value);
    lines += key + ": " + value + "\n";
  }
  if (is_tiff(path))
    spec.attribute("ImageDescription", lines);  // which has no names for what it does not know
  return spec;
}

std::unique_ptr<OIIO::ImageInput> open(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw Error(ErrorCode::input, path.string(), "no such regular file");
  auto input = OIIO::ImageInput::open(path.string());
  if (!input) throw Error(ErrorCode::input, path.string(), OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
    throw Error(ErrorCode::input, path.string(), "not a flat image");
  require_image_size(path.string(), spec.width, spec.height, static_cast<std::size_t>(spec.nchannels));
  return input;
}

std::string display_bytes(const std::filesystem::path& path, const Image& image) {
  const std::size_t channels = image.channels.size() < 3 ? 1 : 3;
  OIIO::ImageSpec spec = described(path, image, channels, OIIO::TypeDesc::UINT8);
  // Without a tag 8-bit TIFF means sRGB, and the tag's EXIF folder breaks the library's TIFF writing in
  // memory.
  if (!is_tiff(path)) spec.attribute("oiio:ColorSpace", "sRGB");
  return encoded(path, spec, interleaved(image, channels, code_value).data());
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
                "a file of this kind holds one plane or three (got " + std::to_string(channels) +
                    ", allowed any number in a .tif)");
  OIIO::ImageSpec spec = described(path, image, channels, OIIO::TypeDesc::UINT16);
  if (!is_tiff(path)) spec.attribute("oiio:ColorSpace", "Linear");  // without which PNG means sRGB
  write_atomically(path, encoded(path, spec, interleaved(image, channels, whole_number).data()));
}

Image read_picture(const std::filesystem::path& path, Inputs* inputs) {
  const auto input = open(path);
  const OIIO::ImageSpec spec = input->spec();
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  Image image{spec.width, spec.height, {}, {}};
  const std::size_t bytes = image.pixels() * channels * sizeof(float);
  if (inputs) inputs->take_memory(path.string(), 2 * bytes);  // pixel by pixel, then channel by channel
  std::vector<float> pixels(image.pixels() * channels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data()))
    throw Error(ErrorCode::input, path.string(), "truncated or corrupt");
  for (std::size_t c = 0; c < channels; ++c) {
    ImageChannel& channel = image.channels.emplace_back(ImageChannel{spec.channelnames[c], {}});
    channel.values.reserve(image.pixels());
    for (std::size_t i = c; i < pixels.size(); i += channels) channel.values.push_back(pixels[i]);
  }
  for (const OIIO::ParamValue& attribute : spec.extra_attribs)
    if (attribute.type() == OIIO::TypeDesc::STRING)
      image.metadata[attribute.name().string()] = attribute.get_string();
  if (inputs) inputs->give_back_memory(bytes);
  return image;
}

Image read_image(const std::filesystem::path& path, Inputs* inputs) {
  return path.extension() == ".exr" ? read_exr(path, inputs) : read_picture(path, inputs);
}

}  // namespace abbe
