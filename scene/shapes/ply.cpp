#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "io/text.h"
#include "scene/shapes/mesh_formats.h"

namespace abbe {
namespace {

/// How a value is stored.
struct Type {
  enum class Kind { none, integer, natural, real } kind = Kind::none;
  std::size_t bytes = 0;
};
/// One `property` of a PLY header; a list has a type for its count.
struct Property {
  std::string name;
  Type count;
  Type value;
  [[nodiscard]] bool is_list() const { return count.kind != Type::Kind::none; }
};
struct Element {
  std::string name;
  double count;
  std::vector<Property> properties;
};
struct Header {
  enum class Format { none, ascii, little_endian, big_endian } format = Format::none;
  std::vector<Element> elements;
  std::size_t bytes = 0;
};

Type type_named(std::string_view name) {
  using enum Type::Kind;
  struct Named {
    std::string_view name;
    Type type;
  };
  constexpr std::array<Named, 16> kTypes{{{"char", {integer, 1}},
                                          {"uchar", {natural, 1}},
                                          {"int8", {integer, 1}},
                                          {"uint8", {natural, 1}},
                                          {"short", {integer, 2}},
                                          {"ushort", {natural, 2}},
                                          {"int16", {integer, 2}},
                                          {"uint16", {natural, 2}},
                                          {"int", {integer, 4}},
                                          {"uint", {natural, 4}},
                                          {"int32", {integer, 4}},
                                          {"uint32", {natural, 4}},
                                          {"float", {real, 4}},
                                          {"float32", {real, 4}},
                                          {"double", {real, 8}},
                                          {"float64", {real, 8}}}};
  const auto* found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const Named& t) { return t.name == name; });
  return found == kTypes.end() ? Type{} : found->type;
}

// Takes one header line in; false when it is malformed.
bool take_line(const std::vector<std::string>& words, Header& header) {
  if (words[0] == "format") {
    if (words.size() < 2) return false;
    if (words[1] == "ascii") header.format = Header::Format::ascii;
    if (words[1] == "binary_little_endian") header.format = Header::Format::little_endian;
    if (words[1] == "binary_big_endian") header.format = Header::Format::big_endian;
    return header.format != Header::Format::none;
  }
  if (words[0] == "element") {
    const auto count = words.size() == 3 ? parse_number(words[2]) : std::nullopt;
    if (!count || *count < 0) return false;
    header.elements.push_back({words[1], *count, {}});
  } else if (words[0] == "property") {
    const bool list = words.size() == 5 && words[1] == "list";
    if (header.elements.empty() || (!list && words.size() != 3)) return false;
    const Property property{words.back(), list ? type_named(words[2]) : Type{},
                            type_named(words[list ? 3 : 1])};
    if (property.value.bytes == 0 || (list && property.count.bytes == 0)) return false;
    header.elements.back().properties.push_back(property);
  }
  return true;
}

std::optional<Header> read_header(std::string_view bytes) {
  Header header;
  for (bool first = true;; first = false) {
    const std::size_t end = bytes.find('\n', header.bytes);
    if (end == std::string_view::npos) return std::nullopt;
    const std::vector<std::string> words = split(bytes.substr(header.bytes, end - header.bytes), ' ');
    header.bytes = end + 1;
    if (first != (words[0] == "ply")) return std::nullopt;
    if (words[0] == "end_header") break;
    if (!take_line(words, header)) return std::nullopt;
  }
  const bool empty = std::any_of(header.elements.begin(), header.elements.end(),
                                 [](const Element& e) { return e.count > 0 && e.properties.empty(); });
  if (header.format == Header::Format::none || empty) return std::nullopt;
  return header;
}

/// Takes the values behind a header one by one.
class Body {
 public:
  Body(std::string_view bytes, const Header& header)
      : rest_(bytes.substr(header.bytes)), format_(header.format) {}

  /// Whether the rest may hold `count` entries of an element: what to know before allocating for them.
  [[nodiscard]] bool may_hold(const Element& element) const {
    double least = 0;
    for (const Property& property : element.properties)
      least +=
          static_cast<double>(ascii() ? 1 : (property.is_list() ? property.count : property.value).bytes);
    return element.count * least <= static_cast<double>(rest_.size());
  }

