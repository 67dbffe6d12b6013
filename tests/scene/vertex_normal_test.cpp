#include <cmath>

#include <gtest/gtest.h>

#include "meshes.h"
#include "scene/scene.h"
#include "scene/shapes/shape.h"
#include "scenes.h"
#include "tests/description/gltf_asset.h"
#include "tests/description/mesh_files.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;
using test::Asset;
using test::Loaded;
using test::raw;

// Normals tilted in proportion to the distance of their corner from the center of the square (-1, -1) to (1,
// 1).
Mesh pillow() {
  Mesh mesh{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const auto normal = [&](std::uint32_t i) { return V3f(V3d(mesh.vertices[i] + V3d(0, 0, 1)).normalized()); };
  for (const auto& [a, b, c] : mesh.triangles) mesh.normals.push_back({normal(a), normal(b), normal(c)});
  return mesh;
}
Scene scene_with(Shape shape, std::shared_ptr<const Relief> relief = nullptr) {
  Scene scene{};
  scene.camera = test::pinhole();
  scene.materials = {test::mirror()};
  scene.materials[0].relief = std::move(relief);
  scene.shapes.push_back({"shape", std::move(shape), 0});
  scene.commit();
  return scene;
}
ShadingPoint place_at(const Scene& scene, float x, float y, float from) {
  const auto hit = scene.intersect({{x, y, from}, {0, 0, from > 0 ? -1.0F : 1.0F}});
  EXPECT_TRUE(hit);
  return textured_shading_point(scene, hit.value(), 0);
}
void expect_normal(const V3f& found, const V3d& expected) {
  EXPECT_LT((V3d(found) - expected).length(), 1e-6) << found << " " << expected;
}

TEST(VertexNormals, AreInterpolated) {
  const Scene scene = scene_with(pillow());
  EXPECT_TRUE(scene.features.textures);
  EXPECT_EQ(scene.features.reasons.at("textures"), "shape \"shape\"");
  EXPECT_FALSE(scene_with(Mesh{pillow().vertices, pillow().triangles}).features.textures);
  const double third = 1 / std::sqrt(3.0);
  for (const auto& [x, y] : {std::pair(0.5, -0.5), {0.9, 0.1}, {-0.25, 0.75}}) {
    const ShadingPoint place = place_at(scene, static_cast<float>(x), static_cast<float>(y), 5);
    expect_normal(place.frame.z, V3d(x * third, y * third, third).normalized());
    EXPECT_TRUE(place.relief);
  }
  // From behind they still point outward.
  expect_normal(place_at(scene, 0.5F, -0.5F, -5).frame.z, V3d(0.5, -0.5, 1).normalized());
}

// A plane z = 0 scaled by (2, 3, -1): normals transform by the inverse transpose and stay outward in a
// mirror.
TEST(VertexNormals, FollowInstances) {
  const auto at = std::make_shared<Placement>(placement(Imath::M44d().setScale(V3d(2, 3, -1))));
  const Scene scene = scene_with(PlacedShape{make_prototype(pillow()), at});
  expect_normal(place_at(scene, 1, -1.5F, -5).frame.z, V3d(0.5 / 2, -0.5 / 3, -1).normalized());
}

TEST(VertexNormals, TakeTheSideOfTheTriangle) {
  Mesh reversed = pillow();
  for (auto& corners : reversed.normals)
    for (V3f& normal : corners) normal = -normal;
  expect_normal(place_at(scene_with(reversed), 0.5F, -0.5F, 5).frame.z, V3d(0.5, -0.5, 1).normalized());
  Mesh cancelling = pillow();
  cancelling.normals[0] = {V3f(1, 0, 0), V3f(-1, 0, 0), V3f(1, 0, 0)};
  expect_normal(place_at(scene_with(cancelling), 0.5F, -0.5F, 5).frame.z, V3d(0, 0, 1));
}

// A flat relief leaves them unchanged, a tilted one tilts them.
TEST(VertexNormals, AreTurnedByReliefs) {
  Mesh mapped = pillow();
  mapped.coordinates = {{{{0, 0}, {1, 0}, {1, 1}}}, {{{0, 0}, {1, 1}, {0, 1}}}};
  const auto relief = [](float r, float g, float b) {
    return std::make_shared<const Relief>(NormalMap{TextureImage(1, 1, 3, {r, g, b}, {})});
  };
  const V3d smooth = V3d(0.5, 0, 1).normalized();
  expect_normal(place_at(scene_with(mapped, relief(0.5F, 0.5F, 1)), 0.5F, 0, 5).frame.z, smooth);
  const V3d along(smooth.z, 0, -smooth.x);
  expect_normal(place_at(scene_with(mapped, relief(0.8F, 0.5F, 0.9F)), 0.5F, 0, 5).frame.z,
                along * 0.6 + smooth * 0.8);
}

class VertexNormalFiles : public test::MeshFileTest {};

constexpr double kSin = 0.6;
constexpr double kCos = 0.8;

void expect_leaning(const Mesh& mesh, const V3d& normal = {0, kSin, kCos}) {
  ASSERT_EQ(mesh.normals.size(), 1U);
  for (const V3f& corner : mesh.normals[0]) expect_normal(corner, normal);
}

std::string ply_with_normals(const std::string& body, const std::string& format = "ascii") {
  return "ply\nformat " + format +
         " 1.0\ncomment x y z\nelement vertex 3\nproperty float x\nproperty float nx\nproperty float "
         "y\nproperty uchar "
         "red\nproperty float z\nproperty double ny\nproperty float nz\nelement face 1\nproperty list uchar "
         "int "
         "vertex_indices\nelement edge 1\nproperty float x\nend_header\n" +
         body;
}

TEST_F(VertexNormalFiles, OfPly) {
  expect_leaning(
      mesh("a.ply", ply_with_normals("0 0 0 7 0 0.6 0.8\n2 0 0 7 0 3 4\n0 0 2 7 0 0.6 0.8\n3 0 1 2\n5\n")));
  std::string body;
  for (const auto& [x, y] : {std::pair(0.0F, 0.0F), {2.0F, 0.0F}, {0.0F, 2.0F}})
    body +=
        raw<float>({x, 0, y}) + raw<std::uint8_t>({7}) + raw<float>({0}) + raw<double>({6}) + raw<float>({8});
  body += raw<std::uint8_t>({3}) + raw<std::int32_t>({0, 1, 2}) + raw<float>({5});
  const Mesh binary = mesh("b.ply", ply_with_normals(body, "binary_little_endian"));
  expect_leaning(binary);
  EXPECT_EQ(binary.vertices[2], V3d(0, 2, 0));
}

TEST_F(VertexNormalFiles, OfObj) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 3 4\nvn 0 0.6 0.8\nvn 0 0 0\n";
  expect_leaning(mesh("a.obj", corners + "f 1//1 2//2 3//-2\n"));
  EXPECT_TRUE(mesh("a.obj", corners + "f 1 2 3\n").normals.empty());
  // Faces without normals are flat.
  const Mesh both = mesh("a.obj", corners + "f 1 2 3\nf 1//1 2//1 3//1\nf 3 2 1\n");
  ASSERT_EQ(both.normals.size(), 3U);
  expect_normal(both.normals[0][1], {0, 0, 1});
  expect_normal(both.normals[1][1], {0, kSin, kCos});
  expect_normal(both.normals[2][1], {0, 0, -1});
}

