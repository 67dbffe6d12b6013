// Opcode lists of a DNG [DNG, ch. 7]: corrections that the camera maker requests from readers.
#include "io/picture_module_dng_opcodes.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "io/error.h"
#include "io/picture_module.h"

namespace abbe::picture_module {
namespace {

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
  std::uint32_t integer() {
    const std::uint32_t number = big_endian(take(4), 0);
    return number;
  }
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

}  // namespace

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

void apply_opcodes(const std::vector<PixelOpcode>& opcodes, const OpcodeImage& image) {
  for (const PixelOpcode& opcode : opcodes) apply_opcode(opcode, image);
}

}  // namespace abbe::picture_module
