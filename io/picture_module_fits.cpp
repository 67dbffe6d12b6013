// Reads and writes FITS files with cfitsio.
#include <fitsio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string_view>
#include <utility>

#include <boost/algorithm/string.hpp>

#include "io/error.h"
#include "io/image.h"
#include "io/picture_module.h"

namespace abbe::picture_module {
namespace {

[[noreturn]] void fail(const std::string& path, int status) {
  std::array<char, FLEN_STATUS> text{};
  fits_get_errstatus(status, text.data());
  throw Error(ErrorCode::output, path, std::string("cfitsio: ") + text.data());
}

// A file in memory that cfitsio can grow.
struct MemoryFits {
  void* bytes = nullptr;
  std::size_t size = 0;
  fitsfile* fits = nullptr;

  MemoryFits() = default;
  MemoryFits(const MemoryFits&) = delete;
  MemoryFits& operator=(const MemoryFits&) = delete;
  ~MemoryFits() {
    int status = 0;
    if (fits != nullptr) fits_close_file(fits, &status);
    std::free(bytes);
  }
};

/// Writes keywords. `status` keeps the first failure, as in all functions of cfitsio.
struct Header {
  fitsfile* fits;
  int& status;

  void number(const char* key, double value, const char* comment) {
    fits_update_key(fits, TDOUBLE, key, &value, comment, &status);
  }
  void text(const char* key, const std::string& value, const char* comment) {
    fits_update_key_longstr(fits, key, value.c_str(), comment, &status);
  }
};

// The channels of a 2 x 2 pattern, such as "RGGB", as capture programs write it. "" for other patterns, and
// for names longer than a letter.
std::string bayer_pattern(const RawPicture& raw) {
  std::string letters;
  for (const std::uint8_t channel : raw.mosaic) letters += raw.channels[channel];
  return raw.mosaic_width == 2 && raw.mosaic.size() == 4 && letters.size() == 4 ? letters : "";
}

// Writes the keywords that astronomy programs read, and the metadata as history.
void write_header(Header header, const RawPicture& raw) {
  fits_write_key_longwarn(header.fits, &header.status);
  header.text("CREATOR", "Abbe", "program that made this file");
  if (!raw.camera.empty()) header.text("INSTRUME", raw.camera, "camera");
  header.text("ROWORDER", "TOP-DOWN", "the first row is the top of the picture");
  header.text("PLANES", boost::algorithm::join(raw.planes, ","), "planes along the third axis");
  if (raw.exposure_s) header.number("EXPTIME", *raw.exposure_s, "[s] exposure time");
  header.number("GAIN", raw.gain_e_per_dn, "[electron/adu] conversion gain");
  header.number("EGAIN", raw.gain_e_per_dn, "[electron/adu] the same, as others call it");
  header.number("RDNOISE", raw.read_noise_e, "[electron] read noise");
  header.number("PEDESTAL", raw.black_level_dn,
                raw.linear_codes.empty() ? "[adu] electrons of light = (x - PEDESTAL) GAIN"
                                         : "[adu] no light, with response_curve undone");
  header.number("SATURATE", raw.white_level_dn, "[adu] saturated pixels reach this code");
  if (raw.full_well_e > 0) header.number("FULLWELL", raw.full_well_e, "[electron] full well");
  if (raw.f_number) header.number("FNUMBER", *raw.f_number, "f-number");
  if (raw.iso_speed) header.number("ISOSPEED", *raw.iso_speed, "saturation-based ISO speed");
  if (const std::string pattern = bayer_pattern(raw); !pattern.empty())
    header.text("BAYERPAT", pattern, "channels of the pattern, row by row");
  for (const auto& [key, value] : raw.metadata)
    fits_write_history(header.fits, (key + ": " + value).c_str(), &header.status);
}

// The codes plane by plane, as cfitsio stores them.
std::vector<std::uint16_t> plane_by_plane(const RawPicture& raw) {
  const std::size_t planes = raw.planes.size();
  std::vector<std::uint16_t> codes;
  codes.reserve(raw.codes.size());
  for (std::size_t plane = 0; plane < planes; ++plane)
    for (std::size_t i = plane; i < raw.codes.size(); i += planes) codes.push_back(raw.codes[i]);
  return codes;
}

// True if the codes, plane by plane, read back from the encoded file.
bool reads_back(std::string& bytes, const std::vector<std::uint16_t>& codes) {
  int status = 0;
  MemoryFits file;  // It does not own the bytes.
  void* data = bytes.data();
  std::size_t size = bytes.size();
  fits_open_memfile(&file.fits, "memory", READONLY, &data, &size, 0, nullptr, &status);
  std::vector<std::uint16_t> read(codes.size());
  fits_read_img(file.fits, TUSHORT, 1, static_cast<LONGLONG>(read.size()), nullptr, read.data(), nullptr,
                &status);
  return status == 0 && read == codes;
}

double number_of(fitsfile* fits, const char* key, double fallback) {
  double value = fallback;
  int status = 0;
  return fits_read_key(fits, TDOUBLE, key, &value, nullptr, &status) == 0 ? value : fallback;
}

// Text of a keyword, joined from all its cards; "" if absent.
std::string text_of(fitsfile* fits, const char* key) {
  char* value = nullptr;
  int status = 0;
  std::string text = fits_read_key_longstr(fits, key, &value, nullptr, &status) == 0 ? value : "";
  status = 0;
  if (value != nullptr) fits_free_memory(value, &status);
  return text;
}

std::size_t shift_of(fitsfile* fits, const char* key) {
  return std::fmod(std::round(number_of(fits, key, 0)), 2) == 0 ? 0 : 1;
}

// Reads a 2 x 2 pattern such as "RGGB", from the top and shifted by the offsets of a sub-area of the sensor.
// Other patterns are read from the history of files that Abbe wrote.
void read_pattern(fitsfile* fits, const std::string& path, RawPicture& raw) {
  constexpr std::string_view kLetters = "RGB";
  const std::string recorded = text_of(fits, "BAYERPAT");
  if (recorded.empty() || raw.planes.size() != 1) return;
  const std::string pattern = boost::to_upper_copy(recorded);
  if (pattern.size() != 4 || pattern.find_first_not_of(kLetters) != std::string::npos) {
    if (raw.metadata.contains("mosaic")) return;
    throw Error(
        ErrorCode::input, path,
        "BAYERPAT is not a 2 x 2 pattern of R, G and B (got \"" + recorded + "\", for example \"RGGB\")");
  }
  raw.mosaic_width = 2;
  raw.channels = {"R", "G", "B"};
  const std::size_t right = shift_of(fits, "XBAYROFF");
  const std::size_t down = shift_of(fits, "YBAYROFF");
  for (std::size_t i = 0; i < 4; ++i)
    raw.mosaic.push_back(static_cast<std::uint8_t>(kLetters.find(pattern[i ^ right ^ (2 * down)])));
}

// Names of the planes as listed in `PLANES` of Abbe's files. Without them, three planes are red, green and
// blue, as astronomy programs write them.
std::vector<std::string> plane_names(const std::string& recorded, std::size_t count) {
  std::vector<std::string> names;
  boost::split(names, recorded, [](char c) { return c == ','; });
  if (names.size() == count && !names.front().empty()) return names;
  if (count == 3) return {"R", "G", "B"};
  names.clear();
  for (std::size_t k = 0; k < count; ++k) names.push_back(count == 1 ? "raw" : std::to_string(k));
  return names;
}

// Reads the lines "key: value" that `write_header` writes as history; the library splits long ones. A key may
// end in the name of a channel, which contains letters, digits, '_', '.' and '-'.
void read_history(fitsfile* fits, RawPicture& raw) {
  constexpr std::size_t kName = 8;
  constexpr std::size_t kCut = 72;
  const std::regex key("([A-Za-z][A-Za-z0-9_.-]*): (.*)");
  int status = 0;
  int count = 0;
  fits_get_hdrspace(fits, &count, nullptr, &status);
  std::string* last = nullptr;
  std::size_t cards = 0;
  for (int i = 1; i <= count; ++i) {
    std::array<char, FLEN_CARD> card{};
    if (fits_read_record(fits, i, card.data(), &status) != 0) return;
    const std::string line(card.data());
    if (!line.starts_with("HISTORY ")) continue;
    std::smatch found;
    const std::string text = line.substr(kName);
    if (std::regex_match(text, found, key)) {
      last = &(raw.metadata[found[1]] = found[2]);
      cards = static_cast<std::size_t>(found.position(2));
    } else if (last != nullptr) {
      last->resize((cards + last->size() + kCut - 1) / kCut * kCut - cards, ' ');
      *last += text;
    }
  }
}

// Expected code without light. Programs disagree on the meaning of negative values: some mean a level that
// was subtracted, others the level with the opposite sign.
double pedestal_of(fitsfile* fits, const std::string& path) {
  const double pedestal = number_of(fits, "PEDESTAL", 0);
  if (pedestal >= 0) return pedestal;
  std::ostringstream negative;
  negative << "PEDESTAL is negative, which programs interpret differently (got " << pedestal
           << ", allowed the code without light, 0 or more)";
  throw Error(ErrorCode::input, path, negative.str());
}

std::vector<std::uint16_t> read_codes(fitsfile* fits, const std::string& path, std::size_t count) {
  std::vector<int> numbers(count);
  int status = 0;
  int undefined = -1;
  int any_undefined = 0;
  fits_read_img(fits, TINT, 1, static_cast<LONGLONG>(count), &undefined, numbers.data(), &any_undefined,
                &status);
  if (status != 0) throw Error(ErrorCode::input, path, "truncated or corrupt");
  if (any_undefined != 0)
    throw Error(ErrorCode::input, path,
                "pixels are undefined (they hold the value BLANK; every pixel needs a code)");
  if (const auto lowest = std::min_element(numbers.begin(), numbers.end()); *lowest < 0)
    throw Error(ErrorCode::input, path,
                "a pixel is below 0 (got " + std::to_string(*lowest) + ", allowed 0 to 65535)");
  return {numbers.begin(), numbers.end()};
}

// Reads an image of floats, as programs that calibrate frames write it. The codes are rounded. Unless all
// values are whole, `corrected` becomes the values minus the black level, in the order of the file.
std::vector<std::uint16_t> read_float_codes(fitsfile* fits, const std::string& path, std::size_t count,
                                            double black_level_dn, std::vector<float>& corrected) {
  constexpr float kMaxCode = 65535;
  std::vector<float> numbers(count);
  int status = 0;
  fits_read_img(fits, TFLOAT, 1, static_cast<LONGLONG>(count), nullptr, numbers.data(), nullptr, &status);
  if (status != 0) throw Error(ErrorCode::input, path, "truncated or corrupt");
  if (!std::ranges::all_of(numbers, [](float value) { return std::isfinite(value); }))
    throw Error(ErrorCode::input, path,
                "pixels are undefined (they are not finite; every pixel needs a code)");
  const float highest = *std::ranges::max_element(numbers);
  if (!(highest > 1 && highest <= kMaxCode)) {
    std::ostringstream range;
    range << "the largest pixel is no code (got " << highest << ", allowed above 1, at most " << kMaxCode
          << ')';
    throw Error(ErrorCode::input, path, range.str());
  }
  std::vector<std::uint16_t> codes;
  codes.reserve(count);
  bool is_whole = true;
  for (const float value : numbers) {
    const float code = std::max(std::round(value), 0.0F);
    is_whole = is_whole && code == value;
    codes.push_back(static_cast<std::uint16_t>(code));
  }
  if (!is_whole)
    for (const float value : numbers)
      corrected.push_back(static_cast<float>(static_cast<double>(value) - black_level_dn));
  return codes;
}

// Largest code of an image whose scaled values have that type.
double greatest_code(fitsfile* fits, int type) {
  const double of_type = type == BYTE_IMG ? 255 : type == SHORT_IMG ? 32767 : 65535;
  int stored = 0;
  int status = 0;
  if (fits_get_img_type(fits, &stored, &status) != 0 || stored != BYTE_IMG) return of_type;
  const double zero = number_of(fits, "BZERO", 0);
  return std::min(of_type, std::max(zero, zero + 255 * number_of(fits, "BSCALE", 1)));
}

// Largest code that the image can hold, or its header's saturation level if that is smaller. Some programs
// write 0 for an unknown level.
double white_level_of(fitsfile* fits, int type, double black_level_dn) {
  const double greatest = greatest_code(fits, type);
  const double saturate = number_of(fits, "SATURATE", greatest);
  return saturate > black_level_dn ? std::min(saturate, greatest) : greatest;
}

// Opens a file by its exact name and moves to its first image with pixels. Other functions of the library
// interpret brackets in the name. This one interprets leading blanks and '~', which an absolute path does not
// have.
void open_image(fitsfile** fits, const std::string& path, int& status) {
  fits_open_diskfile(fits, std::filesystem::absolute(path).c_str(), READONLY, &status);
  while (status == 0) {
    int kind = 0;
    int axes = 0;
    fits_get_hdu_type(*fits, &kind, &status);
    if (kind == IMAGE_HDU) fits_get_img_dim(*fits, &axes, &status);
    if (status != 0 || axes > 0) return;
    fits_movrel_hdu(*fits, 1, nullptr, &status);
  }
}

void flip(RawPicture& raw) {
  const auto row = static_cast<std::ptrdiff_t>(raw.planes.size()) * raw.width;
  const auto flip_rows = [&](auto& values) {
    for (std::ptrdiff_t y = 0; y < raw.height / 2; ++y)
      std::swap_ranges(values.begin() + y * row, values.begin() + (y + 1) * row,
                       values.begin() + (raw.height - 1 - y) * row);
  };
  flip_rows(raw.codes);
  if (!raw.corrected.empty()) flip_rows(raw.corrected);
}

}  // namespace

RawPicture read_fits(const std::string& path) {
  int status = 0;
  MemoryFits file;
  open_image(&file.fits, path, status);
  int type = 0;
  int axes = 0;
  std::array<long, 3> size{1, 1, 1};
  fits_get_img_equivtype(file.fits, &type, &status);
  fits_get_img_dim(file.fits, &axes, &status);
  fits_get_img_size(file.fits, 3, size.data(), &status);
  if (status != 0) throw Error(ErrorCode::input, path, "not a FITS image, or damaged");
  const bool is_float = type == FLOAT_IMG || type == DOUBLE_IMG;
  if (axes < 2 || axes > 3 || (type != USHORT_IMG && type != SHORT_IMG && type != BYTE_IMG && !is_float))
    throw Error(ErrorCode::input, path,
                "not an image of 8-bit or 16-bit integers or of floats with two or three axes");
  RawPicture raw;
  raw.width = size[0];
  raw.height = size[1];
  const auto planes = static_cast<std::size_t>(size[2]);
  require_image_size(path, raw.width, raw.height, planes);
  raw.planes = raw.channels = plane_names(text_of(file.fits, "PLANES"), planes);
  const std::size_t pixels = static_cast<std::size_t>(raw.width) * static_cast<std::size_t>(raw.height);
  raw.black_level_dn = pedestal_of(file.fits, path);
  std::vector<float> corrected;
  raw.codes = pixel_by_pixel(
      is_float ? read_float_codes(file.fits, path, pixels * planes, raw.black_level_dn, corrected)
               : read_codes(file.fits, path, pixels * planes),
      planes);
  raw.corrected = pixel_by_pixel(corrected, planes);
  if (text_of(file.fits, "ROWORDER") == "BOTTOM-UP") flip(raw);
  read_history(file.fits, raw);
  read_pattern(file.fits, path, raw);
  raw.white_level_dn = white_level_of(file.fits, type, raw.black_level_dn);
  raw.gain_e_per_dn = number_of(file.fits, "GAIN", 1);
  if (const double seconds = number_of(file.fits, "EXPTIME", 0); seconds > 0) raw.exposure_s = seconds;
  return raw;
}

std::string encode_fits(const std::string& path, const RawPicture& raw) {
  constexpr std::size_t kBlock = 2880;
  int status = 0;
  MemoryFits file;
  file.bytes = std::malloc(kBlock);
  file.size = kBlock;
  fits_create_memfile(&file.fits, &file.bytes, &file.size, kBlock, std::realloc, &status);
  std::array<long, 3> axes{raw.width, raw.height, static_cast<long>(raw.planes.size())};
  fits_create_img(file.fits, USHORT_IMG, raw.planes.size() > 1 ? 3 : 2, axes.data(), &status);
  write_header({file.fits, status}, raw);
  std::vector<std::uint16_t> codes = plane_by_plane(raw);
  fits_write_img(file.fits, TUSHORT, 1, static_cast<LONGLONG>(codes.size()), codes.data(), &status);
  fits_flush_file(file.fits, &status);
  LONGLONG end = 0;
  fits_get_hduaddrll(file.fits, nullptr, nullptr, &end, &status);
  if (status != 0) fail(path, status);
  std::string bytes(static_cast<const char*>(file.bytes), static_cast<std::size_t>(end));
  if (!reads_back(bytes, codes)) throw Error(ErrorCode::output, path, "the encoded FITS does not read back");
  return bytes;
}

}  // namespace abbe::picture_module
