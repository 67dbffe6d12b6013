#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "description/meshes/mesh_formats.h"
#include "io/diagnostics.h"
#include "io/text.h"

namespace abbe {

namespace {

// The text before the first "#" that follows a blank or a tab, without leading and trailing blanks. `text` is
// at most one line. A "#" at the beginning or within a word belongs to the result.
std::string without_comment(std::string_view text) {
  const std::size_t hash = std::min(text.find(" #"), text.find("\t#"));
  return split(text.substr(0, hash), '\n')[0];
}

// Removes each "#" and the rest of its line, with the blanks before it, because the library reads words after
// the numbers of a line as further numbers. Line breaks stay. Lines that begin with `usemtl` or `mtllib` stay
// unchanged, because their names may contain a "#": see `without_comment`.
void erase_comments(std::string& bytes) {
  std::size_t written = 0;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size() - 1) + 1;
    const std::string_view line = std::string_view(bytes).substr(begin, end - begin);
    const std::size_t key = std::min(line.find_first_not_of(" \t"), line.size());
    const bool named = line.substr(key).starts_with("usemtl") || line.substr(key).starts_with("mtllib");
    std::size_t length = named ? line.size() : std::min(line.find('#'), line.size());
    while (!named && length < line.size() && length > 0 &&
           (line[length - 1] == ' ' || line[length - 1] == '\t'))
      --length;
    const bool cut = length < line.size() && line.back() == '\n';
    std::memmove(&bytes[written], &bytes[begin], length);
    written += length;
    if (cut) bytes[written++] = '\n';
    begin = end;
  }
  bytes.resize(written);
}

// Joins lines that a "\" at their end continues; a blank replaces the "\" and the line break. Adds as many
// empty lines after the joined line, so that the numbers of later lines stay the same.
void join_continued_lines(std::string& bytes) {
  std::size_t written = 0;
  std::size_t joined = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::string_view rest = std::string_view(bytes).substr(i);
    if (rest.starts_with("\\\n") || rest.starts_with("\\\r\n")) {
      i = bytes.find('\n', i);
      bytes[written++] = ' ';
      ++joined;
      continue;
    }
    bytes[written++] = bytes[i];
    if (bytes[i] != '\n') continue;
    for (; joined > 0; --joined) bytes[written++] = '\n';
  }
  bytes.resize(written);
}

/// The faces of a material.
struct Faces {
  std::vector<Triangle> triangles;
  std::vector<std::array<Imath::V2f, 3>> coordinates;
  std::vector<std::array<Imath::V3f, 3>> normals;  // Zero for a face without normals.
};

/// State of reading a file; the library calls back for each line.
struct Obj {
  MeshReading& reading;
  std::istringstream stream;
  std::vector<Imath::V3d> vertices;
  std::vector<Imath::V2f> coordinates;
  std::vector<Imath::V3f> normals;
  std::map<std::optional<std::size_t>, Faces> faces;  // Faces by material.
  std::optional<std::size_t> material;

  /// The text up to the end of the current line.
  [[nodiscard]] std::string_view read() const {
    const auto end = stream.rdbuf()->pubseekoff(0, std::ios::cur, std::ios::in);
    const std::string_view text = stream.view().substr(0, static_cast<std::size_t>(end));
    return text.substr(0, text.find_last_not_of("\r\n") + 1);
  }
  /// The current line after its first word, without leading and trailing blanks.
  [[nodiscard]] std::string_view rest() const {
    constexpr std::string_view kBlanks = " \t";
    std::string_view line = read();
    line.remove_prefix(line.find_last_of("\r\n") + 1);
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    line.remove_prefix(std::min(line.find_first_of(kBlanks), line.size()));
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    return line.substr(0, line.find_last_not_of(kBlanks) + 1);
  }
  [[noreturn]] void refuse(const std::string& what) const {
    const std::string_view text = read();
    throw MeshFault{fmt::format("line {}: {}", std::count(text.begin(), text.end(), '\n') + 1, what)};
  }
};

// Numbers at the start of a text; nothing if one is malformed. The library would read the start of such a
// word, or 0.
template <std::size_t N>
std::optional<std::array<double, N>> numbers(std::string_view text) {
  constexpr std::string_view kSpaces = " \t\r\n\v\f";
  std::array<double, N> v{};
  for (double& x : v) {
    text.remove_prefix(std::min(text.find_first_not_of(kSpaces), text.size()));
    const std::size_t end = std::min(text.find_first_of(kSpaces), text.size());
    const auto number = parse_number(text.substr(0, end));
    if (!number) return std::nullopt;
    x = *number;
    text.remove_prefix(end);
  }
  return v;
}

