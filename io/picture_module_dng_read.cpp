// Reads DNG files with libtiff, and applies their opcode lists [DNG, ch. 7].
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <tiffio.h>

#include "io/error.h"
#include "io/image.h"
#include "io/picture_module.h"
#include "io/picture_module_dng.h"

namespace abbe::picture_module {

namespace {
/// Pixels that an opcode changes: every `row_pitch`-th row and `column_pitch`-th column from (`left`, `top`)
/// on, in `planes` planes from `plane` on. Rows and columns [px] are numbered from 0 at the top left. The
/// part outside the image is ignored.
struct OpcodeArea {
  std::uint32_t top, left, bottom, right;  ///< `bottom` and `right` are exclusive.
  std::uint32_t plane, planes;
  std::uint32_t row_pitch, column_pitch;  ///< At least 1.
};

/// A grid of gain factors for multiplication. Spacings and origins are fractions of the height and width of
/// the image from its top left corner. Gains are interpolated bilinearly at pixel centers and constant
/// outside the grid.
struct GainMap {
  std::uint32_t rows, columns;
  double row_spacing, column_spacing;
  double row_origin, column_origin;
  std::uint32_t planes;      ///< If fewer than those of the area, the last one serves for the rest.
  std::vector<float> gains;  ///< By row, by column, by plane.
};

/// An opcode that changes each pixel independently: a GainMap, or a MapPolynomial if `map.gains` is empty.
struct PixelOpcode {
  OpcodeArea area;
  GainMap map = {};
  std::vector<double> polynomial{};  ///< Coefficients of 1, x, x^2 and so on; at most degree 8.
};

struct OpcodeList {
  std::vector<PixelOpcode> opcodes;  ///< Supported opcodes, in order.
  std::vector<DngOpcode> names;      ///< All opcodes of the list.
};

/// Pixels to which opcodes are applied: values pixel by pixel, interleaved by plane.
struct OpcodeImage {
  std::int64_t width, height;
  std::size_t planes;
  std::span<float> values;
  double unit;  ///< A MapPolynomial p changes a value v to unit * p(v / unit).
  /// The mosaic pattern and its width if opcodes address the channels of the mosaic as planes; 0 otherwise.
  std::span<const std::uint8_t> mosaic = {};
  std::int64_t mosaic_width = 0;
};

constexpr std::uint32_t kMapPolynomial = 8;
constexpr std::uint32_t kGainMap = 9;
constexpr std::uint32_t kOptional = 1;  // Bit of an opcode's flags.
constexpr std::uint32_t kMaxDegree = 8;

std::string opcode_name(std::uint32_t id) {
  constexpr std::array kNames{
      "WarpRectilinear",  "WarpFisheye",     "FixVignetteRadial", "FixBadPixelsConstant",
      "FixBadPixelsList", "TrimBounds",      "MapTable",          "MapPolynomial",
      "GainMap",          "DeltaPerRow",     "DeltaPerColumn",    "ScalePerRow",
      "ScalePerColumn",   "WarpRectilinear2"};
  return id >= 1 && id <= kNames.size() ? kNames[id - 1] : "number " + std::to_string(id);
}

// Reads numbers in sequence. Opcodes are big-endian, whatever the byte order of the file.
class Cursor {
 public:
  Cursor(std::span<const std::uint8_t> bytes, const std::string& path, int list)
      : bytes_(bytes), path_(path), list_(list) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::input, path_, "OpcodeList" + std::to_string(list_) + " is damaged: " + what);
  }
  std::uint32_t integer() { return big_endian(take(4), 0); }
  float real32() { return finite(std::bit_cast<float>(integer())); }
  double real64() {
    const std::uint64_t high = integer();
    return finite(std::bit_cast<double>(high << 32 | integer()));
  }
  /// A cursor over the next `size` bytes.
  Cursor part(std::size_t size) { return {take(size), path_, list_}; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

 private:
  std::span<const std::uint8_t> take(std::size_t size) {
    if (size > bytes_.size()) fail("it ends within an opcode");
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }
  template <typename Real>
  Real finite(Real number) const {
    if (!std::isfinite(number)) fail("a number is not finite");
    return number;
  }

  std::span<const std::uint8_t> bytes_;
  const std::string& path_;
  int list_;
};

OpcodeArea read_area(Cursor& cursor) {
  OpcodeArea area{};
  for (std::uint32_t* number : {&area.top, &area.left, &area.bottom, &area.right, &area.plane, &area.planes,
                                &area.row_pitch, &area.column_pitch})
    *number = cursor.integer();
  if (area.row_pitch == 0 || area.column_pitch == 0) cursor.fail("an area has a pitch of 0");
  return area;
}

// Reads the parameters of a GainMap and checks that its gains fill the rest of the opcode.
GainMap read_gain_map(Cursor& cursor) {
  GainMap map{};
  map.rows = cursor.integer();
  map.columns = cursor.integer();
  for (double* number : {&map.row_spacing, &map.column_spacing, &map.row_origin, &map.column_origin})
    *number = cursor.real64();
  map.planes = cursor.integer();
  const bool is_sound = map.rows > 0 && map.columns > 0 && map.planes > 0 &&
                        (map.rows == 1 || map.row_spacing > 0) &&
                        (map.columns == 1 || map.column_spacing > 0);
  // The product of three 32-bit numbers fits into 128 bits.
  __extension__ using Wide = unsigned __int128;
  if (!is_sound || Wide{map.rows} * map.columns * map.planes != cursor.left() / sizeof(float))
    cursor.fail("a GainMap does not have the declared size");
  while (cursor.left() >= sizeof(float)) map.gains.push_back(cursor.real32());
  return map;
}

std::vector<double> read_polynomial(Cursor& cursor) {
  const std::uint32_t degree = cursor.integer();
  if (degree > kMaxDegree) cursor.fail("a MapPolynomial has a degree above 8");
  std::vector<double> coefficients;
  for (std::uint32_t k = 0; k <= degree; ++k) coefficients.push_back(cursor.real64());
  return coefficients;
}

// A position between two grid points: their indices and the weight of the second.
struct GridPosition {
  std::uint32_t first, second;
  double weight;
};
GridPosition grid_position(double fraction, double origin, double spacing, std::uint32_t points) {
  const double at = points == 1 ? 0 : (fraction - origin) / spacing;
  const double last = points - 1;
  if (at <= 0) return {0, 0, 0};
  if (at >= last) return {points - 1, points - 1, 0};
  const auto first = static_cast<std::uint32_t>(at);
  return {first, first + 1, at - first};
}

// Gain by bilinear interpolation, constant outside the grid. If the map has fewer planes than the area, its
// last plane is used for the rest.
double gain_at(const GainMap& map, const GridPosition& row, const GridPosition& column, std::uint32_t plane) {
  const std::size_t p = std::min(plane, map.planes - 1);
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return static_cast<double>(map.gains[(std::size_t{i} * map.columns + j) * map.planes + p]);
  };
  const double above = std::lerp(at(row.first, column.first), at(row.first, column.second), column.weight);
  const double below = std::lerp(at(row.second, column.first), at(row.second, column.second), column.weight);
  return std::lerp(above, below, row.weight);
}

