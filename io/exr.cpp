#include "io/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cstring>

#include "io/atomic_file.h"
#include "io/error.h"

namespace abbe {
namespace {

Imf::Header header_of(const Image& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const ImageChannel& channel : image.channels) {
    if (channel.values.size() != image.pixels() || header.channels().findChannel(channel.name))
      throw Error(ErrorCode::internal, channel.name, "channel of a wrong size or a repeated name");
    header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
  }
  for (const auto& [key, value] : image.metadata) header.insert(key, Imf::StringAttribute(value));
  return header;
}

Imf::FrameBuffer frame_buffer(const Image& image, const Imath::Box2i& window) {
  Imf::FrameBuffer buffer;
  for (const ImageChannel& channel : image.channels)
    buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), window));
  return buffer;
}

/// Compares bytes, not values: a NaN must survive, and -0 is not 0.
bool same_bits(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.metadata == b.metadata &&
         a.channels.size() == b.channels.size() &&
         std::all_of(a.channels.begin(), a.channels.end(), [&b](const ImageChannel& channel) {
           const ImageChannel* other = b.find(channel.name);
           const std::size_t bytes = channel.values.size() * sizeof(float);
           return other && std::memcmp(channel.values.data(), other->values.data(), bytes) == 0;
         });
}

/// The image a header announces, its channels still empty.
Image announced(const Imf::Header& header, const std::string& name) {
  const Imath::Box2i& window = header.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  Image image{static_cast<int>(width), static_cast<int>(height), {}, {}};
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
      throw Error(ErrorCode::input, name, std::string("channel \"") + channel.name() + "\" is subsampled");
    image.channels.push_back({channel.name(), {}});
  }
  require_image_size(name, width, height, image.channels.size());
  for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
    const bool structural = std::string_view(attribute.name()) == "type";  // the library adds it on reading
    if (text && !structural) image.metadata[attribute.name()] = text->value();
  }
  return image;
}

Image read(const std::filesystem::path& path) {
  const std::string name = path.string();
  if (!std::filesystem::is_regular_file(path)) throw Error(ErrorCode::input, name, "no such regular file");
  Imf::MultiPartInputFile file(name.c_str());
  if (file.parts() != 1)
    throw Error(ErrorCode::input, name, "has " + std::to_string(file.parts()) + " parts (allowed 1)");
  const Imf::Header& header = file.header(0);
  Image image = announced(header, name);
  if (!file.partComplete(0)) throw Error(ErrorCode::input, name, "truncated");
  for (ImageChannel& channel : image.channels) channel.values.resize(image.pixels());
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(frame_buffer(image, header.dataWindow()));
  part.readPixels(header.dataWindow().min.y, header.dataWindow().max.y);
  return image;
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Image& image) {
  write_atomically(
      path,
      [&image](const std::filesystem::path& temporary) {
        const Imf::Header header = header_of(image);
        Imf::OutputFile file(temporary.c_str(), header);
        file.setFrameBuffer(frame_buffer(image, header.dataWindow()));
        file.writePixels(image.height);
      },
      [&image](const std::filesystem::path& temporary) { return same_bits(image, read_exr(temporary)); });
}

Image read_exr(const std::filesystem::path& path) {
  try {
    return read(path);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorCode::input, path.string(), error.what());
  }
}

}  // namespace abbe