// The three numbers of a line. `what` and `count` name the line in a message.
Imath::V3d three_numbers(const Obj& obj, const char* what, std::size_t count) {
  const auto v = numbers<3>(obj.rest());
  if (!v) obj.refuse(fmt::format("{} {} needs three finite numbers (got {})", what, count, obj.rest()));
  return {(*v)[0], (*v)[1], (*v)[2]};
}

void take_vertex(void* user, double /*x*/, double /*y*/, double /*z*/, double /*w*/) {
  Obj& obj = *static_cast<Obj*>(user);
  const Imath::V3d vertex = three_numbers(obj, "vertex", obj.vertices.size() + 1);
  obj.reading.make_room(obj.vertices, 1);
  obj.vertices.push_back(vertex);
}

void take_normal(void* user, double /*x*/, double /*y*/, double /*z*/) {
  Obj& obj = *static_cast<Obj*>(user);
  const Imath::V3d normal = three_numbers(obj, "vn", obj.normals.size() + 1);
  obj.reading.make_room(obj.normals, 1);
  obj.normals.push_back(unit_normal(normal));
}

void take_coordinates(void* user, double /*u*/, double /*v*/, double /*w*/) {
  Obj& obj = *static_cast<Obj*>(user);
  const auto at = numbers<2>(obj.rest());
  const Imath::V2f uv = at ? Imath::V2f(Imath::V2d((*at)[0], (*at)[1])) : Imath::V2f(INFINITY);
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
    obj.refuse(fmt::format("texture coordinates need two finite numbers (got {})", obj.rest()));
  obj.reading.make_room(obj.coordinates, 1);
  obj.coordinates.push_back(uv);
}

// Converts an index of a face to one that counts from 0. It counts from 1, or backwards from the last.
template <typename T>
std::size_t position(const Obj& obj, const char* what, std::int64_t named, const std::vector<T>& list) {
  const auto last = static_cast<std::int64_t>(list.size());
  const std::int64_t number = named > 0 ? named : last + 1 + named;
  if (named == 0 || number < 1 || number > last)
    obj.refuse(fmt::format("no such {} (got {}, allowed [1, {}])", what, named, last));
  return static_cast<std::size_t>(number - 1);
}

// True if the text is an integer. The library would read the start of other texts, or 0.
bool is_index(std::string_view text) {
  int index = 0;
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  return error == std::errc() && end == text.data() + text.size();
}

// True for a corner v, v/vt, v//vn or v/vt/vn, whose parts are integers.
bool is_corner(std::string_view word) {
  for (int part = 0; part < 3; ++part) {
    const std::size_t slash = std::min(word.find('/'), word.size());
    const std::string_view index = word.substr(0, slash);
    if (!is_index(index) && (part == 0 || !index.empty())) return false;
    if (slash == word.size()) return true;
    word.remove_prefix(slash + 1);
  }
  return false;
}

