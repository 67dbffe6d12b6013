// Reads DNG files with libtiff.
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "io/error.h"
#include "io/image.h"
#include "io/picture_module.h"
#include "io/picture_module_dng.h"
#include "io/picture_module_dng_opcodes.h"
#include "io/rgb_order.h"

namespace abbe::picture_module {
namespace {

// Reads the description, whose lines "key: value" `set_names` wrote.
void read_lines(TIFF* tiff, RawPicture& raw) {
  char* lines = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &lines) == 1) raw.metadata["ImageDescription"] = lines;
}

// The comma-separated names in the description's line `key`.
std::vector<std::string> recorded_names(const RawPicture& raw, const std::string& key) {
  const auto description = raw.metadata.find("ImageDescription");
  std::istringstream lines(description == raw.metadata.end() ? "" : description->second);
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(key + ": ")) continue;
    std::istringstream items(line.substr(key.size() + 2));
    for (std::string name; std::getline(items, name, ',');) names.push_back(name);
  }
  return names;
}

// The channels of a DNG in its order: red, green and blue, unless its description names three others.
std::vector<std::string> channels_of(const RawPicture& raw, const std::string& key) {
  const std::vector<std::string> names = recorded_names(raw, key);
  if (names.size() != 3) return {"R", "G", "B"};
  const auto order = rgb_order(names);
  return order ? std::vector{names[(*order)[0]], names[(*order)[1]], names[(*order)[2]]} : names;
}

// The filter of each pixel of the mosaic pattern, row by row; empty without a mosaic.
std::vector<std::uint8_t> read_pattern(TIFF* tiff, std::int64_t& width) {
  std::uint16_t photometric = 0;
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  if (photometric != PHOTOMETRIC_CFA) return {};
  const std::uint16_t* repeats = nullptr;
  std::uint16_t count = 0;
  const std::uint8_t* filters = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_CFAREPEATPATTERNDIM, &repeats) != 1 ||
      TIFFGetField(tiff, TIFFTAG_CFAPATTERN, &count, &filters) != 1 || count == 0 ||
      count != repeats[0] * repeats[1])
    throw Error(ErrorCode::input, TIFFFileName(tiff),
                "the mosaic pattern is missing (CFARepeatPatternDim, CFAPattern)");
  if (const std::uint8_t max_filter = *std::max_element(filters, filters + count); max_filter > 2)
    throw Error(ErrorCode::input, TIFFFileName(tiff),
                "the mosaic has filters other than red, green and blue (got number " +
                    std::to_string(max_filter) + ", allowed 0 to 2)");
  width = repeats[1];
  return {filters, filters + count};
}

// Reads the planes and the channels of the mosaic.
void read_layout(TIFF* tiff, RawPicture& raw) {
  raw.mosaic = read_pattern(tiff, raw.mosaic_width);
  if (raw.mosaic_width > 0) {
    raw.channels = channels_of(raw, "mosaic_channels");
    raw.planes = {"raw"};
    return;
  }
  if (raw.planes.size() == 3)
    raw.planes = channels_of(raw, "sensor_channels");
  else if (auto names = recorded_names(raw, "sensor_channels"); names.size() == raw.planes.size())
    raw.planes = std::move(names);
  raw.channels = raw.planes;
}

// Replaces `level` by the value of a tag, if present. Throws if its values differ between filters or planes.
template <typename Number>
void read_level(TIFF* tiff, std::uint32_t tag, const char* name, double& level) {
  std::uint16_t count = 0;
  Number* levels = nullptr;
  if (TIFFGetField(tiff, tag, &count, &levels) != 1 || count == 0) return;
  const auto [lowest, highest] = std::minmax_element(levels, levels + count);
  if (*lowest != *highest) {
    std::ostringstream differs;
    differs << "filters or planes differ in their " << name << " (got " << *lowest << " to " << *highest
            << ", allowed one value)";
    throw Error(ErrorCode::input, TIFFFileName(tiff), differs.str());
  }
  level = static_cast<double>(*levels);
}

void read_levels(TIFF* tiff, RawPicture& raw) {
  read_level<float>(tiff, TIFFTAG_BLACKLEVEL, "black level", raw.black_level_dn);
  read_level<std::uint32_t>(tiff, TIFFTAG_WHITELEVEL, "white level", raw.white_level_dn);
  std::uint16_t count = 0;
  std::uint16_t* table = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_LINEARIZATIONTABLE, &count, &table) == 1 && count > 0) {
    raw.is_linearised = true;
    for (std::uint16_t& code : raw.codes) code = table[std::min<std::size_t>(code, count - 1U)];
  }
}

// Rejects black levels that differ between rows or columns.
void require_even_black(TIFF* tiff) {
  for (const std::uint32_t tag : {TIFFTAG_BLACKLEVELDELTAH, TIFFTAG_BLACKLEVELDELTAV}) {
    std::uint16_t count = 0;
    const float* deltas = nullptr;
    if (TIFFGetField(tiff, tag, &count, &deltas) == 1 &&
        std::any_of(deltas, deltas + count, [](float delta) { return delta != 0; }))
      throw Error(ErrorCode::input, TIFFFileName(tiff),
                  "rows or columns differ in their black level (BlackLevelDeltaV or BlackLevelDeltaH; "
                  "allowed one value)");
  }
}

