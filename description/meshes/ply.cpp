// The library relies on assertions where a property of an unexpected type would give a null pointer. They
// must be active in every build.
#define CGAL_DEBUG
// The library checks rounding modes, which nothing here uses. The check would end the program under Valgrind,
// which does not support them.
#define CGAL_DISABLE_ROUNDING_MATH_CHECK
#include <CGAL/IO/PLY.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <locale>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "description/meshes/mesh_formats.h"

namespace abbe {
namespace {

using Points = std::vector<CGAL::Simple_cartesian<double>::Point_3>;
using Polygons = std::vector<std::vector<std::uint32_t>>;

/// Vertices and faces that a header declares.
struct Header {
  std::size_t vertices = 0;
  std::size_t faces = 0;
  std::vector<std::pair<std::string, std::string>> numbers =
      {};                                   ///< Name and type of each number of a vertex.
  std::optional<std::string> corners = {};  ///< Type of the corner indices, if faces list them.

  [[nodiscard]] bool has(std::string_view name) const {
    return std::any_of(numbers.begin(), numbers.end(),
                       [&](const auto& number) { return number.first == name; });
  }
  [[nodiscard]] bool has_normals() const { return has("nx") || has("ny") || has("nz"); }
};

bool is_vertices(std::string_view element) {
  return element == "vertex" || element == "vertices";
}
bool is_faces(std::string_view element) {
  return element == "face" || element == "faces";
}

// Fault of the types in a header. The library reads 0 for a missing position, rejects integer positions, and
// reads corners of faces only as 32-bit integers.
std::optional<std::string> type_fault(const Header& header) {
  constexpr std::array<std::string_view, 4> kCorners{"int", "int32", "uint", "uint32"};
  if (header.corners && std::find(kCorners.begin(), kCorners.end(), *header.corners) == kCorners.end())
    return fmt::format("the type of the corners of faces (got {}, allowed {})", *header.corners,
                       fmt::join(kCorners, ", "));
  constexpr std::array<std::string_view, 6> kRead{"x", "y", "z", "nx", "ny", "nz"};
  constexpr std::array<std::string_view, 4> kFloating{"float", "float32", "double", "float64"};
  std::vector<std::string> names;
  for (const auto& [name, type] : header.numbers) {
    names.push_back(name);
    if (std::find(kRead.begin(), kRead.end(), name) != kRead.end() &&
        std::find(kFloating.begin(), kFloating.end(), type) == kFloating.end())
      return fmt::format("the type of {} (got {}, allowed {})", name, type, fmt::join(kFloating, ", "));
  }
  if (header.has("x") && header.has("y") && header.has("z")) return std::nullopt;
  return fmt::format("a vertex needs x, y and z (got {})",
                     names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")));
}

// Reads the header; nothing if it violates the assumptions of the library. These are:
// - an element precedes any property, and types are known;
// - each element has a property, since otherwise any number of elements would occupy no bytes;
// - list lengths have 8 or 16 bits, because memory is reserved for a list before its first value is read.
std::optional<Header> read_header(std::istream& stream) {
  constexpr std::array<std::string_view, 16> kTypes{
      "char", "int8",  "uchar", "uint8",  "short", "int16",   "ushort", "uint16",
      "int",  "int32", "uint",  "uint32", "float", "float32", "double", "float64"};
  const auto* const long_types = kTypes.begin() + 8;
  Header header;
  std::string element;
  int elements = 0;
  int properties = 1;  // Number of properties of the last element.
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string key;
    std::string type;
    words >> key >> type;
    if (key == "end_header") return properties > 0 ? std::optional(header) : std::nullopt;
    if (key == "element") {
      if (properties == 0) return std::nullopt;
      properties = 0;
      ++elements;
      element = type;
      if (is_vertices(element)) words >> header.vertices;
      if (is_faces(element)) words >> header.faces;
    } else if (key == "property") {
      std::string count = "char";
      std::string name;
      const bool list = type == "list";
      if (list) words >> count >> type;
      words >> name;
      if (elements == 0 || std::find(kTypes.begin(), long_types, count) == long_types ||
          std::find(kTypes.begin(), kTypes.end(), type) == kTypes.end())
        return std::nullopt;
      ++properties;
      if (is_vertices(element) && !list) header.numbers.emplace_back(name, type);
      if (is_faces(element) && list && (name == "vertex_index" || name == "vertex_indices"))
        header.corners = type;
    }
  }
  return std::nullopt;
}

// Changes the header so that normals are declared as positions, and the elements after the vertices become
// comments.
void call_normals_positions(std::string& bytes) {
  bool vertices = false;
  bool past = false;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
    std::istringstream words(bytes.substr(begin, end - begin));
    std::string key, type, name;
    words >> key >> type >> name;
    if (key == "end_header") return;
    if (key == "element") {
      past = past || vertices;
      vertices = is_vertices(type);
    }
    if (past && (key == "element" || key == "property")) bytes.replace(bytes.find(key, begin), 8, "comment ");
    const std::size_t last = bytes.find_last_not_of(" \t\r", end - 1);
    const bool named = vertices && key == "property";
    if (named && (name == "x" || name == "y" || name == "z")) bytes[last] = '_';
    if (named && (name == "nx" || name == "ny" || name == "nz")) bytes[last - 1] = ' ';
    begin = end + 1;
  }
}

// Counts the memory in which the library stores vertices and faces, at most as many as the file has bytes.
void take_memory(std::size_t vertices, std::size_t faces, std::size_t bytes, MeshReading& reading) {
  constexpr std::size_t kFace = sizeof(Polygons::value_type) + sizeof(Triangle);
  reading.memory.reserve(reading.path.string(), std::min(vertices, bytes) * sizeof(Points::value_type) +
                                                    std::min(faces, bytes) * kFace);
}

// Reads the vertices and, if the header has faces, the polygons.
void read(std::istream& stream, const Header& header, Points& points, Polygons& polygons) {
  stream.imbue(std::locale::classic());
  try {
    if (CGAL::IO::read_PLY(stream, points, polygons, CGAL::parameters::verbose(false))) return;
  } catch (const std::logic_error&) {  // Thrown by an assertion, or for a list of negative length.
    throw MeshFault{"malformed PLY"};
  }
  std::string word;
  stream.clear();
  if (points.size() < header.vertices && stream >> word)
    throw MeshFault{
        fmt::format("vertex {} needs finite numbers (got \"{}\")", points.size(), word.substr(0, 20))};
  throw MeshFault{"malformed PLY, or the header declares more than the file holds"};
}

// Sets the normals at the corners of the triangles to those of their vertices.
void read_normals(std::string&& bytes, const Header& header, Mesh& mesh, MeshReading& reading) {
  if (!header.has("nx") || !header.has("ny") || !header.has("nz"))
    throw MeshFault{"a normal needs nx, ny and nz"};
  take_memory(header.vertices, 0, bytes.size(), reading);
  reading.make_room(mesh.normals, mesh.triangles.size());
  call_normals_positions(bytes);
  std::istringstream stream(std::move(bytes));
  Points given;
  Polygons none;
  read(stream, header, given, none);
  mesh.normals.resize(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = mesh.triangles[i].at(corner);
      if (vertex >= given.size()) continue;  // The triangle is reported later.
      Imath::V3f& normal = mesh.normals[i].at(corner);
      normal = unit_normal({given[vertex].x(), given[vertex].y(), given[vertex].z()});
      if (normal == Imath::V3f(0))
        throw MeshFault{fmt::format("the normal of vertex {} has no direction", vertex)};
    }
}

void cut_polygons(const Polygons& polygons, Mesh& mesh) {
  std::vector<Imath::V3d> corners;
  std::vector<Triangle> cut;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    if (polygons[i].size() < 3) continue;
    corners.clear();
    for (const std::uint32_t vertex : polygons[i])  // A vertex that does not exist is reported later.
      corners.push_back(vertex < mesh.vertices.size() ? mesh.vertices[vertex] : Imath::V3d(NAN));
    if (const auto fault = cut_polygon(corners, cut)) throw MeshFault{fmt::format("face {}: {}", i, *fault)};
    add_corners(polygons[i], cut, mesh.triangles);
  }
}

}  // namespace

