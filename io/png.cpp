#include "io/png.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstddef>
#include <optional>
#include <string_view>

#include "io/error.h"
#include "io/exr.h"
#include "io/text.h"

namespace abbe {
namespace {

// State of libpng and its error message.
struct Png {
  png_structp write = nullptr;
  png_infop info = nullptr;
  std::string bytes = {};
  std::string error = {};
};

// Colour chunks of a file.
struct Tags {
  bool is_srgb = false;
  std::optional<double> gamma = {};
  std::vector<double> primaries = {};  // x and y of red, green, blue and white.
};

struct Pixels {
  const png_byte* first;
  std::size_t row_bytes;
  int bits;
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
           const Pixels& pixels) {
  if (setjmp(png_jmpbuf(png.write)) != 0) return false;
  png_set_write_fn(png.write, &png, append, nullptr);
  png_set_IHDR(png.write, png.info, static_cast<png_uint_32>(header.width),
               static_cast<png_uint_32>(header.height), pixels.bits,
               header.channels.size() == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  write_tags(png, tags);
  png_set_text(png.write, png.info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(png.write, png.info);
  if (pixels.bits == 16) png_set_swap(png.write);
  for (std::int64_t y = 0; y < header.height; ++y)
    png_write_row(png.write, pixels.first + static_cast<std::size_t>(y) * pixels.row_bytes);
  png_write_end(png.write, nullptr);
  return true;
}

Pixels pixels_of(const PictureHeader& header, const PictureCodes& codes) {
  const std::size_t row = static_cast<std::size_t>(header.width) * header.channels.size();
  return std::visit(
      [row](const auto& values) {
        const auto bytes = sizeof values[0];
        return Pixels{reinterpret_cast<const png_byte*>(values.data()), row * bytes,
                      static_cast<int>(8 * bytes)};
      },
      codes);
}

}  // namespace

std::string encode_png(const std::string& path, const PictureHeader& header, const PictureCodes& codes) {
  Png png;
  png.write = png_create_write_struct(PNG_LIBPNG_VER_STRING, &png, on_error, ignore_warning);
  if (png.write != nullptr) png.info = png_create_info_struct(png.write);
  const bool written =
      png.info != nullptr && write(png, header, tags_of(header), texts_of(header), pixels_of(header, codes));
  png_destroy_write_struct(&png.write, &png.info);
  if (!written) throw Error(ErrorCode::output, path, "libpng: " + png.error);
  return std::move(png.bytes);
}

}  // namespace abbe
