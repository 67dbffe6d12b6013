#include "io/picture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "io/atomic_file.h"
#include "io/error.h"

namespace abbe {
namespace {

/// NaN becomes 0.
std::uint8_t code_value(float x) {
  return x > 0 ? static_cast<std::uint8_t>(std::lround(255 * std::min(x, 1.0F))) : std::uint8_t{0};
}

std::vector<std::uint8_t> interleaved(const Image& image, std::size_t channels) {
  std::vector<std::uint8_t> values;
  values.reserve(image.pixels() * channels);
  for (std::size_t i = 0; i < image.pixels(); ++i)
    for (std::size_t c = 0; c < channels; ++c) values.push_back(code_value(image.channels[c].values[i]));
  return values;
}

/// The bytes of the file, checked to be one. Encoded in memory, since on a full disk some of the library's
/// writers say nothing and one exits.
std::string encoded(const std::filesystem::path& path, const OIIO::ImageSpec& spec,
                    const std::vector<std::uint8_t>& pixels) {
  const auto output = OIIO::ImageOutput::create(path.string());
  if (!output) throw Error(ErrorCode::output, path.string(), OIIO::geterror());
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  if (!output->set_ioproxy(&memory) || !output->open(path.string(), spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) || !output->close())
    throw Error(ErrorCode::output, path.string(), output->geterror());

  OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
  const auto input = OIIO::ImageInput::open(path.string(), nullptr, &reader);
  if (!input || input->spec().width != spec.width || input->spec().height != spec.height ||
      input->spec().nchannels != spec.nchannels)
    throw Error(ErrorCode::output, path.string(),
                "the encoded picture does not read back " + OIIO::geterror());
  return {bytes.begin(), bytes.end()};
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

}  // namespace

void write_picture(const std::filesystem::path& path, const Image& image) {
  const std::size_t channels = image.channels.size() < 3 ? 1 : 3;
  if (image.channels.empty() || image.pixels() == 0)
    throw Error(ErrorCode::internal, path.string(), "a picture without pixels");
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(channels), OIIO::TypeDesc::UINT8);
  // Without a tag 8-bit TIFF means sRGB, and the tag's EXIF folder breaks the library's TIFF writing in
  // memory.
  if (path.extension() != ".tif" && path.extension() != ".tiff") spec.attribute("oiio:ColorSpace", "sRGB");
  for (const auto& [key, value] : image.metadata) spec.attribute(key, value);
  write_atomically(path, encoded(path, spec, interleaved(image, channels)));
}

Image read_picture(const std::filesystem::path& path) {
  const auto input = open(path);
  const OIIO::ImageSpec spec = input->spec();
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  Image image{spec.width, spec.height, {}, {}};
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
  return image;
}

}  // namespace abbe