void read_ply(std::string&& bytes, MeshReading& reading) {
  std::istringstream stream(std::move(bytes));
  stream.imbue(std::locale::classic());
  const auto header = read_header(stream);
  if (!header) throw MeshFault{"malformed PLY header, or lists counted in 32 bits"};
  if (const auto fault = type_fault(*header)) throw MeshFault{"PLY header: " + *fault};
  take_memory(header->vertices, header->faces, stream.view().size(), reading);
  stream.seekg(0);
  Points points;
  Polygons polygons;
  read(stream, *header, points, polygons);
  if (points.size() > std::numeric_limits<std::uint32_t>::max()) throw MeshFault{"too many vertices"};
  Mesh mesh;
  reading.make_room(mesh.vertices, points.size());
  for (const auto& point : points) mesh.vertices.emplace_back(point.x(), point.y(), point.z());
  std::size_t triangles = 0;
  for (const auto& polygon : polygons) triangles += std::max(polygon.size(), std::size_t{2}) - 2;
  reading.make_room(mesh.triangles, triangles);
  cut_polygons(polygons, mesh);
  if (mesh.triangles.empty()) throw MeshFault{"no faces"};
  if (header->has_normals()) read_normals(std::move(stream).str(), *header, mesh, reading);
  reading.file.submeshes.push_back({std::move(mesh), std::nullopt});
}

}  // namespace abbe
