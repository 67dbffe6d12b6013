#include "calibration/chart/raw_scale.h"

#include <bit>
#include <cmath>

#include <nlohmann/json.hpp>

#include "io/picture.h"
#include "io/raw_picture.h"
#include "io/text.h"

namespace abbe {
namespace {

constexpr double kSixteenBits = 65535;

// An attribute; a TIFF has them as lines of its description.
std::optional<std::string> attribute(const Image& image, const std::string& key) {
  if (const auto found = image.metadata.find(key); found != image.metadata.end()) return found->second;
  const auto lines = image.metadata.find("ImageDescription");
  if (lines == image.metadata.end()) return std::nullopt;
  for (const std::string& line : split(lines->second, '\n'))
    if (line.starts_with(key + ": ")) return line.substr(key.size() + 2);
  return std::nullopt;
}

std::optional<double> number(const Image& image, const std::string& key) {
  const auto text = attribute(image, key);
  return text ? parse_number(*text) : std::nullopt;
}

Image codes_of(const RawPicture& raw) {
  Image image{static_cast<int>(raw.width), static_cast<int>(raw.height), {}, raw.metadata};
  const auto share = static_cast<float>(1 / kSixteenBits);  // with which OpenImageIO rounds alike
  const std::size_t planes = raw.planes.size();
  for (std::size_t k = 0; k < planes; ++k) {
    ImageChannel& plane = image.channels.emplace_back(ImageChannel{raw.planes[k], {}});
    plane.values.reserve(image.pixels());
    for (std::size_t i = k; i < raw.codes.size(); i += planes)
      plane.values.push_back(static_cast<float>(raw.codes[i]) * share);
  }
  return image;
}

// By the tags or keywords that every program writes.
RawScale scale_of(const RawPicture& raw) {
  RawScale scale;
  scale.bits = std::bit_width(static_cast<unsigned>(raw.white_level_dn));
  scale.offset_dn = raw.black_level_dn;
  scale.saturation_dn = raw.white_level_dn;
  scale.exposure_s = raw.exposure_s;
  if (raw.mosaic_width == 0) return scale;
  scale.channels = raw.channels;
  scale.mosaic = Mosaic{static_cast<int>(raw.mosaic_width),
                        static_cast<int>(raw.mosaic.size()) / static_cast<int>(raw.mosaic_width),
                        {raw.mosaic.begin(), raw.mosaic.end()}};
  return scale;
}

}  // namespace

std::optional<RawScale> raw_scale(const Image& image) {
  const auto sensor = attribute(image, "sensor");
  const auto told = nlohmann::json::parse(sensor.value_or(""), nullptr, false);
  if (!told.is_object() || !told.contains("readout") || !told["readout"].is_object()) return std::nullopt;
  const auto& readout = told["readout"];
  RawScale scale;
  if (readout.contains("bits") && readout["bits"].is_number_integer()) scale.bits = readout["bits"];
  if (readout.contains("offset_dn") && readout["offset_dn"].is_number())
    scale.offset_dn = readout["offset_dn"];
  if (readout.contains("saturation_dn") && readout["saturation_dn"].is_number())
    scale.saturation_dn = readout["saturation_dn"];
  scale.exposure_s = number(image, "exposure_s");
  scale.gain_e_per_dn = number(image, "gain_e_per_dn");
  scale.electrons_per_lx_s = number(image, "electrons_per_lx_s");
  const auto names = attribute(image, "mosaic_channels");
  const auto mosaic = attribute(image, "mosaic");
  if (names && mosaic) {
    scale.channels = split(*names, ',');
    scale.mosaic = parse_mosaic(*mosaic, scale.channels);
  }
  return scale;
}

RawImage read_raw_image(const std::filesystem::path& path, Inputs* inputs) {
  if (!is_raw_picture(path)) {
    Image image = read_image(path, inputs);
    auto scale = raw_scale(image);
    return {std::move(image), std::move(scale)};
  }
  const RawPicture raw = read_raw_picture(path);
  if (inputs != nullptr) inputs->take_memory(path.string(), raw.codes.size() * sizeof(float));
  RawImage read{codes_of(raw), {}};
  read.scale = raw_scale(read.image);
  // A DNG's codes have been made linear by its table: the levels are those behind it.
  if (!read.scale || raw.is_linearised) read.scale = scale_of(raw);
  return read;
}

double code_of(float value) {
  return std::round(static_cast<double>(value) * kSixteenBits);
}

std::vector<ChannelCodes> raw_codes(const Image& image, const RawScale& scale) {
  std::vector<ChannelCodes> all;
  if (scale.mosaic && image.channels.size() == 1) {
    for (const std::string& name : scale.channels) all.push_back({name, {}});
    std::size_t pixel = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        all[static_cast<std::size_t>(scale.mosaic->at(x, y))].dn.push_back(
            code_of(image.channels.front().values[pixel++]));
    return all;
  }
  for (const ImageChannel& channel : image.channels) {
    ChannelCodes& codes = all.emplace_back(ChannelCodes{channel.name, {}});
    for (const float value : channel.values) codes.dn.push_back(code_of(value));
  }
  return all;
}

}  // namespace abbe