// Removes the border that light does not reach: the mosaic begins at the corner of the active area [DNG,
// "ActiveArea"].
void keep_active_area(TIFF* tiff, RawPicture& raw) {
  const std::uint32_t* area = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_ACTIVEAREA, &area) != 1) return;
  const std::size_t top = area[0];
  const std::size_t left = area[1];
  const std::size_t bottom = area[2];
  const std::size_t right = area[3];
  const auto width = static_cast<std::size_t>(raw.width);
  if (top >= bottom || left >= right || bottom > static_cast<std::size_t>(raw.height) || right > width)
    throw Error(ErrorCode::input, TIFFFileName(tiff), "the ActiveArea is not inside the image");
  const std::size_t planes = raw.planes.size();
  std::vector<std::uint16_t> active;
  active.reserve((bottom - top) * (right - left) * planes);
  for (std::size_t y = top; y < bottom; ++y) {
    const auto row = raw.codes.begin() + static_cast<std::ptrdiff_t>(y * width * planes);
    active.insert(active.end(), row + static_cast<std::ptrdiff_t>(left * planes),
                  row + static_cast<std::ptrdiff_t>(right * planes));
  }
  raw.codes = std::move(active);
  raw.width = static_cast<decltype(raw.width)>(right - left);
  raw.height = static_cast<decltype(raw.height)>(bottom - top);
}

// Opcode list number `list`; empty if the file has none.
OpcodeList read_opcodes(TIFF* tiff, int list, RawPicture& raw) {
  std::uint32_t count = 0;
  const std::uint8_t* bytes = nullptr;
  if (TIFFGetField(tiff, kOpcodeLists.at(static_cast<std::size_t>(list - 1)), &count, &bytes) != 1) return {};
  OpcodeList parsed = parse_opcodes({bytes, count}, list, TIFFFileName(tiff));
  raw.opcodes.insert(raw.opcodes.end(), parsed.names.begin(), parsed.names.end());
  return parsed;
}

// Applies list 1 to the stored codes, which are also the argument of its polynomials.
void apply_first_opcodes(TIFF* tiff, RawPicture& raw) {
  const OpcodeList list = read_opcodes(tiff, 1, raw);
  if (list.opcodes.empty()) return;
  std::vector<float> values(raw.codes.begin(), raw.codes.end());
  apply_opcodes(list.opcodes, {raw.width, raw.height, raw.planes.size(), values, 1});
  std::transform(values.begin(), values.end(), raw.codes.begin(), [](float value) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0F, 65535.0F)));
  });
}

// Applies lists 2 and 3 to values that are 0 at the black and 1 at the white level. List 2 addresses the
// stored planes. List 3 addresses the planes of the demosaicked picture, of which a mosaic pixel has one.
void apply_later_opcodes(TIFF* tiff, RawPicture& raw) {
  const OpcodeList stored = read_opcodes(tiff, 2, raw);
  const OpcodeList demosaicked = read_opcodes(tiff, 3, raw);
  if (stored.opcodes.empty() && demosaicked.opcodes.empty()) return;
  for (const std::uint16_t code : raw.codes)
    raw.corrected.push_back(static_cast<float>(code - raw.black_level_dn));
  const double unit = raw.white_level_dn - raw.black_level_dn;
  if (!(unit > 0))
    throw Error(ErrorCode::input, TIFFFileName(tiff),
                "the white level must exceed the black level to apply opcodes");
  OpcodeImage image{raw.width, raw.height, raw.planes.size(), raw.corrected, unit};
  apply_opcodes(stored.opcodes, image);
  image.mosaic = raw.mosaic;
  image.mosaic_width = raw.mosaic_width;
  apply_opcodes(demosaicked.opcodes, image);
}

// Reads the exposure time from the Exif folder of the first picture. It must be read last: it leaves the raw
// picture.
void read_exposure(TIFF* tiff, RawPicture& raw) {
  toff_t folder = 0;
  float seconds = 0;
  if (TIFFSetDirectory(tiff, 0) == 1 && TIFFGetField(tiff, TIFFTAG_EXIFIFD, &folder) == 1 &&
      TIFFReadEXIFDirectory(tiff, folder) == 1 && TIFFGetField(tiff, EXIFTAG_EXPOSURETIME, &seconds) == 1 &&
      seconds > 0)
    raw.exposure_s = static_cast<double>(seconds);
}

