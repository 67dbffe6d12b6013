#include "develop/linear_image.h"

#include <algorithm>

#include <fmt/format.h>

#include "calibration/chart/measured_patches.h"
#include "calibration/chart/raw_scale.h"
#include "develop/develop.h"
#include "develop/film_file.h"
#include "io/error.h"
#include "io/picture.h"
#include "io/raw_picture.h"
#include "io/spectral_exr.h"
#include "io/text.h"
#include "sensor/film/crop.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/response/polarised_channels.h"

namespace abbe {
namespace {

void read_mosaic(LinearImage& read) {
  auto recorded = recorded_mosaic(read.image.metadata);
  if (!recorded || read.image.channels.size() != 1) return;
  read.mosaic = std::move(recorded->pattern);
  read.channels = std::move(recorded->channels);
}

// Removes all but the film's own planes and puts them in the order of the sensor; files order channels by
// name.
void keep_planes(Image& image) {
  std::vector<std::string> order = intensities(plane_names(image));
  if (!image.metadata.contains("sensor_channels") && !is_spectral(image)) {
    std::erase_if(order, [](const std::string& name) { return name.find('.') != std::string::npos; });
    if (const auto rgb = rgb_order(order)) order = {order[(*rgb)[0]], order[(*rgb)[1]], order[(*rgb)[2]]};
  }
  std::vector<ImageChannel> planes;
  for (const std::string& name : order)
    if (const ImageChannel* plane = image.find(name)) planes.push_back(*plane);
  image.channels = std::move(planes);
}

LinearImage linear_film(const std::filesystem::path& path, Inputs* inputs) {
  LinearImage read{read_film(path, inputs), {}, {}, {}, kFilmValues};
  const bool spectral = is_spectral(read.image);
  const std::size_t all = read.image.memory_bytes();
  if (spectral) read.unit = "radiance of the band [W/(m^2 sr)]";
  keep_planes(read.image);
  if (inputs != nullptr) inputs->release_memory(all - read.image.memory_bytes());
  for (const ImageChannel& channel : read.image.channels) read.channels.push_back(channel.name);
  read_mosaic(read);
  return read;
}

// Linearises codes and subtracts black, which is a linear value. White is rounded like the codes, so pixels
// with exactly that code are saturated.
void subtract_black(LinearImage& read, const RawScale& scale, double black, double white) {
  const auto above_black = [&](double code) { return static_cast<float>(scale.linear(code) - black); };
  read.unit = kNumbersAboveBlack;
  read.saturation = static_cast<double>(above_black(white));
  for (ImageChannel& plane : read.image.channels)
    for (float& code : plane.values) code = above_black(static_cast<double>(code));
}

// Uses the values to which the opcodes of a DNG change those above black.
void use_corrected(LinearImage& read, const RawPicture& raw, Inputs* inputs, const std::string& file) {
  read.warnings = ignored_opcodes(raw, file);
  if (raw.corrected.empty()) return;
  if (inputs != nullptr) inputs->reserve_memory(file, raw.corrected.size() * sizeof(float));
  read.exposed = read.image.channels;
  const std::size_t planes = raw.planes.size();
  for (std::size_t i = 0; i < raw.corrected.size(); ++i)
    read.image.channels[i % planes].values[i / planes] = raw.corrected[i];
}

LinearImage linear_raw(const std::filesystem::path& path, Inputs* inputs) {
  const RawPicture raw = read_raw_picture(path);
  if (inputs != nullptr) inputs->reserve_memory(path.string(), raw.codes.size() * sizeof(float));
  LinearImage read{code_planes(raw), raw.channels, mosaic_of(raw), {}, {}};
  add_description_attributes(read.image);
  read_mosaic(read);
  const RawScale scale = raw.is_linearised ? RawScale{} : raw_scale(read.image).value_or(RawScale{});
  // DNG tags have at most single precision, the attribute has more.
  const auto black = number_of(read.image.metadata, kBlackLevelKey);
  subtract_black(read, scale, black.value_or(raw.black_level_dn), raw.white_level_dn);
  use_corrected(read, raw, inputs, path.string());
  return read;
}

// Damage that a file's checksums do not reveal may show as codes that the sensor cannot produce.
void require_codes(const Image& image, const std::filesystem::path& path) {
  const std::optional<RawScale> scale = raw_scale(image);
  if (!scale) return;
  for (const ImageChannel& channel : image.channels)
    for (std::size_t i = 0; i < channel.values.size(); ++i)
      if (const double code = code_of(channel.values[i]); code > scale->highest())
        throw Error(
            ErrorCode::input, path.string(),
            fmt::format("damaged, or from another sensor than it declares: channel \"{}\" has code {} "
                        "at pixel {},{} (allowed 0 to {})",
                        channel.name, code, i % static_cast<std::size_t>(image.width),
                        i / static_cast<std::size_t>(image.width), scale->highest()));
}

LinearImage linear_picture(const std::filesystem::path& path, Inputs* inputs) {
  LinearImage read{read_picture(path, inputs), {}, {}, 1.0, kCodeValues};
  add_description_attributes(read.image);
  const auto black = number_of(read.image.metadata, kBlackLevelKey);
  const auto white = number_of(read.image.metadata, kWhiteLevelKey);
  if (black && white)
    name_planes(read.image);
  else
    drop_alpha(read.image);
  require_finite(read.image, path);
  for (const ImageChannel& channel : read.image.channels) read.channels.push_back(channel.name);
  if (!black || !white) return read;
  require_codes(read.image, path);
  for (ImageChannel& channel : read.image.channels)
    for (float& value : channel.values) value = static_cast<float>(code_of(value));
  subtract_black(read, raw_scale(read.image).value_or(RawScale{}), *black, *white);
  read_mosaic(read);
  return read;
}

// Index of the channel that a pixel of a plane records.
std::size_t channel_of(const LinearImage& image, std::size_t plane, std::size_t pixel) {
  const auto width = static_cast<std::size_t>(image.image.width);
  if (!image.mosaic) return plane;
  return static_cast<std::size_t>(
      image.mosaic->at(static_cast<int>(pixel % width), static_cast<int>(pixel / width)));
}

std::vector<double> channel_means(const LinearImage& image) {
  std::vector<double> sums(image.channels.size(), 0);
  std::vector<double> pixels(image.channels.size(), 0);
  for (std::size_t k = 0; k < image.image.channels.size(); ++k)
    for (std::size_t i = 0; i < image.image.pixels(); ++i) {
      const std::size_t channel = channel_of(image, k, i);
      sums[channel] += static_cast<double>(image.image.channels[k].values[i]);
      pixels[channel] += 1;
    }
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k] /= pixels[k];
  return sums;
}

std::string described(const LinearImage& image) {
  if (!image.mosaic) return fmt::format("{}", fmt::join(image.channels, ", "));
  return fmt::format("the mosaic {}", to_text(*image.mosaic, image.channels));
}

// Clipped values are uniform under any light, so a saturated flat is useless. A few hot pixels are clipped in
// any flat.
void require_unsaturated(const LinearImage& flat, const std::filesystem::path& path) {
  if (!flat.saturation) return;
  double saturated = 0;
  for (const ImageChannel& channel : flat.as_exposed())
    saturated += static_cast<double>(std::ranges::count_if(
        channel.values, [&](float value) { return static_cast<double>(value) >= *flat.saturation; }));
  const auto pixels = static_cast<double>(flat.image.pixels() * flat.image.channels.size());
  if (exceeds_defects(saturated, pixels))
    throw Error(
        ErrorCode::input, path.string(),
        fmt::format("the flat is saturated (got {:.3g} % of its pixels, allowed {} %): expose it less",
                    100 * saturated / pixels, 100 * kMaxDefectiveFraction));
}

void require_positive(const LinearImage& flat, const std::filesystem::path& path) {
  const auto width = static_cast<std::size_t>(flat.image.width);
  for (const ImageChannel& channel : flat.image.channels)
    for (std::size_t i = 0; i < channel.values.size(); ++i)
      if (!(channel.values[i] > 0))
        throw Error(ErrorCode::input, path.string(),
                    fmt::format("the flat has no light at pixel {},{} (got {})", i % width, i / width,
                                static_cast<double>(channel.values[i])));
}

}  // namespace