double polynomial_at(const std::vector<double>& coefficients, double x) {
  double y = 0;
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) y = y * x + *c;
  return y;
}

// The plane number that opcodes use for a value: its plane, or the channel of its mosaic filter.
std::size_t plane_of(const OpcodeImage& image, std::int64_t x, std::int64_t y, std::size_t plane) {
  if (image.mosaic_width == 0) return plane;
  const std::int64_t rows = static_cast<std::int64_t>(image.mosaic.size()) / image.mosaic_width;
  return image.mosaic[static_cast<std::size_t>(y % rows * image.mosaic_width + x % image.mosaic_width)];
}

// Multiplies pixels by the gain of the map, or replaces value v by unit * p(v / unit) with the polynomial p.
void apply_opcode(const PixelOpcode& opcode, const OpcodeImage& image) {
  const auto& [area, map, polynomial] = opcode;
  const std::int64_t bottom = std::min<std::int64_t>(area.bottom, image.height);
  const std::int64_t right = std::min<std::int64_t>(area.right, image.width);
  for (std::int64_t y = area.top; y < bottom; y += area.row_pitch) {
    const double down = (static_cast<double>(y) + 0.5) / static_cast<double>(image.height);
    const GridPosition row =
        map.gains.empty() ? GridPosition{} : grid_position(down, map.row_origin, map.row_spacing, map.rows);
    for (std::int64_t x = area.left; x < right; x += area.column_pitch) {
      const double across = (static_cast<double>(x) + 0.5) / static_cast<double>(image.width);
      const GridPosition column =
          map.gains.empty() ? GridPosition{}
                            : grid_position(across, map.column_origin, map.column_spacing, map.columns);
      for (std::size_t k = 0; k < image.planes; ++k) {
        const std::size_t plane = plane_of(image, x, y, k);
        if (plane < area.plane || plane - area.plane >= area.planes) continue;
        float& value = image.values[static_cast<std::size_t>(y * image.width + x) * image.planes + k];
        value = static_cast<float>(
            map.gains.empty()
                ? image.unit * polynomial_at(polynomial, static_cast<double>(value) / image.unit)
                : static_cast<double>(value) *
                      gain_at(map, row, column, static_cast<std::uint32_t>(plane - area.plane)));
      }
    }
  }
}

