// The library's assertions stand between a property of an unexpected type and a null pointer: they stay in
// every build.
#define CGAL_DEBUG
// Its check of rounding modes, which nothing here relies on, would end the program under Valgrind, which has
// none.
#define CGAL_DISABLE_ROUNDING_MATH_CHECK
#include <CGAL/IO/PLY.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scene/shapes/mesh_formats.h"

namespace abbe {
namespace {

// Whether a header has what the library takes for granted: an element before any property, known types, a
// property of each element (else as many as the header likes would cost no bytes), and lists counted in 8 or
// 16 bits, because room is made for a list before the first of its values is read.
bool sound_header(std::istream& stream) {
  constexpr std::array<std::string_view, 16> kTypes{
      "char", "int8",  "uchar", "uint8",  "short", "int16",   "ushort", "uint16",
      "int",  "int32", "uint",  "uint32", "float", "float32", "double", "float64"};
  const auto* const long_types = kTypes.begin() + 8;
  int elements = 0;
  int properties = 1;  // of the last element
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string key;
    std::string type;
    words >> key >> type;
    if (key == "end_header") return properties > 0;
    if (key == "element") {
      if (properties == 0) return false;
      properties = 0;
      ++elements;
    } else if (key == "property") {
      std::string count = "char";
      if (type == "list") words >> count >> type;
      if (elements == 0 || std::find(kTypes.begin(), long_types, count) == long_types ||
          std::find(kTypes.begin(), kTypes.end(), type) == kTypes.end())
        return false;
      ++properties;
    }
  }
  return false;
}

}  // namespace

bool read_ply(std::string&& bytes, MeshReading& reading) {
  std::istringstream stream(std::move(bytes));
  stream.imbue(std::locale::classic());
  if (!sound_header(stream)) return reading.refuse("malformed PLY header, or lists counted in 32 bits");
  stream.seekg(0);
  std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
  std::vector<std::vector<std::uint32_t>> polygons;
  try {
    if (!CGAL::IO::read_PLY(stream, points, polygons, CGAL::parameters::verbose(false)))
      return reading.refuse("malformed PLY, or the header promises more than the file holds");
  } catch (const std::logic_error&) {  // an assertion, or a list of negative length
    return reading.refuse("malformed PLY");
  }
  if (points.size() > std::numeric_limits<std::uint32_t>::max()) return reading.refuse("too many vertices");
  Mesh mesh;
  mesh.vertices.reserve(points.size());
  for (const auto& point : points) mesh.vertices.emplace_back(point.x(), point.y(), point.z());
  mesh.triangles.reserve(polygons.size());
  for (const auto& polygon : polygons) add_fan(polygon, mesh.triangles);
  if (mesh.triangles.empty()) return reading.refuse("no faces");
  reading.file.parts.push_back({std::move(mesh), std::nullopt});
  return true;
}

}  // namespace abbe