void require_codes(TIFF* tiff) {
  std::uint16_t bits = 0;
  std::uint16_t format = 0;
  TIFFGetField(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
  if (bits != 16 || TIFFIsTiled(tiff) != 0)
    throw Error(ErrorCode::input, TIFFFileName(tiff),
                "the raw picture is not stored as strips of 16-bit numbers (got " +
                    std::string(TIFFIsTiled(tiff) != 0 ? "tiles" : "strips") + " of " + std::to_string(bits) +
                    " bits); convert it to an uncompressed DNG with a raw converter");
  if (format != SAMPLEFORMAT_UINT)
    throw Error(ErrorCode::input, TIFFFileName(tiff),
                "the raw picture is not stored as unsigned integers (got SampleFormat " +
                    std::to_string(format) + ", allowed 1)");
}

// Type of the picture in a TIFF folder.
struct PictureKind {
  std::uint32_t subfile = 0;
  std::uint16_t photometric = 0;

  // True for a raw picture. A picture derived from it, such as a preview, has been developed.
  [[nodiscard]] bool is_raw() const {
    return subfile == 0 && (photometric == PHOTOMETRIC_CFA || photometric == kLinearRaw);
  }
};

PictureKind kind_of(TIFF* tiff) {
  PictureKind kind;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SUBFILETYPE, &kind.subfile);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &kind.photometric);
  return kind;
}

// Moves to the raw picture: the first of the file or, if that is a preview, one of its SubIFDs [DNG, "DNG
// File Structure"].
void find_raw(TIFF* tiff) {
  const PictureKind first = kind_of(tiff);
  if (first.is_raw()) return;
  std::uint16_t count = 0;
  const toff_t* within = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_SUBIFD, &count, &within) == 1)
    for (const toff_t folder : std::vector<toff_t>(within, within + count))
      if (TIFFSetSubDirectory(tiff, folder) == 1 && kind_of(tiff).is_raw()) return;
  throw Error(ErrorCode::input, TIFFFileName(tiff),
              "no raw picture in the file (got NewSubfileType " + std::to_string(first.subfile) +
                  " and PhotometricInterpretation " + std::to_string(first.photometric) +
                  " first, allowed 0 and 32803 or 34892, or such a picture among its SubIFDs)");
}

void require_rectangular(TIFF* tiff) {
  std::uint16_t layout = 1;
  TIFFGetField(tiff, TIFFTAG_CFALAYOUT, &layout);
  if (layout != 1)
    throw Error(ErrorCode::input, TIFFFileName(tiff),
                "the mosaic filters are staggered (got CFALayout " + std::to_string(layout) + ", allowed 1)");
}

// Reads all strips. False if libtiff cannot decompress them.
bool read_codes(TIFF* tiff, RawPicture& raw) {
  const std::uint32_t strips = TIFFNumberOfStrips(tiff);
  std::size_t at = 0;
  for (std::uint32_t strip = 0; strip < strips; ++strip) {
    const std::size_t left = (raw.codes.size() - at) * sizeof(std::uint16_t);
    const tmsize_t got =
        TIFFReadEncodedStrip(tiff, strip, raw.codes.data() + at, static_cast<tmsize_t>(left));
    if (got <= 0) return false;
    at += static_cast<std::size_t>(got) / sizeof(std::uint16_t);
  }
  std::uint16_t layout = PLANARCONFIG_CONTIG;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &layout);
  if (layout == PLANARCONFIG_SEPARATE) raw.codes = pixel_by_pixel(raw.codes, raw.planes.size());
  return at == raw.codes.size();
}

std::string why_unreadable(TIFF* tiff) {
  std::uint16_t compression = COMPRESSION_NONE;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
  if (compression == COMPRESSION_NONE) return "truncated or corrupt";
  return "the raw picture is damaged or has an unsupported compression (got Compression " +
         std::to_string(compression) + "); convert it to an uncompressed DNG with a raw converter";
}

}  // namespace

RawPicture read_dng(const std::string& path) {
  register_dng_tags();
  const Tiff tiff(TIFFOpenExt(path.c_str(), "r", quiet_tiff().get()), TIFFClose);
  if (!tiff) throw Error(ErrorCode::input, path, "not a DNG file, or damaged");
  RawPicture raw;
  read_lines(tiff.get(), raw);
  find_raw(tiff.get());
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint16_t samples = 1;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, &samples);
  require_image_size(path, width, height, samples);
  require_codes(tiff.get());
  require_rectangular(tiff.get());
  raw.width = width;
  raw.height = height;
  for (int k = 0; k < samples; ++k) raw.planes.push_back(samples == 1 ? "raw" : std::to_string(k));
  raw.codes.resize(static_cast<std::size_t>(width) * height * samples);
  if (!read_codes(tiff.get(), raw)) throw Error(ErrorCode::input, path, why_unreadable(tiff.get()));
  apply_first_opcodes(tiff.get(), raw);
  read_layout(tiff.get(), raw);
  read_levels(tiff.get(), raw);
  require_even_black(tiff.get());
  keep_active_area(tiff.get(), raw);
  apply_later_opcodes(tiff.get(), raw);
  read_exposure(tiff.get(), raw);
  return raw;
}
}  // namespace abbe::picture_module