MeasuredPlanes LinearImage::planes() const {
  MeasuredPlanes planes{{}, channels, mosaic, saturation, recorded_areas(image)};
  for (const ImageChannel& channel : image.channels) planes.planes.push_back(&channel);
  for (const ImageChannel& channel : exposed) planes.exposed.push_back(&channel);
  return planes;
}

LinearImage read_linear_image(const std::filesystem::path& path, Inputs* inputs) {
  if (extension_of(path) == ".exr") return linear_film(path, inputs);
  if (is_raw_picture(path)) return linear_raw(path, inputs);
  return linear_picture(path, inputs);
}

void flat_field(LinearImage& image, const LinearImage& flat, const std::filesystem::path& path) {
  if (flat.image.width != image.image.width || flat.image.height != image.image.height)
    throw Error(ErrorCode::input, path.string(),
                fmt::format("the flat has a different size (got {} x {}, allowed {} x {})", flat.image.width,
                            flat.image.height, image.image.width, image.image.height));
  if (flat.channels != image.channels || flat.mosaic != image.mosaic)
    throw Error(ErrorCode::input, path.string(),
                fmt::format("the flat has different channels or a different mosaic (got {}, allowed {})",
                            described(flat), described(image)));
  require_unsaturated(flat, path);
  require_positive(flat, path);
  if (image.exposed.empty()) image.exposed = image.image.channels;
  const std::vector<double> means = channel_means(flat);
  for (std::size_t k = 0; k < image.image.channels.size(); ++k)
    for (std::size_t i = 0; i < image.image.pixels(); ++i) {
      float& own = image.image.channels[k].values[i];
      own = static_cast<float>(static_cast<double>(own) * means[channel_of(image, k, i)] /
                               static_cast<double>(flat.image.channels[k].values[i]));
    }
}

}  // namespace abbe
