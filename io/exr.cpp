#include "io/exr.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string_view>
#include <utility>

#include "io/atomic_file.h"
#include "io/error.h"
#include "io/text.h"

namespace abbe {
namespace {

// Attributes that OpenEXR defines as numbers.
bool is_number(std::string_view key) {
  constexpr std::array kNumbers{"EV", "aperture", "expTime", "isoSpeed", "whiteLuminance"};
  return std::find(kNumbers.begin(), kNumbers.end(), key) != kNumbers.end();
}

std::string number_text(float number) {
  return fmt::format("{}", number);
}

// The value as it reads back: numbers are rounded to float.
std::string stored_text(const std::string& key, const std::string& value) {
  const auto number = is_number(key) ? parse_number(value) : std::nullopt;
  return number ? number_text(static_cast<float>(*number)) : value;
}

// Header of a part. Throws Error{internal} for a channel of a wrong size or a repeated name.
Imf::Header header_of(const ExrPart& part) {
  const Image& image = part.image;
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.setType(Imf::SCANLINEIMAGE);
  if (!part.name.empty()) header.setName(part.name);
  for (const ImageChannel& channel : image.channels) {
    if (channel.values.size() != image.pixels() || header.channels().findChannel(channel.name))
      throw Error(ErrorCode::internal, channel.name, "channel of a wrong size or a repeated name");
    header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
  }
  for (const auto& [key, value] : image.metadata) {
    const auto number = is_number(key) ? parse_number(value) : std::nullopt;
    if (number)
      header.insert(key, Imf::FloatAttribute(static_cast<float>(*number)));
    else
      header.insert(key, Imf::StringAttribute(value));
  }
  return header;
}

Imf::FrameBuffer frame_buffer(const Image& image, const Imath::Box2i& window) {
  Imf::FrameBuffer buffer;
  for (const ImageChannel& channel : image.channels)
    buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), window));
  return buffer;
}

/// Compares bytes, not values: a NaN must survive, and -0 differs from 0.
bool same_bits(const ExrPart& written, const ExrPart& read) {
  const Image& a = written.image;
  const Image& b = read.image;
  std::map<std::string, std::string> stored;
  for (const auto& [key, value] : a.metadata) stored[key] = stored_text(key, value);
  std::map<std::string_view, const ImageChannel*> by_name;  // There may be thousands of layers.
  for (const ImageChannel& channel : b.channels) by_name[channel.name] = &channel;
  return written.name == read.name && a.width == b.width && a.height == b.height && stored == b.metadata &&
         a.channels.size() == b.channels.size() &&
         std::all_of(a.channels.begin(), a.channels.end(), [&](const ImageChannel& channel) {
           const auto other = by_name.find(channel.name);
           const std::size_t bytes = channel.values.size() * sizeof(float);
           return other != by_name.end() &&
                  std::memcmp(channel.values.data(), other->second->values.data(), bytes) == 0;
         });
}

/// Image of the size of `window` with the channels and metadata of a header; its channels are empty.
Image announced(const Imf::Header& header, const Imath::Box2i& window, const std::string& name) {
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
    const std::string key = attribute.name();
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
    const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&attribute.attribute());
    // `type` and `name` describe the layout of the file; they are no metadata.
    if (text && key != "type" && key != "name") image.metadata[key] = text->value();
    if (number && is_number(key)) image.metadata[key] = number_text(number->value());
  }
  if (Imf::hasChromaticities(header)) {
    const auto& [red, green, blue, white] = Imf::chromaticities(header);
    image.metadata[kPrimariesKey] = fmt::format("{} {} {} {} {} {} {} {}", red.x, red.y, green.x, green.y,
                                                blue.x, blue.y, white.x, white.y);
  }
  return image;
}