Asset with_normals(const std::vector<float>& normals) {
  Asset asset;
  asset.primitive = R"("attributes": {"POSITION": 0, "NORMAL": 2}, "indices": 1)";
  asset.accessors.back() = ',';
  asset.accessors += fmt::format(
      R"({{"bufferView": 2, "componentType": 5126, "count": {}, "type": "VEC3"}}])", normals.size() / 3);
  asset.views.back() = ',';
  asset.views += fmt::format(R"({{"buffer": 0, "byteOffset": 44, "byteLength": {}}}])", 4 * normals.size());
  asset.buffer = fmt::format(R"({{"byteLength": {}, "uri": "data:application/octet-stream;base64,{}"}})",
                             44 + 4 * normals.size(), test::base64(test::triangle_bytes() + raw(normals)));
  return asset;
}

TEST_F(VertexNormalFiles, OfGltf) {
  Asset asset = with_normals({0, 0.6F, 0.8F, 0, 3, 4, 0, 0.6F, 0.8F});
  expect_leaning(mesh("a.gltf", asset.text()));
  asset.nodes = R"([{"mesh": 0, "scale": [2, 2, -4]}])";
  const Mesh mirrored = mesh("a.gltf", asset.text());
  expect_leaning(mirrored, V3d(0, kSin / 2, -kCos / 4).normalized());
  EXPECT_GT(area_vector(mirrored, 0).dot(V3d(mirrored.normals[0][0])), 0);
}