// Rejects a face with a malformed corner, which the library would read in part.
void require_corners(const Obj& obj) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::string_view line = obj.rest();
  for (std::size_t begin = 0, end = 0; begin < line.size(); begin = line.find_first_not_of(kBlanks, end)) {
    end = std::min(line.find_first_of(kBlanks, begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    if (!is_corner(word))
      obj.refuse(fmt::format(
          "a corner of a face (got \"{}\", allowed v, v/vt, v//vn and v/vt/vn of whole numbers)", word));
  }
}

// Triangles of a face; they refer to its corners by index.
std::vector<Triangle> triangles_of(const Obj& obj, const std::vector<std::uint32_t>& polygon) {
  std::vector<Imath::V3d> corners;
  for (const std::uint32_t vertex : polygon) corners.push_back(obj.vertices[vertex]);
  std::vector<Triangle> triangles;
  if (const auto fault = cut_polygon(corners, triangles)) obj.refuse(*fault);
  return triangles;
}

// Cuts a face into triangles of the current material. Its normals count only if each corner has one; so do
// its texture coordinates.
void take_face(void* user, tinyobj::index_t* indices, int count) {
  Obj& obj = *static_cast<Obj*>(user);
  require_corners(obj);
  if (count < 3) obj.refuse(fmt::format("a face of {} corners (allowed 3 or more)", count));
  std::vector<std::uint32_t> polygon;
  std::vector<Imath::V2f> coordinates;
  std::vector<Imath::V3f> normals;
  for (int i = 0; i < count; ++i) {
    polygon.push_back(
        static_cast<std::uint32_t>(position(obj, "vertex", indices[i].vertex_index, obj.vertices)));
    const int named = indices[i].texcoord_index;
    if (obj.reading.coordinates == FileCoordinates::wanted && named != 0)
      coordinates.push_back(obj.coordinates[position(obj, "vt", named, obj.coordinates)]);
    if (const int normal = indices[i].normal_index; normal != 0) {
      const std::size_t number = position(obj, "vn", normal, obj.normals);
      normals.push_back(obj.normals[number]);
      if (normals.back() == Imath::V3f(0)) obj.refuse(fmt::format("vn {} has no direction", number + 1));
    }
  }
  Faces& faces = obj.faces[obj.material];
  const std::vector<Triangle> cut = triangles_of(obj, polygon);
  if (normals.size() == polygon.size()) {
    obj.reading.make_room(faces.normals, faces.triangles.size() - faces.normals.size() + cut.size());
    faces.normals.resize(faces.triangles.size());
    add_corners(normals, cut, faces.normals);
  }
  obj.reading.make_room(faces.triangles, cut.size());
  add_corners(polygon, cut, faces.triangles);
  if (coordinates.size() != polygon.size()) return;
  obj.reading.make_room(faces.coordinates, cut.size());
  add_corners(coordinates, cut, faces.coordinates);
}

// Names may contain blanks and "#". So a "#" begins a comment only if the whole text is no known material.
void use_material(void* user, const char* name, int number) {
  Obj& obj = *static_cast<Obj*>(user);
  if (number >= 0) {
    obj.material = static_cast<std::size_t>(number);
    return;
  }
  std::vector<std::string> names;
  for (const FileMaterial& material : obj.reading.file.materials) names.push_back(material.name);
  const std::string material_name = without_comment(name);
  const auto found = std::find(names.begin(), names.end(), material_name);
  if (found == names.end()) obj.refuse(unknown_name("material", material_name, names));
  obj.material = static_cast<std::size_t>(found - names.begin());
}

// Keys of a material that are not represented, in the words of the format.
std::vector<std::string> ignored_keys(const tinyobj::material_t& m) {
  const auto some = [](const double(&color)[3]) { return color[0] != 0 || color[1] != 0 || color[2] != 0; };
  const std::pair<const char*, bool> known[] = {{"Ka", some(m.ambient)},
                                                {"Ks", some(m.specular)},
                                                {"Ke", some(m.emission)},
                                                {"Tf", some(m.transmittance)},
                                                {"Ns", m.shininess != 1},
                                                {"Ni", m.ior != 1},
                                                {"d", m.dissolve != 1},
                                                {"Pr", m.roughness != 0},
                                                {"Pm", m.metallic != 0},
                                                {"Ps", m.sheen != 0},
                                                {"Pc", m.clearcoat_thickness != 0},
                                                {"Pcr", m.clearcoat_roughness != 0},
                                                {"aniso", m.anisotropy != 0},
                                                {"anisor", m.anisotropy_rotation != 0},
                                                {"map_Ka", !m.ambient_texname.empty()},
                                                {"map_Kd", !m.diffuse_texname.empty()},
                                                {"map_Ks", !m.specular_texname.empty()},
                                                {"map_Ns", !m.specular_highlight_texname.empty()},
                                                {"bump", !m.bump_texname.empty()},
                                                {"disp", !m.displacement_texname.empty()},
                                                {"map_d", !m.alpha_texname.empty()},
                                                {"refl", !m.reflection_texname.empty()},
                                                {"map_Pr", !m.roughness_texname.empty()},
                                                {"map_Pm", !m.metallic_texname.empty()},
                                                {"map_Ps", !m.sheen_texname.empty()},
                                                {"map_Ke", !m.emissive_texname.empty()},
                                                {"norm", !m.normal_texname.empty()}};
  std::vector<std::string> words;
  for (const auto& [word, present] : known)
    if (present) words.emplace_back(word);
  for (const auto& [word, value] : m.unknown_parameter) words.push_back(word);
  return words;
}

// Refuses a Kd that is no colour. Checked here because the library reads malformed numbers as 0.
void check_colors(const std::string& name, const std::string& text) {
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::size_t key = std::min(line.find_first_not_of(" \t"), line.size());
    if (line.compare(key, 2, "Kd") != 0) continue;
    const std::string rest = split(std::string_view(line).substr(key + 2), '\n')[0];
    const auto color = numbers<3>(rest);
    if (!color || !std::all_of(color->begin(), color->end(), [](double x) { return x >= 0 && x <= 1; }))
      throw MeshFault{
          fmt::format("\"{}\" line {}: Kd (got {}, allowed three of [0, 1])", name, number, rest)};
  }
}