  /// Nothing at the end of the file. What is no number in a text is NaN.
  std::optional<double> take(const Type& type) {
    if (ascii()) {
      const std::string_view word = take_word();
      if (word.empty()) return std::nullopt;
      return parse_number(word).value_or(std::numeric_limits<double>::quiet_NaN());
    }
    if (rest_.size() < type.bytes) return std::nullopt;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < type.bytes; ++i)
      bits = bits << 8 | static_cast<unsigned char>(
                             rest_[format_ == Header::Format::big_endian ? i : type.bytes - 1 - i]);
    rest_.remove_prefix(type.bytes);
    return decoded(type, bits);
  }

  /// The length of a list that the file can hold.
  std::optional<double> take_count(const Property& list) {
    const auto count = take(list.count);
    const double least = ascii() ? 1 : static_cast<double>(list.value.bytes);
    if (!count || !(*count >= 0 && *count * least <= static_cast<double>(rest_.size()))) return std::nullopt;
    return count;
  }

 private:
  static constexpr std::string_view kBlanks = " \t\r\n";

  [[nodiscard]] bool ascii() const { return format_ == Header::Format::ascii; }

  std::string_view take_word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
    rest_.remove_prefix(word.size());
    return word;
  }

  static double decoded(const Type& type, std::uint64_t bits) {
    if (type.kind == Type::Kind::real)
      return type.bytes == 8 ? std::bit_cast<double>(bits)
                             : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    if (type.kind == Type::Kind::natural) return static_cast<double>(bits);
    const std::uint64_t sign = std::uint64_t{1} << (8 * type.bytes - 1);
    return static_cast<double>(bits) - ((bits & sign) != 0 ? 2 * static_cast<double>(sign) : 0);
  }

  std::string_view rest_;
  Header::Format format_;
};

// What names no vertex names the last there could be, and is reported with it.
std::uint32_t vertex_number(double x) {
  constexpr double kLast = std::numeric_limits<std::uint32_t>::max();
  return x >= 0 && x < kLast && x == std::floor(x) ? static_cast<std::uint32_t>(x)
                                                   : std::numeric_limits<std::uint32_t>::max();
}

bool take_vertices(Body& body, const Element& element, Mesh& mesh) {
  mesh.vertices.reserve(static_cast<std::size_t>(element.count));
  for (double i = 0; i < element.count; ++i) {
    Imath::V3d& vertex = mesh.vertices.emplace_back(0.0);
    for (const Property& property : element.properties) {
      double values = 1;
      if (property.is_list()) {
        const auto count = body.take_count(property);
        if (!count) return false;
        values = *count;
      }
      for (double k = 0; k < values; ++k) {
        const auto value = body.take(property.value);
        if (!value) return false;
        if (!property.is_list() && property.name.size() == 1 && property.name[0] >= 'x' &&
            property.name[0] <= 'z')
          vertex[property.name[0] - 'x'] = *value;
      }
    }
  }
  return true;
}

// Polygons are cut into the fan around their first corner.
bool take_faces(Body& body, const Element& element, Mesh& mesh) {
  mesh.triangles.reserve(static_cast<std::size_t>(element.count));
  for (double i = 0; i < element.count; ++i)
    for (const Property& property : element.properties) {
      const auto count = property.is_list() ? body.take_count(property) : 1.0;
      if (!count) return false;
      const bool corners = property.name == "vertex_indices" || property.name == "vertex_index";
      std::uint32_t first = 0;
      std::uint32_t last = 0;
      for (double k = 0; k < *count; ++k) {
        const auto value = body.take(property.value);
        if (!value) return false;
        if (!corners) continue;
        const std::uint32_t corner = vertex_number(*value);
        if (k == 0) first = corner;
        if (k >= 2) mesh.triangles.push_back({first, last, corner});
        last = corner;
      }
    }
  return true;
}

bool skip(Body& body, const Element& element) {
  Mesh ignored;
  const Element counted{element.name, element.count, element.properties};
  return take_faces(body, counted, ignored);
}

}  // namespace

bool read_ply(std::string_view bytes, MeshReading& reading) {
  constexpr const char* kPromises = "the header promises more than the file holds";
  const std::optional<Header> header = read_header(bytes);
  if (!header) return reading.refuse("malformed PLY header");
  Body body(bytes, *header);
  Mesh mesh;
  for (const Element& element : header->elements) {
    if (!body.may_hold(element)) return reading.refuse(kPromises);
    const bool whole = element.name == "vertex" ? take_vertices(body, element, mesh)
                       : element.name == "face" ? take_faces(body, element, mesh)
                                                : skip(body, element);
    if (!whole) return reading.refuse(kPromises);
  }
  if (mesh.triangles.empty()) return reading.refuse("no faces");
  reading.file.parts.push_back({std::move(mesh), std::nullopt});
  return true;
}

}  // namespace abbe
