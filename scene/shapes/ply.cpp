#include "scene/shapes/ply.h"

#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "io/text.h"
#include "scene/shapes/mesh.h"

namespace abbe {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 32;

/// One `property` of a PLY header. A list has the width of its count, a single value 0.
struct Property {
  std::size_t count_bytes;
  std::size_t value_bytes;
};
struct Element {
  double count;
  std::vector<Property> properties;
};
struct Header {
  enum class Format { none, ascii, little_endian, big_endian } format = Format::none;
  std::vector<Element> elements;
  std::size_t bytes = 0;
};

std::size_t width_of(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, std::size_t>, 16> kTypes{{{"char", 1},
                                                                             {"uchar", 1},
                                                                             {"int8", 1},
                                                                             {"uint8", 1},
                                                                             {"short", 2},
                                                                             {"ushort", 2},
                                                                             {"int16", 2},
                                                                             {"uint16", 2},
                                                                             {"int", 4},
                                                                             {"uint", 4},
                                                                             {"int32", 4},
                                                                             {"uint32", 4},
                                                                             {"float", 4},
                                                                             {"float32", 4},
                                                                             {"double", 8},
                                                                             {"float64", 8}}};
  const auto* found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& t) { return t.first == type; });
  return found == kTypes.end() ? 0 : found->second;
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
    header.elements.push_back({*count, {}});
  } else if (words[0] == "property") {
    const bool list = words.size() == 5 && words[1] == "list";
    if (header.elements.empty() || (!list && words.size() != 3)) return false;
    const Property property{list ? width_of(words[2]) : 0, width_of(words[list ? 3 : 1])};
    if (property.value_bytes == 0 || (list && property.count_bytes == 0)) return false;
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

/// Walks over the values behind a header without keeping them. The library would repeat the last entry of a
/// truncated file, and allocate whatever a list says its length is.
class Body {
 public:
  Body(std::string_view bytes, const Header& header)
      : rest_(bytes.substr(header.bytes)), format_(header.format) {}

  /// Whether the file holds all that the header promises.
  [[nodiscard]] bool holds(const std::vector<Element>& elements) {
    for (const Element& element : elements)
      for (double i = 0; i < element.count; ++i)
        for (const Property& property : element.properties) {
          const double values = property.count_bytes == 0 ? 1 : take_count(property.count_bytes);
          if (!skip(values, property.value_bytes)) return false;
        }
    return true;
  }

 private:
  static constexpr std::string_view kBlanks = " \t\r\n";

  std::string_view take_word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
    rest_.remove_prefix(word.size());
    return word;
  }

  // Infinite when there is none, so that skipping as many fails.
  double take_count(std::size_t width) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    if (format_ == Header::Format::ascii) return parse_number(take_word()).value_or(kNone);
    if (rest_.size() < width) return kNone;
    double count = 0;
    for (std::size_t i = 0; i < width; ++i)
      count = count * 256 +
              static_cast<unsigned char>(rest_[format_ == Header::Format::big_endian ? i : width - 1 - i]);
    rest_.remove_prefix(width);
    return count;
  }

  bool skip(double values, std::size_t width) {
    const std::size_t least = format_ == Header::Format::ascii ? 1 : width;
    if (!(values >= 0) || values * static_cast<double>(least) > static_cast<double>(rest_.size()))
      return false;
    if (format_ == Header::Format::ascii) {
      for (double i = 0; i < values; ++i)
        if (take_word().empty()) return false;
    } else {
      rest_.remove_prefix(static_cast<std::size_t>(values) * width);
    }
    return true;
  }

  std::string_view rest_;
  Header::Format format_;
};

// Polygons are cut into the fan around their first corner. (The library's own cutting aborts on degenerate
// ones.)
Mesh triangles_of(const aiMesh& from) {
  Mesh mesh;
  for (unsigned i = 0; i < from.mNumVertices; ++i)
    mesh.vertices.emplace_back(from.mVertices[i].x, from.mVertices[i].y, from.mVertices[i].z);
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const aiFace& face = from.mFaces[f];
    for (unsigned i = 2; i < face.mNumIndices; ++i)
      mesh.triangles.push_back({face.mIndices[0], face.mIndices[i - 1], face.mIndices[i]});
  }
  return mesh;
}

// The bytes of a PLY that keeps its header's promises, or what is wrong with it.
std::optional<std::string> read_checked(const std::filesystem::path& path, std::string& bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return error ? "no such file" : "not a regular file";
  if (std::filesystem::file_size(path, error) > kMaxFileBytes) return "file too large";
  std::ifstream stream(path, std::ios::binary);
  bytes.assign(std::istreambuf_iterator<char>(stream), {});
  if (!stream) return "cannot read the file";
  const std::optional<Header> header = read_header(bytes);
  if (!header) return "malformed PLY header";
  if (!Body(bytes, *header).holds(header->elements)) return "the header promises more than the file holds";
  return std::nullopt;
}

}  // namespace

std::optional<Mesh> load_ply(const std::filesystem::path& path, const SourcePosition& where,
                             Diagnostics& diagnostics) {
  const auto refuse = [&](const std::string& message) {
    diagnostics.error(where, fmt::format("mesh \"{}\": {}", path.string(), message), ErrorCode::input);
    return std::nullopt;
  };
  std::string bytes;
  if (const auto fault = read_checked(path, bytes)) return refuse(*fault);

  Assimp::Importer importer;
  const aiScene* found = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, "ply");
  if (!found) return refuse(importer.GetErrorString());
  if (found->mNumMeshes != 1)
    return refuse(fmt::format("one mesh is needed (got {}, allowed 1)", found->mNumMeshes));
  Mesh mesh = triangles_of(*found->mMeshes[0]);
  if (mesh.triangles.empty()) return refuse("no faces");
  if (!check_mesh(mesh, where, diagnostics)) return std::nullopt;
  return mesh;
}

bool check_mesh(Mesh& mesh, const SourcePosition& where, Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Imath::V3d& v = mesh.vertices[i];
    if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) continue;
    diagnostics.error(where, fmt::format("vertex {} is not finite (got [{}, {}, {}])", i, v.x, v.y, v.z),
                      ErrorCode::input);
    return false;
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t index = *std::max_element(mesh.triangles[i].begin(), mesh.triangles[i].end());
    if (index < mesh.vertices.size()) continue;
    diagnostics.error(where,
                      fmt::format("triangle {} names a vertex that does not exist (got {}, allowed [0, {}])",
                                  i, index, mesh.vertices.size() - 1),
                      ErrorCode::input);
    return false;
  }
  std::vector<std::array<std::uint32_t, 3>> kept;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (area_vector(mesh, i).length() > 0) kept.push_back(mesh.triangles[i]);
  const std::size_t dropped = mesh.triangles.size() - kept.size();
  mesh.triangles = std::move(kept);
  if (dropped > 0) diagnostics.warning(where, fmt::format("triangles of zero area dropped: {}", dropped));
  if (!mesh.triangles.empty()) return true;
  diagnostics.error(where, "a mesh without a triangle of any area", ErrorCode::input);
  return false;
}

}  // namespace abbe