// Opcode list number `list`, 1 to 3. Throws Error{input} if the bytes are damaged, or if a mandatory opcode
// is not supported.
OpcodeList parse_opcodes(std::span<const std::uint8_t> bytes, int list, const std::string& path) {
  OpcodeList parsed;
  Cursor cursor(bytes, path, list);
  for (std::uint32_t count = cursor.integer(); count > 0; --count) {
    const std::uint32_t id = cursor.integer();
    cursor.integer();  // Version of the format that introduced the opcode.
    const bool is_optional = (cursor.integer() & kOptional) != 0;
    Cursor parameters = cursor.part(cursor.integer());
    const bool is_applied = id == kGainMap || id == kMapPolynomial;
    const DngOpcode name{opcode_name(id), list, is_optional, is_applied};
    if (!is_applied && !is_optional)
      throw Error(ErrorCode::input, path,
                  "a mandatory correction is not supported (got the opcode " + name.text() +
                      ", allowed GainMap and MapPolynomial); convert the file to a linear picture with a raw "
                      "converter");
    parsed.names.push_back(name);
    if (!is_applied) continue;
    PixelOpcode opcode{read_area(parameters)};
    if (id == kGainMap)
      opcode.map = read_gain_map(parameters);
    else
      opcode.polynomial = read_polynomial(parameters);
    parsed.opcodes.push_back(std::move(opcode));
  }
  return parsed;
}

// Values are not clipped: saturation is decided by the stored code.
void apply_opcodes(const std::vector<PixelOpcode>& opcodes, const OpcodeImage& image) {
  for (const PixelOpcode& opcode : opcodes) apply_opcode(opcode, image);
}

[[noreturn]] void refuse(TIFF* tiff, const std::string& message) {
  throw Error(ErrorCode::input, TIFFFileName(tiff), message);
}

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
    refuse(tiff, "the mosaic pattern is missing (CFARepeatPatternDim, CFAPattern)");
  if (const std::uint8_t max_filter = *std::max_element(filters, filters + count); max_filter > 2)
    refuse(tiff, "the mosaic has filters other than red, green and blue (got number " +
                     std::to_string(max_filter) + ", allowed 0 to 2)");
  width = repeats[1];
  return {filters, filters + count};
}

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
    refuse(tiff, differs.str());
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

void require_even_black(TIFF* tiff) {
  for (const std::uint32_t tag : {TIFFTAG_BLACKLEVELDELTAH, TIFFTAG_BLACKLEVELDELTAV}) {
    std::uint16_t count = 0;
    const float* deltas = nullptr;
    if (TIFFGetField(tiff, tag, &count, &deltas) == 1 &&
        std::any_of(deltas, deltas + count, [](float delta) { return delta != 0; }))
      refuse(tiff,
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
    refuse(tiff, "the ActiveArea is not inside the image");
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
  if (!(unit > 0)) refuse(tiff, "the white level must exceed the black level to apply opcodes");
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
    refuse(tiff, "the raw picture is not stored as strips of 16-bit numbers (got " +
                     std::string(TIFFIsTiled(tiff) != 0 ? "tiles" : "strips") + " of " +
                     std::to_string(bits) + " bits); convert it to an uncompressed DNG with a raw converter");
  if (format != SAMPLEFORMAT_UINT)
    refuse(tiff, "the raw picture is not stored as unsigned integers (got SampleFormat " +
                     std::to_string(format) + ", allowed 1)");
}

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
  refuse(tiff, "no raw picture in the file (got NewSubfileType " + std::to_string(first.subfile) +
                   " and PhotometricInterpretation " + std::to_string(first.photometric) +
                   " first, allowed 0 and 32803 or 34892, or such a picture among its SubIFDs)");
}

void require_rectangular(TIFF* tiff) {
  std::uint16_t layout = 1;
  TIFFGetField(tiff, TIFFTAG_CFALAYOUT, &layout);
  if (layout != 1)
    refuse(tiff,
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
