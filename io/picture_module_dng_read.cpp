// Raw files for the developers of photographs: DNG through libtiff, read.
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

// The lines "key: value" of the description, as `set_names` writes them.
void read_lines(TIFF* tiff, RawPicture& raw) {
  char* lines = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &lines) == 1) raw.metadata["ImageDescription"] = lines;
}

// The names that the description lists under a key.
std::vector<std::string> told_names(const RawPicture& raw, const std::string& key) {
  const auto description = raw.metadata.find("ImageDescription");
  std::istringstream lines(description == raw.metadata.end() ? "" : description->second);
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(key + ": ")) continue;
    std::istringstream told(line.substr(key.size() + 2));
    for (std::string name; std::getline(told, name, ',');) names.push_back(name);
  }
  return names;
}

// The channels of a DNG in its order: red, green and blue, unless its description names three others.
std::vector<std::string> channels_of(const RawPicture& raw, const std::string& key) {
  const std::vector<std::string> names = told_names(raw, key);
  if (names.size() != 3) return {"R", "G", "B"};
  const auto order = rgb_order(names);
  return order ? std::vector{names[(*order)[0]], names[(*order)[1]], names[(*order)[2]]} : names;
}

// The filters of a mosaic, row by row; none where there is no mosaic.
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
    throw Error(ErrorCode::input, TIFFFileName(tiff), "it does not tell the pattern of its mosaic");
  if (const std::uint8_t most = *std::max_element(filters, filters + count); most > 2)
    throw Error(ErrorCode::input, TIFFFileName(tiff),
                "its mosaic has filters other than red, green and blue (got number " + std::to_string(most) +
                    ", allowed 0 to 2)");
  width = repeats[1];
  return {filters, filters + count};
}

// The planes of a DNG and the channels of its pattern.
void read_layout(TIFF* tiff, RawPicture& raw) {
  raw.mosaic = read_pattern(tiff, raw.mosaic_width);
  if (raw.mosaic_width > 0) {
    raw.channels = channels_of(raw, "mosaic_channels");
    raw.planes = {"raw"};
    return;
  }
  if (raw.planes.size() == 3)
    raw.planes = channels_of(raw, "sensor_channels");
  else if (auto names = told_names(raw, "sensor_channels"); names.size() == raw.planes.size())
    raw.planes = std::move(names);
  raw.channels = raw.planes;
}

// The level that a tag tells of each filter or plane, in place of `level` where the file has the tag.
template <typename Number>
void read_level(TIFF* tiff, std::uint32_t tag, const char* name, double& level) {
  std::uint16_t count = 0;
  Number* told = nullptr;
  if (TIFFGetField(tiff, tag, &count, &told) != 1 || count == 0) return;
  const auto [least, greatest] = std::minmax_element(told, told + count);
  if (*least != *greatest) {
    std::ostringstream differs;
    differs << "filters or planes have a " << name << " of their own (got from " << *least << " to "
            << *greatest << ", allowed one for all)";
    throw Error(ErrorCode::input, TIFFFileName(tiff), differs.str());
  }
  level = static_cast<double>(*told);
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

// Levels of single rows and columns are refused.
void require_even_black(TIFF* tiff) {
  for (const std::uint32_t tag : {TIFFTAG_BLACKLEVELDELTAH, TIFFTAG_BLACKLEVELDELTAV}) {
    std::uint16_t count = 0;
    const float* deltas = nullptr;
    if (TIFFGetField(tiff, tag, &count, &deltas) == 1 &&
        std::any_of(deltas, deltas + count, [](float delta) { return delta != 0; }))
      throw Error(ErrorCode::input, TIFFFileName(tiff),
                  "rows or columns have a black level of their own (BlackLevelDeltaV or BlackLevelDeltaH; "
                  "allowed one for all)");
  }
}

// Without the border that no light comes to: mosaics begin at its inner corner [DNG, "ActiveArea"].
void keep_active_area(TIFF* tiff, RawPicture& raw) {
  const std::uint32_t* area = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_ACTIVEAREA, &area) != 1) return;
  const std::size_t top = area[0];
  const std::size_t left = area[1];
  const std::size_t bottom = area[2];
  const std::size_t right = area[3];
  const auto width = static_cast<std::size_t>(raw.width);
  if (top >= bottom || left >= right || bottom > static_cast<std::size_t>(raw.height) || right > width)
    throw Error(ErrorCode::input, TIFFFileName(tiff), "its ActiveArea is no part of it");
  const std::size_t planes = raw.planes.size();
  std::vector<std::uint16_t> lit;
  lit.reserve((bottom - top) * (right - left) * planes);
  for (std::size_t y = top; y < bottom; ++y) {
    const auto row = raw.codes.begin() + static_cast<std::ptrdiff_t>(y * width * planes);
    lit.insert(lit.end(), row + static_cast<std::ptrdiff_t>(left * planes),
               row + static_cast<std::ptrdiff_t>(right * planes));
  }
  raw.codes = std::move(lit);
  raw.width = static_cast<decltype(raw.width)>(right - left);
  raw.height = static_cast<decltype(raw.height)>(bottom - top);
}

