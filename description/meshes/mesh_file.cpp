#include "description/meshes/mesh_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <zlib.h>

#include "description/meshes/mesh_formats.h"
#include "io/text.h"
#include "scene/shapes/mesh.h"

namespace abbe {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 32;

bool is_packed_ply(const std::filesystem::path& path) {
  return extension_of(path) == ".gz" && extension_of(path.stem()) == ".ply";
}

using MeshReader = void (*)(std::string&&, MeshReading&);

// The reader for the extension of a file; nullptr for an unknown extension.
MeshReader mesh_reader_of(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  if (extension == ".obj") return read_obj;
  if (extension == ".gltf" || extension == ".glb") return read_gltf;
  return extension == ".ply" || is_packed_ply(path) ? read_ply : nullptr;
}

// Moves the triangles of zero area to `slivers`, and returns their number.
std::size_t drop_slivers(Mesh& mesh) {
  std::size_t remaining = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!(area_vector(mesh, i).length() > 0)) {
      mesh.slivers.push_back(mesh.triangles[i]);
      continue;
    }
    if (!mesh.coordinates.empty()) mesh.coordinates[remaining] = mesh.coordinates[i];
    if (!mesh.normals.empty()) mesh.normals[remaining] = mesh.normals[i];
    mesh.triangles[remaining++] = mesh.triangles[i];
  }
  mesh.triangles.resize(remaining);
  if (!mesh.coordinates.empty()) mesh.coordinates.resize(remaining);
  if (!mesh.normals.empty()) mesh.normals.resize(remaining);
  return mesh.slivers.size();
}

// Readers set the normals to zero at corners where the file gives none.
void complete_normals(Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    std::array<Imath::V3f, 3>& corners = mesh.normals[i];
    if (std::ranges::find(corners, Imath::V3f(0)) != corners.end())
      corners.fill(Imath::V3f(area_vector(mesh, i).normalized()));
  }
}

}  // namespace

bool may_have_materials(const std::filesystem::path& path) {
  const MeshReader reader = mesh_reader_of(path);
  return reader == read_obj || reader == read_gltf;
}

std::optional<std::string> read_mesh_bytes(const std::filesystem::path& path, std::string& bytes,
                                           MemoryReservation& memory) {
  if (auto fault = file_fault(path)) return fault;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > kMaxFileBytes) return "file too large";
  if (is_packed_ply(path)) return read_gzip_bytes(path, kMaxFileBytes, bytes, memory);
  memory.reserve(path.string(), static_cast<std::size_t>(size));
  std::ifstream stream(path, std::ios::binary);
  bytes.resize(static_cast<std::size_t>(size));
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!stream) return "cannot read the file";
  return std::nullopt;
}

void read_named_bytes(const std::string& name, std::string& bytes, MeshReading& reading) {
  const std::filesystem::path relative(name);
  const bool leaves_folder = relative.is_absolute() || name.find("://") != std::string::npos ||
                             name.find('\\') != std::string::npos || name.find('\0') != std::string::npos ||
                             std::find(relative.begin(), relative.end(), "..") != relative.end();
  if (name.empty() || leaves_folder)
    throw MeshFault{fmt::format("it may name only files in its folder or below (got \"{}\")", name)};
  const std::filesystem::path path = reading.path.parent_path() / relative;
  if (const auto fault = read_mesh_bytes(path, bytes, reading.memory))
    throw MeshFault{fmt::format("\"{}\", which it names: {}", name, *fault)};
  reading.file.others.push_back(path);
}

std::optional<MeshFile> load_mesh_file(const std::filesystem::path& path, FileMaterials materials,
                                       const SourcePosition& where, Diagnostics& diagnostics,
                                       FileCoordinates coordinates, Inputs* inputs) {
  const auto refuse = [&](const std::string& message) {
    diagnostics.error(where, fmt::format("mesh \"{}\": {}", path.string(), message), ErrorCode::input);
    return std::nullopt;
  };
  MeshReading reading{path, materials, coordinates, {}, {}, {inputs, 0}};
  std::string bytes;
  if (const auto fault = read_mesh_bytes(path, bytes, reading.memory)) return refuse(*fault);
  const MeshReader read = mesh_reader_of(path);
  if (read == nullptr)
    return refuse(fmt::format("unknown format (got \"{}\", allowed .ply, .ply.gz, .obj, .gltf, .glb)",
                              path.extension().string()));
  try {
    read(std::move(bytes), reading);
  } catch (const MeshFault& fault) {
    return refuse(fault.text);
  }
  if (reading.file.submeshes.empty()) return refuse("no faces");
  for (MeshFile::Submesh& part : reading.file.submeshes)
    if (!check_mesh(part.mesh, where, diagnostics)) return std::nullopt;
  for (MeshFile::Submesh& part : reading.file.submeshes) complete_normals(part.mesh);
  for (const std::string& ignored : reading.ignored)
    if (materials != FileMaterials::named)
      diagnostics.warning(where, fmt::format("mesh \"{}\": {}", path.string(), ignored));
  return std::move(reading.file);
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
  const std::size_t dropped = drop_slivers(mesh);
  if (dropped > 0) diagnostics.warning(where, fmt::format("triangles of zero area removed: {}", dropped));
  if (!mesh.triangles.empty()) return true;
  diagnostics.error(where, "the mesh has no triangle of nonzero area", ErrorCode::input);
  return false;
}

std::optional<std::string> read_gzip_bytes(const std::filesystem::path& path, std::size_t limit,
                                           std::string& bytes, MemoryReservation& memory) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) return "cannot open the file";
  for (;;) {
    const std::size_t previous_size = bytes.size();
    if (bytes.capacity() < previous_size + kPiece) {
      const std::size_t room = std::max(2 * bytes.capacity(), previous_size + kPiece);
      memory.reserve(path.string(), room - bytes.capacity());
      bytes.reserve(room);
    }
    bytes.resize(previous_size + kPiece);
    const int read = gzread(file.get(), bytes.data() + previous_size, static_cast<unsigned>(kPiece));
    bytes.resize(previous_size + static_cast<std::size_t>(std::max(read, 0)));
    int code = Z_OK;
    const char* const message = gzerror(file.get(), &code);
    if (code == Z_BUF_ERROR) return "truncated: the compressed data are incomplete";
    if (read < 0) return fmt::format("damaged ({})", message);
    if (gzdirect(file.get()) != 0) return "is not a gzip file";
    if (bytes.size() > limit) return fmt::format("unpacks to more than {} bytes", limit);
    if (read == 0) return std::nullopt;
  }
}

}  // namespace abbe