/// Copies the pixels of the data window into `picture`, which has the size of the display window. Pixels
/// outside the data window are 0.
Image displayed(const Image& stored, const Imath::Box2i& data, Image picture, const Imath::Box2i& display) {
  const Imath::Box2i both(
      Imath::V2i(std::max(data.min.x, display.min.x), std::max(data.min.y, display.min.y)),
      Imath::V2i(std::min(data.max.x, display.max.x), std::min(data.max.y, display.max.y)));
  const auto number = [](int width, const Imath::V2i& at) {
    return static_cast<std::ptrdiff_t>(at.y) * width + at.x;
  };
  for (std::size_t c = 0; c < picture.channels.size(); ++c) {
    std::vector<float>& values = picture.channels[c].values;
    values.assign(picture.pixels(), 0.0F);
    for (int y = both.min.y; both.min.x <= both.max.x && y <= both.max.y; ++y)
      std::copy_n(
          stored.channels[c].values.begin() + number(stored.width, Imath::V2i(both.min.x, y) - data.min),
          both.max.x - both.min.x + 1,
          values.begin() + number(picture.width, Imath::V2i(both.min.x, y) - display.min));
  }
  return picture;
}

Image pixels_of(Imf::MultiPartInputFile& file, int number, const std::string& name) {
  const Imf::Header& header = file.header(number);
  const Imath::Box2i& window = header.dataWindow();
  Image image = announced(header, window, name);
  for (ImageChannel& channel : image.channels) channel.values.resize(image.pixels());
  Imf::InputPart part(file, number);
  part.setFrameBuffer(frame_buffer(image, window));
  part.readPixels(window.min.y, window.max.y);
  if (window == header.displayWindow()) return image;
  return displayed(image, window, announced(header, header.displayWindow(), name), header.displayWindow());
}

// Reads all parts. Sizes are checked and memory is reserved before pixels are allocated.
std::vector<ExrPart> read(const std::filesystem::path& path, Inputs* inputs) {
  const std::string name = path.string();
  require_file(path);
  Imf::MultiPartInputFile file(name.c_str());
  std::size_t bytes = 0;
  for (int i = 0; i < file.parts(); ++i) {
    const Imf::Header& header = file.header(i);
    bytes += announced(header, header.dataWindow(), name).memory_bytes();
    if (header.dataWindow() != header.displayWindow())
      bytes += announced(header, header.displayWindow(), name).memory_bytes();
    if (bytes > kMaxImageBytes)
      throw Error(ErrorCode::resource, name,
                  fmt::format("image too large (got {} parts of more than {} bytes in all)", file.parts(),
                              kMaxImageBytes));
  }
  if (inputs) inputs->reserve_memory(name, bytes);
  std::vector<ExrPart> parts;
  for (int i = 0; i < file.parts(); ++i) {
    if (!file.partComplete(i)) throw Error(ErrorCode::input, name, "truncated");
    parts.push_back({file.header(i).hasName() ? file.header(i).name() : "", pixels_of(file, i, name)});
  }
  return parts;
}

void write(const std::filesystem::path& path, std::span<const ExrPart> parts) {
  std::vector<Imf::Header> headers;
  for (const ExrPart& part : parts) headers.push_back(header_of(part));
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Imf::OutputPart output(file, static_cast<int>(i));
    output.setFrameBuffer(frame_buffer(parts[i].image, headers[i].dataWindow()));
    output.writePixels(parts[i].image.height);
  }
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Image& image) {
  const ExrPart part{"", image};
  write_exr(path, std::span(&part, 1));
}

void write_exr(const std::filesystem::path& path, std::span<const ExrPart> parts) {
  write_atomically(
      path, [parts](const std::filesystem::path& temporary) { write(temporary, parts); },
      [parts](const std::filesystem::path& temporary) {
        const std::vector<ExrPart> read = read_exr_parts(temporary);
        return std::equal(parts.begin(), parts.end(), read.begin(), read.end(), same_bits);
      });
}

std::vector<ExrPart> read_exr_parts(const std::filesystem::path& path, Inputs* inputs) {
  try {
    return read(path, inputs);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorCode::input, path.string(), error.what());
  }
}

Image read_exr(const std::filesystem::path& path, Inputs* inputs) {
  std::vector<ExrPart> parts = read_exr_parts(path, inputs);
  if (parts.size() != 1)
    throw Error(ErrorCode::input, path.string(), fmt::format("has {} parts (allowed 1)", parts.size()));
  return std::move(parts.front().image);
}

}  // namespace abbe