// The opcode list of that number; an empty one where the file has none.
OpcodeList read_opcodes(TIFF* tiff, int list, RawPicture& raw) {
  std::uint32_t count = 0;
  const std::uint8_t* bytes = nullptr;
  if (TIFFGetField(tiff, kOpcodeLists.at(static_cast<std::size_t>(list - 1)), &count, &bytes) != 1) return {};
  OpcodeList parsed = parse_opcodes({bytes, count}, list, TIFFFileName(tiff));
  raw.opcodes.insert(raw.opcodes.end(), parsed.names.begin(), parsed.names.end());
  return parsed;
}

// List 1 works on the codes as stored, which are the argument of its polynomials too.
void apply_first_opcodes(TIFF* tiff, RawPicture& raw) {
  const OpcodeList list = read_opcodes(tiff, 1, raw);
  if (list.opcodes.empty()) return;
  std::vector<float> values(raw.codes.begin(), raw.codes.end());
  apply_opcodes(list.opcodes, {raw.width, raw.height, raw.planes.size(), values, 1});
  std::transform(values.begin(), values.end(), raw.codes.begin(), [](float value) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0F, 65535.0F)));
  });
}

// Lists 2 and 3 work on values that are 0 at black and 1 at the white level. The second sees the planes that
// are stored, the third those of the demosaicked picture, of which a mosaic has each pixel's own.
void apply_later_opcodes(TIFF* tiff, RawPicture& raw) {
  const OpcodeList stored = read_opcodes(tiff, 2, raw);
  const OpcodeList demosaicked = read_opcodes(tiff, 3, raw);
  if (stored.opcodes.empty() && demosaicked.opcodes.empty()) return;
  for (const std::uint16_t code : raw.codes)
    raw.corrected.push_back(static_cast<float>(code - raw.black_level_dn));
  const double unit = raw.white_level_dn - raw.black_level_dn;
  if (!(unit > 0))
    throw Error(ErrorCode::input, TIFFFileName(tiff),
                "its white level is not above its black level, between which its opcodes work");
  OpcodeImage image{raw.width, raw.height, raw.planes.size(), raw.corrected, unit};
  apply_opcodes(stored.opcodes, image);
  image.mosaic = raw.mosaic;
  image.mosaic_width = raw.mosaic_width;
  apply_opcodes(demosaicked.opcodes, image);
}

// The exposure time, of which the folder of Exif tells, beside the first picture; the last to be read, since
// it leaves the image.
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
                "its raw picture has no strips of 16-bit numbers (got " +
                    std::string(TIFFIsTiled(tiff) != 0 ? "tiles" : "strips") + " of " + std::to_string(bits) +
                    " bits); a raw converter can make an uncompressed DNG of it");
  if (format != SAMPLEFORMAT_UINT)
    throw Error(ErrorCode::input, TIFFFileName(tiff),
                "its raw picture has no whole numbers without sign (got SampleFormat " +
                    std::to_string(format) + ", allowed 1)");
}

// What a folder of a TIFF says that its picture is.
struct PictureKind {
  std::uint32_t subfile = 0;
  std::uint16_t photometric = 0;

  // A picture made of the raw one, such as a preview, has colours and tones of its own.
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

// Goes to the raw picture: the first of the file or, where that is a preview, of the folders within [DNG,
// "DNG File Structure"].
void find_raw(TIFF* tiff) {
  const PictureKind first = kind_of(tiff);
  if (first.is_raw()) return;
  std::uint16_t count = 0;
  const toff_t* within = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_SUBIFD, &count, &within) == 1)
    for (const toff_t folder : std::vector<toff_t>(within, within + count))
      if (TIFFSetSubDirectory(tiff, folder) == 1 && kind_of(tiff).is_raw()) return;
  throw Error(ErrorCode::input, TIFFFileName(tiff),
              "it holds no raw picture (got NewSubfileType " + std::to_string(first.subfile) +
                  " and PhotometricInterpretation " + std::to_string(first.photometric) +
                  " first, allowed 0 and 32803 or 34892, or such a picture among its SubIFDs)");
}

void require_rectangular(TIFF* tiff) {
  std::uint16_t layout = 1;
  TIFFGetField(tiff, TIFFTAG_CFALAYOUT, &layout);
  if (layout != 1)
    throw Error(
        ErrorCode::input, TIFFFileName(tiff),
        "the filters of its mosaic are staggered (got CFALayout " + std::to_string(layout) + ", allowed 1)");
}

// Strip by strip, or nothing where libtiff cannot undo the compression.
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
  return "its raw picture is damaged, or compressed as is not read here (got Compression " +
         std::to_string(compression) + "); a raw converter can make an uncompressed DNG of it";
}

}  // namespace

RawPicture read_dng(const std::string& path) {
  teach_dng_tags();
  const Tiff tiff(TIFFOpenExt(path.c_str(), "r", quiet_tiff().get()), TIFFClose);
  if (!tiff) throw Error(ErrorCode::input, path, "no DNG, or a damaged one");
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