// Files that an `mtllib` line names: the whole line if such a file exists, because names may contain blanks;
// otherwise each of its words. If no word is a file either, the whole line.
std::vector<std::string> names_of_files(const std::string& line, const MeshReading& reading) {
  const auto is_file = [&](const std::string& name) {
    std::error_code error;
    return std::filesystem::exists(reading.path.parent_path() / name, error);
  };
  if (is_file(line)) return {line};
  std::vector<std::string> names;
  std::istringstream words(line);
  for (std::string name; words >> name;) names.push_back(std::move(name));
  if (std::ranges::none_of(names, is_file)) return {line};
  return names;
}

/// Reads the .mtl files that an .obj names, with the check of their paths.
class MaterialFiles : public tinyobj::MaterialReader {
 public:
  explicit MaterialFiles(const Obj& obj) : obj_(obj) {}
  // The library splits a line at blanks, and calls for each piece until one has been read.
  bool operator()(const std::string& /*piece*/, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* numbers, std::string* warning, std::string* error) override {
    for (const std::string& name : names_of_files(without_comment(obj_.rest()), obj_.reading))
      if (read_.insert(name).second) read(name, materials, numbers, warning, error);
    return true;
  }

 private:
  void read(const std::string& name, std::vector<tinyobj::material_t>* materials,
            std::map<std::string, int>* numbers, std::string* warning, std::string* error) {
    MeshReading& reading = obj_.reading;
    std::string text;
    read_named_bytes(name, text, reading);
    check_colors(name, text);
    std::istringstream stream(std::move(text));
    tinyobj::LoadMtl(numbers, materials, &stream, warning, error);
    for (std::size_t i = reading.file.materials.size(); i < materials->size(); ++i) {
      const tinyobj::material_t& m = (*materials)[i];
      if (m.name.empty()) obj_.refuse(fmt::format("\"{}\" has a material without a name", name));
      reading.file.materials.push_back(
          {m.name, {m.diffuse[0], m.diffuse[1], m.diffuse[2]}, std::nullopt, ignored_keys(m)});
    }
  }

  const Obj& obj_;
  std::set<std::string> read_{};
};

// The faces as a mesh that has only the vertices they use.
Mesh compact(const std::vector<Imath::V3d>& vertices, Faces faces, MeshReading& reading) {
  Mesh mesh;
  std::unordered_map<std::uint32_t, std::uint32_t> renamed;
  for (Triangle& triangle : faces.triangles)
    for (std::uint32_t& corner : triangle) {
      const auto [at, added] = renamed.emplace(corner, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (added) {
        reading.make_room(mesh.vertices, 1);
        mesh.vertices.push_back(vertices[corner]);
      }
      corner = at->second;
    }
  mesh.triangles = std::move(faces.triangles);
  mesh.coordinates = std::move(faces.coordinates);
  mesh.normals = std::move(faces.normals);
  return mesh;
}

}  // namespace

void read_obj(std::string&& bytes, MeshReading& reading) {
  erase_comments(bytes);
  join_continued_lines(bytes);
  Obj obj{reading, std::istringstream(std::move(bytes)), {}, {}, {}, {}, {}};
  MaterialFiles files(obj);
  const bool wanted = reading.materials != FileMaterials::ignored;
  tinyobj::callback_t take;
  take.vertex_cb = take_vertex;
  take.normal_cb = take_normal;
  take.index_cb = take_face;
  if (reading.coordinates == FileCoordinates::wanted) take.texcoord_cb = take_coordinates;
  if (wanted) take.usemtl_cb = use_material;
  tinyobj::LoadObjWithCallback(obj.stream, take, &obj, wanted ? &files : nullptr);
  for (auto& [material, faces] : obj.faces) {
    if (faces.coordinates.size() < faces.triangles.size()) faces.coordinates.clear();
    if (!faces.normals.empty()) faces.normals.resize(faces.triangles.size());
  }
  if (obj.faces.size() == 1) {
    auto& [material, faces] = *obj.faces.begin();
    reading.file.submeshes.push_back({{std::move(obj.vertices), std::move(faces.triangles),
                                       std::move(faces.coordinates), std::move(faces.normals)},
                                      material});
    return;
  }
  for (auto& [material, faces] : obj.faces)
    reading.file.submeshes.push_back({compact(obj.vertices, std::move(faces), reading), material});
}

}  // namespace abbe
