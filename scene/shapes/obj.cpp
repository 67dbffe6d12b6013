#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "io/diagnostics.h"
#include "io/text.h"
#include "scene/shapes/mesh_formats.h"

namespace abbe {
namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

// The rest of a line, without blanks at its ends: names may hold blanks inside.
std::string rest_of(std::string_view line) {
  const std::size_t first = line.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return std::string(line.substr(first, line.find_last_not_of(kBlanks) - first + 1));
}

// Calls take(key, rest of the line, number of the line) for each line that says something, while it returns
// true.
template <typename Take>
bool each_line(std::string_view text, Take take) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string_view key = take_word(line);
    if (!key.empty() && key[0] != '#' && !take(key, line, number)) return false;
  }
  return true;
}

std::optional<std::array<double, 3>> take_three(std::string_view line) {
  std::array<double, 3> v{};
  for (double& x : v) {
    const auto number = parse_number(take_word(line));
    if (!number) return std::nullopt;
    x = *number;
  }
  return v;
}

bool read_mtl(const std::string& name, MeshReading& reading) {
  std::string text;
  if (!read_named_bytes(name, text, reading)) return false;
  std::vector<FileMaterial>& materials = reading.file.materials;
  return each_line(text, [&](std::string_view key, std::string_view line, std::size_t number) {
    if (key == "newmtl") {
      materials.emplace_back().name = rest_of(line);
      return true;
    }
    if (materials.empty()) return reading.refuse(fmt::format("\"{}\" line {}: no newmtl yet", name, number));
    FileMaterial& material = materials.back();
    if (key != "Kd") {
      if (key != "illum" && std::find(material.lost.begin(), material.lost.end(), key) == material.lost.end())
        material.lost.emplace_back(key);
      return true;
    }
    const auto color = take_three(line);
    if (!color || !std::all_of(color->begin(), color->end(), [](double x) { return x >= 0 && x <= 1; }))
      return reading.refuse(
          fmt::format("\"{}\" line {}: Kd (got {}, allowed three of [0, 1])", name, number, rest_of(line)));
    material.color = *color;
    return true;
  });
}

/// The state of a file being read, line by line.
struct Obj {
  std::vector<Imath::V3d> vertices;
  std::map<std::optional<std::size_t>, std::vector<std::array<std::uint32_t, 3>>> triangles;  // by material
  std::optional<std::size_t> material;
};

// A corner "7", "7/1/2" or "-1//3": vertices count from 1, or back from the last.
std::optional<std::uint32_t> vertex_of(std::string_view corner, std::size_t count) {
  const auto number = parse_number(corner.substr(0, corner.find('/')));
  if (!number || *number != std::floor(*number)) return std::nullopt;
  const double index = *number > 0 ? *number - 1 : static_cast<double>(count) + *number;
  if (*number == 0 || index < 0 || index >= static_cast<double>(count)) return std::nullopt;
  return static_cast<std::uint32_t>(index);
}

bool take_face(std::string_view line, std::size_t number, Obj& obj, MeshReading& reading) {
  auto& triangles = obj.triangles[obj.material];
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  for (int k = 0;; ++k) {
    const std::string_view word = take_word(line);
    if (word.empty() || word[0] == '#')
      return k >= 3 ||
             reading.refuse(fmt::format("line {}: a face of {} corners (allowed 3 or more)", number, k));
    const auto corner = vertex_of(word, obj.vertices.size());
    if (!corner)
      return reading.refuse(fmt::format("line {}: no such vertex (got {}, allowed [1, {}])", number, word,
                                        obj.vertices.size()));
    if (k == 0) first = *corner;
    if (k >= 2) triangles.push_back({first, last, *corner});
    last = *corner;
  }
}

bool use_material(const std::string& name, std::size_t number, Obj& obj, MeshReading& reading) {
  const std::vector<FileMaterial>& materials = reading.file.materials;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (materials[i].name != name) continue;
    obj.material = i;
    return true;
  }
  std::vector<std::string> names;
  for (const FileMaterial& material : materials) names.push_back(material.name);
  return reading.refuse(fmt::format("line {}: {}", number, unknown_name("material", name, names)));
}

bool take_line(std::string_view key, std::string_view line, std::size_t number, Obj& obj,
               MeshReading& reading) {
  if (key == "v") {
    const auto v = take_three(line);
    if (!v)
      return reading.refuse(
          fmt::format("line {}: a vertex needs three finite numbers (got {})", number, rest_of(line)));
    obj.vertices.emplace_back((*v)[0], (*v)[1], (*v)[2]);
    return obj.vertices.size() < std::numeric_limits<std::uint32_t>::max() ||
           reading.refuse("too many vertices");
  }
  if (key == "f") return take_face(line, number, obj, reading);
  if (reading.materials == FileMaterials::ignored) return true;
  if (key == "mtllib") return read_mtl(rest_of(line), reading);
  if (key == "usemtl") return use_material(rest_of(line), number, obj, reading);
  return true;
}

// The triangles with the vertices they name and no others.
Mesh compact(const std::vector<Imath::V3d>& vertices, std::vector<std::array<std::uint32_t, 3>> triangles) {
  Mesh mesh;
  std::unordered_map<std::uint32_t, std::uint32_t> renamed;
  for (auto& triangle : triangles)
    for (std::uint32_t& corner : triangle) {
      const auto [at, added] = renamed.emplace(corner, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (added) mesh.vertices.push_back(vertices[corner]);
      corner = at->second;
    }
  mesh.triangles = std::move(triangles);
  return mesh;
}

}  // namespace

bool read_obj(std::string_view bytes, MeshReading& reading) {
  Obj obj;
  if (!each_line(bytes, [&](std::string_view key, std::string_view line, std::size_t number) {
        return take_line(key, line, number, obj, reading);
      }))
    return false;
  std::erase_if(obj.triangles, [](const auto& group) { return group.second.empty(); });
  if (obj.triangles.size() == 1) {
    auto& [material, triangles] = *obj.triangles.begin();
    reading.file.parts.push_back({{std::move(obj.vertices), std::move(triangles)}, material});
    return true;
  }
  for (auto& [material, triangles] : obj.triangles)
    reading.file.parts.push_back({compact(obj.vertices, std::move(triangles)), material});
  return true;
}

}  // namespace abbe