TEST_F(VertexNormalFiles, MoveWithTheirShape) {
  test::write(folder_ / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 3 4\nf 1//1 2//1 3//1\n");
  const Shape turned =
      shape(R"("mesh": "a.obj", "transform": {"scale": 3, "rotate": {"axis": [1, 0, 0], "deg": 90}})");
  expect_leaning(std::get<Mesh>(turned), {0, -kCos, kSin});
}

TEST_F(VertexNormalFiles, FaultsAreNamed) {
  const auto in = ErrorCode::input;
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 0\n";
  expect_refused(
      "a.obj",
      {{"zero", corners + "f 1//1 2//2 3//1\n", in, "line 6: vn 2 has no direction"},
       {"beyond", corners + "f 1//1 2//3 3//1\n", in, "no such vn (got 3, allowed [1, 2])"},
       {"no number", corners + "vn 0 nan 1\n", in, "line 6: vn 3 needs three finite numbers (got 0 nan 1)"}});
  const auto refused_ply = [&](const std::string& text, const char* message) {
    test::write(folder_ / "a.ply", text);
    const Loaded loaded = load(test::shaped(R"("mesh": "a.ply")"));
    EXPECT_EQ(loaded.diagnostics.code(), in);
    EXPECT_NE(loaded.text().find(message), std::string::npos) << loaded.text();
  };
  refused_ply(ply_with_normals("0 0 0 7 0 0.6 0.8\n2 0 0 7 0 0 0\n0 0 2 7 0 0.6 0.8\n3 0 1 2\n5\n"),
              "the normal of vertex 1 has no direction");
  refused_ply(ply_with_normals("0 0 0 7 0 0.6 0.8\n2 0 0 7 0 0 1\n0 0 2 7 0 -nan 0.8\n3 0 1 2\n5\n"),
              "vertex 2 needs finite numbers (got \"nan\")");
  refused_ply(
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0\n3 0 0 "
      "0\n",
      "a normal needs nx, ny and nz");
  expect_refused("a.gltf", {{"zero", with_normals({0, 0, 1, 0, 0, 1, 0, 0, 0}).text(), in,
                             "the normal of vertex 2 has no direction"},
                            {"nan", with_normals({0, 0, 1, 0, NAN, 1, 0, 0, 1}).text(), in,
                             "the normal of vertex 1 has no direction"},
                            {"too few", with_normals({0, 0, 1, 0, 0, 1}).text(), in,
                             "as many normals as positions are needed (got 2, allowed 3)"}});
}

// The facets refract light. Without a warning the mesh would be taken for a smooth ball.
TEST_F(VertexNormalFiles, AreIgnoredAroundMatterWithAWarning) {
  test::write(folder_ / "ball.obj", test::obj_text(test::icosphere(1, true)));
  const std::string shape = R"("shapes": [{"mesh": "ball.obj", "material": "m"}]})";
  const Loaded glass = load(R"({"materials": {"m": {"dielectric": {"ior": 1.5}}}, )" + shape);
  ASSERT_TRUE(glass.scene) << glass.text();
  EXPECT_TRUE(std::get<Mesh>(glass->shapes[0].shape).normals.empty());
  const std::string fault = R"(mesh "ball.obj" around medium "m": vertex normals are ignored)";
  EXPECT_NE(glass.text().find("/shapes/0/mesh: warning: " + fault), std::string::npos) << glass.text();
  Diagnostics strict(Strictness::strict);
  EXPECT_FALSE(load_scene(folder_ / "scene.json", {}, strict));
  EXPECT_NE(strict.text().find("/shapes/0/mesh: error: " + fault), std::string::npos) << strict.text();
  const Loaded paint = load(R"({"materials": {"m": {"diffuse": {"reflectance": 0.5}}}, )" + shape);
  EXPECT_EQ(std::get<Mesh>(paint->shapes[0].shape).normals.size(), 80U);
  EXPECT_EQ(paint.text().find("normals"), std::string::npos) << paint.text();
}

}  // namespace
}  // namespace abbe
