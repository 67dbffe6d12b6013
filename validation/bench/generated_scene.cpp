#include "validation/bench/generated_scene.h"

#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "io/atomic_file.h"

namespace abbe {
namespace {

double height(double x, double z) {
  return 0.35 * std::sin(0.9 * x) * std::cos(0.7 * z) + 0.12 * std::sin(2.3 * x + 1.1) * std::sin(2.9 * z) +
         0.04 * std::sin(7.1 * x) * std::cos(6.3 * z + 0.4);
}

template <typename T>
void append(std::string& bytes, T value) {
  static_assert(std::endian::native == std::endian::little);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

// Fractional part of i times an irrational number: a sequence of low discrepancy in [0, 1).
double fractional_part(int i, double number) {
  const double turns = i * number;
  return turns - std::floor(turns);
}

}  // namespace

Mesh make_terrain(std::uint32_t cells) {
  constexpr double kHalf = 20;
  Mesh mesh;
  const std::uint32_t row = cells + 1;
  for (std::uint32_t j = 0; j < row; ++j)
    for (std::uint32_t i = 0; i < row; ++i) {
      const double x = kHalf * (2.0 * i / cells - 1);
      const double z = kHalf * (2.0 * j / cells - 1);
      mesh.vertices.emplace_back(x, height(x, z), z);
    }
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * row + i;
      mesh.triangles.push_back({a, a + row, a + 1});
      mesh.triangles.push_back({a + 1, a + row, a + row + 1});
    }
  return mesh;
}

Mesh make_bumpy_ball(std::uint32_t rows) {
  constexpr double kPi = std::numbers::pi;
  const std::uint32_t columns = 2 * rows;
  const Imath::V3d center(0, 1.8, 0);
  const auto point = [&](double theta, double phi) {
    const double r = 1.5 * (1 + 0.04 * std::sin(20 * theta) * std::sin(20 * phi));
    return center +
           r * Imath::V3d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  };
  Mesh mesh;
  mesh.vertices = {point(0, 0), point(kPi, 0)};
  for (std::uint32_t j = 1; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i)
      mesh.vertices.push_back(point(kPi * j / rows, 2 * kPi * i / columns));
  const auto at = [columns](std::uint32_t j, std::uint32_t i) { return 2 + (j - 1) * columns + i % columns; };
  for (std::uint32_t i = 0; i < columns; ++i) {
    mesh.triangles.push_back({0, at(1, i + 1), at(1, i)});
    mesh.triangles.push_back({1, at(rows - 1, i), at(rows - 1, i + 1)});
    for (std::uint32_t j = 1; j + 1 < rows; ++j) {
      mesh.triangles.push_back({at(j, i), at(j, i + 1), at(j + 1, i)});
      mesh.triangles.push_back({at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)});
    }
  }
  return mesh;
}

Mesh make_ring(std::uint32_t sides) {
  struct Corner {
    double radius, y;
  };
  // Corners of the cross-section, ordered so that the faces between neighbours point outwards.
  constexpr std::array<Corner, 4> kSection{{{0.9, 0}, {1, 0}, {1, 0.5}, {0.9, 0.5}}};
  const auto corners = static_cast<std::uint32_t>(kSection.size());
  Mesh mesh;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double phi = 2 * std::numbers::pi * i / sides;
    for (const auto& [radius, y] : kSection)
      mesh.vertices.emplace_back(radius * std::cos(phi), y, radius * std::sin(phi));
  }
  for (std::uint32_t i = 0; i < sides; ++i)
    for (std::uint32_t j = 0; j < corners; ++j) {
      const std::uint32_t next = (i + 1) % sides * corners;
      const std::uint32_t k = (j + 1) % corners;
      mesh.triangles.push_back({i * corners + j, i * corners + k, next + j});
      mesh.triangles.push_back({next + j, i * corners + k, next + k});
    }
  return mesh;
}

void write_ply(const std::filesystem::path& path, const Mesh& mesh) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  for (const Imath::V3d& v : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) append(bytes, static_cast<float>(v[axis]));
  for (const auto& triangle : mesh.triangles) {
    append(bytes, std::uint8_t{3});
    for (const std::uint32_t vertex : triangle) append(bytes, vertex);
  }
  write_atomically(path, bytes);
}

std::string make_lights(int rows) {
  constexpr std::array<const char*, 3> kSpectra{"A", "D65", "FL11"};
  const double step = 38.0 / rows;
  std::string lights;
  for (int i = 0; i < rows * rows; ++i) {
    const int row = i / rows;
    const double x = -19 + step * (i % rows + fractional_part(i, 0.6180339887));
    const double y = 5.9 - 2 * fractional_part(i, 0.7548776662);
    const double z = -19 + step * (row + fractional_part(i, 0.5698402910));
    const double strength = std::pow(30, fractional_part(i, 0.4142135624));
    const std::string shape =
        i % 8 == 0 ? fmt::format(
                         R"("spot": {{"at": [{}, {}, {}], "direction": [{}, -1, {}], "half_angle_deg": 30}})",
                         x, y, z, fractional_part(i, 0.3) - 0.5, fractional_part(i, 0.7) - 0.5)
        : i % 8 == 4
            ? fmt::format(R"("sphere": {{"center": [{}, {}, {}], "radius": 0.01}})", x, y, z)
            : fmt::format(
                  R"("quad": {{"corner": [{}, {}, {}], "edge_u": [0.02, 0, 0], "edge_v": [0, 0, 0.02]}})", x,
                  y, z);
    lights += fmt::format(R"({}{{{}, "emission": {{"illuminant": "{}", "luminous_flux_lm": {}}}}})",
                          i == 0 ? "" : ",", shape, kSpectra[static_cast<std::size_t>(i % 3)], strength);
  }
  return "[" + lights + "]";
}

}  // namespace abbe
