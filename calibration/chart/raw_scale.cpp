#include "calibration/chart/raw_scale.h"

#include <bit>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "io/error.h"
#include "io/json.h"
#include "io/picture.h"
#include "io/picture_codec.h"
#include "io/text.h"
#include "sensor/film/crop.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/readout/readout_json.h"

namespace abbe {
namespace {

constexpr const char* kWhiteLevel = "white_level_dn";
using Attributes = std::map<std::string, std::string>;

Attributes description_lines(const Image& image) {
  Attributes attributes;
  for (const std::string& line : split(attribute_of(image.metadata, "ImageDescription").value_or(""), '\n'))
    if (const std::size_t colon = line.find(": "); colon != std::string::npos)
      attributes.emplace(line.substr(0, colon), line.substr(colon + 2));
  return attributes;
}

Attributes all_attributes(const Image& image) {
  Attributes attributes = image.metadata;
  attributes.merge(description_lines(image));
  return attributes;
}

std::map<std::string, double> own_exposures(const Attributes& attributes) {
  const std::string prefix = "exposure_s.";
  std::map<std::string, double> own;
  for (auto it = attributes.lower_bound(prefix); it != attributes.end() && it->first.starts_with(prefix);
       ++it)
    if (const auto seconds = parse_number(it->second)) own.emplace(it->first.substr(prefix.size()), *seconds);
  return own;
}

// True if the image holds codes. Pictures for displays record the sensor too, but only codes have levels.
bool holds_codes(const Attributes& attributes) {
  return attributes.contains(kWhiteLevel);
}

Readout readout_of(const std::string& sensor, std::optional<double> sensitivity) {
  Diagnostics diagnostics;
  const auto json = parse_json(std::make_shared<const SourceText>(SourceText{"sensor", sensor}), diagnostics);
  const JsonValue* spec = json ? json->find("readout") : nullptr;
  auto readout = spec != nullptr ? read_readout(*spec, sensitivity, diagnostics) : std::nullopt;
  if (!readout) throw Error(ErrorCode::input, "attribute \"sensor\"", diagnostics.text());
  return *std::move(readout);
}

void straighten(Image& image, const RawScale& scale) {
  const auto step = static_cast<float>(1 / kSixteenBits);  // with which OpenImageIO rounds alike
  for (ImageChannel& plane : image.channels)
    for (float& value : plane.values) value = static_cast<float>(scale.linear(code_of(value))) * step;
}

// Restores the sensor's own codes, which measurements of response, noise and sharpness need.
void leave_uncorrected(RawPicture& raw, const std::string& file) {
  for (DngOpcode& opcode : raw.opcodes) {
    if (opcode.list == 1) continue;
    if (!opcode.is_optional)
      throw Error(ErrorCode::input, file,
                  fmt::format("it requires corrections of the sensor's codes, but uncorrected codes are "
                              "needed (got the mandatory opcode {}, allowed none after linearisation)",
                              opcode.text()));
    opcode.is_applied = false;
  }
  raw.corrected.clear();
}

// Scale from the tags or keywords that every program writes.
RawScale scale_of(const RawPicture& raw) {
  RawScale scale;
  scale.bits = std::bit_width(static_cast<unsigned>(raw.white_level_dn));
  scale.offset_dn = raw.black_level_dn;
  scale.saturation_dn = raw.white_level_dn;
  scale.exposure_s = raw.exposure_s;
  scale.mosaic = mosaic_of(raw);
  if (scale.mosaic) scale.channels = raw.channels;
  return scale;
}

// Highest code of all planes; empty if a value is not a code.
std::optional<double> highest_code(const Image& image) {
  constexpr double kRounding = 0.01;  // of floats; codes of 8 and of 16 bits are fractions of 65535
  double highest = 0;
  for (const ImageChannel& channel : image.channels)
    for (const float value : channel.values) {
      const double code = code_of(value);
      if (!(std::abs(static_cast<double>(value) * kSixteenBits - code) < kRounding)) return std::nullopt;
      highest = std::max(highest, code);
    }
  return highest;
}

// True if the image holds the sensor's codes. Converters copy the attributes of a raw file but write planes
// and codes of their own.
bool holds_codes_up_to(const RawImage& read, double highest) {
  if (!read.scale) return false;
  if (!raw_scale(read.image)) return true;  // known from tags
  return number_of(read.image.metadata, kWhiteLevel) && highest <= read.scale->highest() &&
         !(read.scale->mosaic && read.image.channels.size() != 1);
}

}  // namespace

Image code_planes(const RawPicture& raw) {
  Image image{static_cast<int>(raw.width), static_cast<int>(raw.height), {}, raw.metadata};
  const std::size_t planes = raw.planes.size();
  for (std::size_t k = 0; k < planes; ++k) {
    ImageChannel& plane = image.channels.emplace_back(ImageChannel{raw.planes[k], {}});
    plane.values.reserve(image.pixels());
    for (std::size_t i = k; i < raw.codes.size(); i += planes)
      plane.values.push_back(static_cast<float>(raw.codes[i]));
  }
  return image;
}

std::vector<std::string> ignored_opcodes(const RawPicture& raw, const std::string& file) {
  std::vector<std::string> warnings;
  for (const DngOpcode& opcode : raw.opcodes)
    if (!opcode.is_applied)
      warnings.push_back(fmt::format("{}: the optional opcode {} is not applied", file, opcode.text()));
  return warnings;
}

std::optional<Mosaic> mosaic_of(const RawPicture& raw) {
  if (raw.mosaic_width == 0) return std::nullopt;
  const int width = static_cast<int>(raw.mosaic_width);
  return Mosaic{width, static_cast<int>(raw.mosaic.size()) / width, {raw.mosaic.begin(), raw.mosaic.end()}};
}

void add_description_attributes(Image& image) {
  image.metadata.merge(description_lines(image));
}

void drop_alpha(Image& image) {
  std::erase_if(image.channels, [](const ImageChannel& channel) { return channel.name == "A"; });
}

void name_planes(Image& image) {
  const auto attributes = attribute_of(all_attributes(image), "sensor_channels");
  const std::vector<std::string> names = attributes ? split(*attributes, ',') : std::vector<std::string>{};
  if (names.size() != image.channels.size()) drop_alpha(image);
  for (std::size_t k = 0; k < image.channels.size() && names.size() == image.channels.size(); ++k)
    image.channels[k].name = names[k];
}

std::optional<RawScale> raw_scale(const Image& image) {
  const Attributes attributes = all_attributes(image);
  const auto sensor = nlohmann::json::parse(attribute_of(attributes, "sensor").value_or(""), nullptr, false);
  if (!sensor.is_object() || !sensor.contains("readout") || !sensor["readout"].is_object())
    return std::nullopt;
  const auto& readout = sensor["readout"];
  RawScale scale;
  const auto in_readout = [&](const char* key) {
    const bool is_number = readout.contains(key) && readout[key].is_number();
    return is_number ? std::optional(readout[key].get<double>()) : std::nullopt;
  };
  if (readout.contains("bits") && readout["bits"].is_number_integer()) scale.bits = readout["bits"];
  scale.offset_dn = in_readout("offset_dn").value_or(scale.offset_dn);
  scale.saturation_dn = in_readout("saturation_dn");
  scale.exposure_s = number_of(attributes, "exposure_s");
  scale.own_exposure_s = own_exposures(attributes);
  scale.gain_e_per_dn = number_of(attributes, "gain_e_per_dn");
  scale.electrons_per_lx_s = number_of(attributes, "electrons_per_lx_s");
  if (readout.contains("response_curve") && holds_codes(attributes)) {
    scale.curved = readout_of(attributes.at("sensor"), scale.electrons_per_lx_s);
    scale.linear_codes = linear_codes(*scale.curved);
  }
  if (auto mosaic = recorded_mosaic(attributes)) {
    scale.channels = std::move(mosaic->channels);
    scale.mosaic = std::move(mosaic->pattern);
  }
  return scale;
}

RawImage read_raw_image(const std::filesystem::path& path, Inputs* inputs) {
  if (!is_raw_picture(path)) {
    Image image = read_image(path, inputs);
    auto scale = raw_scale(image);
    if (scale && holds_codes(all_attributes(image))) {
      add_description_attributes(image);
      name_planes(image);
      image.metadata[kColorSpace] = kLinear;
    }
    if (scale && !scale->linear_codes.empty()) straighten(image, *scale);
    return {std::move(image), std::move(scale)};
  }
  RawPicture raw = read_raw_picture(path);
  leave_uncorrected(raw, path.string());
  if (inputs != nullptr) inputs->reserve_memory(path.string(), raw.codes.size() * sizeof(float));
  RawImage read{code_planes(raw), {}, ignored_opcodes(raw, path.string())};
  add_description_attributes(read.image);
  read.image.metadata[kColorSpace] = kLinear;
  const auto step = static_cast<float>(1 / kSixteenBits);  // with which OpenImageIO rounds alike
  for (ImageChannel& plane : read.image.channels)
    for (float& code : plane.values) code *= step;
  read.scale = raw_scale(read.image);
  if (!read.scale) read.scale = scale_of(raw);
  if (!read.scale->linear_codes.empty() && !raw.is_linearised) straighten(read.image, *read.scale);
  return read;
}

double code_of(float value) {
  return std::round(static_cast<double>(value) * kSixteenBits);
}

std::vector<ChannelCodes> raw_codes(const Image& image, const RawScale& scale) {
  const bool is_mosaic = scale.mosaic && image.channels.size() == 1;
  std::vector<ChannelCodes> all(is_mosaic ? scale.channels.size() : image.channels.size());
  for (std::size_t c = 0; c < all.size(); ++c)
    all[c].channel = is_mosaic ? scale.channels[c] : image.channels[c].name;
  for (const Crop& area : recorded_areas(image))
    for (int y = area.y0; y < area.y1; ++y) {
      for (ChannelCodes& channel : all) channel.rows.push_back({y, 0});
      for (int x = area.x0; x < area.x1; ++x) {
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
        for (std::size_t c = 0; c < image.channels.size(); ++c) {
          ChannelCodes& channel = all[is_mosaic ? static_cast<std::size_t>(scale.mosaic->at(x, y)) : c];
          channel.dn.push_back(static_cast<std::uint16_t>(code_of(image.channels[c].values[pixel])));
          ++channel.rows.back().count;
        }
      }
    }
  return all;
}

bool holds_sensor_codes(const RawImage& read) {
  const std::optional<double> highest = highest_code(read.image);
  return highest && holds_codes_up_to(read, *highest);
}

double white_dn(const Image& image, const RawScale& scale) {
  return scale.linear(number_of(image.metadata, kWhiteLevel).value_or(scale.highest()));
}

std::optional<ClippingLevel> clipping_level(const RawImage& read) {
  const std::optional<double> highest = highest_code(read.image);
  if (!highest) return std::nullopt;
  if (holds_codes_up_to(read, *highest)) return ClippingLevel{white_dn(read.image, *read.scale), true};
  if (*highest != kSixteenBits) return std::nullopt;
  return ClippingLevel{kSixteenBits, false};
}

}  // namespace abbe
