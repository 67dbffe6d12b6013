#include "io/picture.h"

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include <png.h>

#include "io/atomic_file.h"
#include "io/error.h"
#include "io/exr.h"
#include "io/module.h"
#include "io/picture_codec.h"
#include "io/text.h"

namespace abbe {

namespace {

struct Png {
  png_structp write = nullptr;
  png_infop info = nullptr;
  std::string bytes = {};
  std::string error = {};
};

struct Tags {
  bool is_srgb = false;
  std::optional<double> gamma = {};
  std::vector<double> primaries = {};  // x and y of red, green, blue and white.
};

[[noreturn]] void on_error(png_structp write, const char* message) {
  static_cast<Png*>(png_get_error_ptr(write))->error = message;
  png_longjmp(write, 1);
}

void ignore_warning(png_structp /*write*/, const char* /*message*/) {}

void append(png_structp write, png_bytep bytes, std::size_t count) {
  static_cast<Png*>(png_get_io_ptr(write))->bytes.append(reinterpret_cast<const char*>(bytes), count);
}

// Text chunks, which refer to the header. Text that is not ASCII becomes an international text chunk.
std::vector<png_text> texts_of(const PictureHeader& header) {
  std::vector<png_text> texts;
  for (const auto& [key, value] : header.metadata) {
    if (key == kColorSpace || key == kPrimariesKey) continue;
    const bool ascii = std::all_of(value.begin(), value.end(), [](char c) { return c > 0; });
    png_text& text = texts.emplace_back();
    text.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    text.key = const_cast<char*>(key.c_str());  // Also used for reading, hence not const.
    text.text = const_cast<char*>(value.c_str());
    text.text_length = value.size();
  }
  return texts;
}

std::string attribute(const PictureHeader& header, const char* key) {
  const auto text = header.metadata.find(key);
  return text == header.metadata.end() ? "" : text->second;
}

// A PNG stores the encoding exponent, the inverse of the exponent in `kColorSpace`.
Tags tags_of(const PictureHeader& header) {
  const std::string space = attribute(header, kColorSpace);
  Tags tags{.is_srgb = space == "sRGB"};
  if (space == kLinear) tags.gamma = 1;
  if (space.starts_with(kGamma))
    if (const auto power = parse_number(space.substr(std::string_view(kGamma).size())))
      tags.gamma = 1 / *power;
  if (!tags.gamma) return tags;
  for (const std::string& number : split(attribute(header, kPrimariesKey), ' '))
    tags.primaries.push_back(parse_number(number).value_or(0));
  return tags;
}

void write_tags(const Png& png, const Tags& tags) {
  if (tags.is_srgb) png_set_sRGB_gAMA_and_cHRM(png.write, png.info, PNG_sRGB_INTENT_ABSOLUTE);
  if (tags.gamma) png_set_gAMA(png.write, png.info, *tags.gamma);
  if (const std::vector<double>& p = tags.primaries; p.size() == 8)
    png_set_cHRM(png.write, png.info, p[6], p[7], p[0], p[1], p[2], p[3], p[4], p[5]);
}

// Returns false if libpng fails. libpng then jumps back here, so nothing in between may have a destructor.
bool write(Png& png, const PictureHeader& header, const Tags& tags, const std::vector<png_text>& texts,
           const PictureCodes& codes) {
  if (setjmp(png_jmpbuf(png.write)) != 0) return false;
  const bool is_wide = std::holds_alternative<std::vector<std::uint16_t>>(codes);
  const std::size_t values_of_row = static_cast<std::size_t>(header.width) * header.channels.size();
  const auto* row =
      std::visit([](const auto& values) { return reinterpret_cast<const png_byte*>(values.data()); }, codes);
  png_set_write_fn(png.write, &png, append, nullptr);
  png_set_IHDR(png.write, png.info, static_cast<png_uint_32>(header.width),
               static_cast<png_uint_32>(header.height), is_wide ? 16 : 8,
               header.channels.size() == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  write_tags(png, tags);
  png_set_text(png.write, png.info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(png.write, png.info);
  if (is_wide) png_set_swap(png.write);
  for (std::int64_t y = 0; y < header.height; ++y, row += values_of_row * (is_wide ? 2 : 1))
    png_write_row(png.write, row);
  png_write_end(png.write, nullptr);
  return true;
}

// The bytes of a PNG file with one or three channels. The metadata become text chunks; `kColorSpace` decides
// the colour chunks (`tags_of`). `path` names the file in errors. Throws Error{output} if libpng fails.
std::string encode_png(const std::string& path, const PictureHeader& header, const PictureCodes& codes) {
  Png png;
  png.write = png_create_write_struct(PNG_LIBPNG_VER_STRING, &png, on_error, ignore_warning);
  if (png.write != nullptr) png.info = png_create_info_struct(png.write);
  const bool written = png.info != nullptr && write(png, header, tags_of(header), texts_of(header), codes);
  png_destroy_write_struct(&png.write, &png.info);
  if (!written) throw Error(ErrorCode::output, path, "libpng: " + png.error);
  return std::move(png.bytes);
}

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

/// The transform from stored to displayed pixels.
struct Turn {
  bool rows_are_columns;
  bool from_right;
  bool from_bottom;
};

// Orientations 5 to 8 exchange rows and columns and then reflect like 1 to 4. Nothing for any other text.
std::optional<Turn> turn_of(const std::string& text) {
  if (text.size() != 1 || text[0] < '1' || text[0] > '8') return std::nullopt;
  const int quarter = (text[0] - '1') % 4;
  return Turn{text[0] > '4', quarter == 1 || quarter == 2, quarter > 1};
}

// The displayed plane, which has `columns` columns and `rows` rows.
std::vector<float> reoriented(const std::vector<float>& plane, const Turn& turn, std::size_t columns,
                              std::size_t rows) {
  std::vector<float> values(plane.size());
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const std::size_t stored_columns = turn.rows_are_columns ? rows : columns;
    std::size_t x = i % stored_columns;
    std::size_t y = i / stored_columns;
    if (turn.rows_are_columns) std::swap(x, y);
    if (turn.from_right) x = columns - 1 - x;
    if (turn.from_bottom) y = rows - 1 - y;
    values[y * columns + x] = plane[i];
  }
  return values;
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
    // The memory of the image stays reserved.
    if (inputs) inputs->reserve_memory(path.string(), floats * sizeof(float));
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

Image apply_orientation(Image image) {
  const auto attribute = image.metadata.find(kOrientation);
  if (attribute == image.metadata.end()) return image;
  const std::optional<Turn> turn = turn_of(attribute->second);
  image.metadata.erase(attribute);
  if (!turn) return image;
  if (turn->rows_are_columns) std::swap(image.width, image.height);
  for (ImageChannel& channel : image.channels)
    channel.values = reoriented(channel.values, *turn, static_cast<std::size_t>(image.width),
                                static_cast<std::size_t>(image.height));
  return image;
}

const PictureCodec& picture_codec() {
  static const PictureCodec& codec =
      module_functions<PictureCodec>(ABBE_PICTURE_MODULE, kPictureCodecSymbol, ModuleScope::own,
                                     "the module that reads and writes pictures");
  return codec;
}

}  // namespace abbe
