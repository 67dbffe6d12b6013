#include <gtest/gtest.h>

#include "gltf_asset.h"
#include "mesh_files.h"
#include "scene/shapes/mesh.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

using test::Asset;
using test::base64;
using test::Fault;
using test::glb;
using test::Loaded;
using test::raw;
using test::shaped;
using test::triangle_bytes;
using test::write;

class GltfTest : public test::MeshFileTest {
 protected:
  // Diagnostics of a scene with the asset.
  std::string load_with(const Asset& asset) {
    write(folder_ / "a.gltf", asset.text());
    const Loaded loaded = load(shaped(R"("mesh": "a.gltf")"));
    EXPECT_TRUE(loaded.scene);
    return loaded.text();
  }
};

TEST_F(GltfTest, WarnsOfLightsAndCameras) {
  Asset asset;
  EXPECT_EQ(load_with(asset).find("warning: mesh"), std::string::npos);
  asset.nodes = R"([{"mesh": 0, "camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}])";
  asset.more = R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
      "extensionsUsed": ["KHR_lights_punctual"], "extensionsRequired": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}, {"type": "directional"}]}})";
  const std::string warned = load_with(asset);
  EXPECT_NE(warned.find("a.gltf\": its lights are not read (2 of them)"), std::string::npos) << warned;
  EXPECT_NE(warned.find("a.gltf\": its cameras are not read (1 of them)"), std::string::npos) << warned;
}

TEST_F(GltfTest, ReadsPrimitives) {
  const Asset asset;
  const std::vector<std::array<std::uint32_t, 3>> one{{0, 1, 2}};
  EXPECT_EQ(mesh("a.gltf", asset.text()).triangles, one);
  EXPECT_EQ(mesh("a.gltf", asset.text()).vertices[1], Imath::V3d(1, 0, 0));

  Asset outside = asset;
  write(folder_ / "two words.bin", triangle_bytes());
  outside.buffer = R"({"byteLength": 44, "uri": "two%20words.bin"})";
  const MeshFile file = read("a.gltf", outside.text());
  EXPECT_EQ(file.submeshes.at(0).mesh.triangles, one);
  ASSERT_EQ(file.others.size(), 1U);
  EXPECT_EQ(file.others[0], folder_ / "two words.bin");

  Asset jointed = asset;
  jointed.more = R"(, "skins": [{"joints": [0]}, {"joints": [0]}])";
  EXPECT_EQ(mesh("a.gltf", jointed.text()).triangles, one);

  Asset pictured = outside;
  pictured.more = R"(, "images": [{"uri": "gone.png"}, {"uri": "two%20words.bin"}])";
  EXPECT_EQ(read("a.gltf", pictured.text()).others, file.others) << "images are not read";

  Asset within = asset;
  within.buffer = R"({"byteLength": 44})";
  EXPECT_EQ(mesh("a.glb", glb(within.text(), triangle_bytes())).triangles, one);

  Asset strip = asset;
  strip.primitive = R"("attributes": {"POSITION": 0}, "mode": 5)";
  strip.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}])";
  strip.views = R"([{"buffer": 0, "byteLength": 64, "byteStride": 16, "byteOffset": 4}])";
  strip.buffer = R"({"byteLength": 68, "uri": "data:application/octet-stream;base64,)" +
                 base64(raw<float>({9, 0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9, 1, 1, 0, 9})) + "\"}";
  const Mesh square = mesh("a.gltf", strip.text());
  ASSERT_EQ(square.triangles.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(area_vector(square, i), Imath::V3d(0, 0, 0.5));
  strip.primitive = R"("attributes": {"POSITION": 0}, "mode": 1)";
  write(folder_ / "a.gltf", strip.text());
  EXPECT_NE(load(shaped(R"("mesh": "a.gltf")")).text().find("no faces"), std::string::npos)
      << "lines are none";
}

TEST_F(GltfTest, NodesPlaceMeshes) {
  Asset asset;
  asset.roots = "[0, 3]";
  // The parent scales, rotates z to x by 90 degrees about y, and translates. The child doubles everything;
  // the last node mirrors.
  asset.nodes =
      R"([{"translation": [10, 0, 0], "rotation": [0, 0.70710678118654752, 0, 0.70710678118654752], "children": [1]},
                    {"scale": [2, 2, 2], "children": [2]},
                    {"mesh": 0, "translation": [0, 0, 1]},
                    {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 5, 1]}])";
  const Mesh both = mesh("a.gltf", asset.text());
  ASSERT_EQ(both.vertices.size(), 6U);
  const auto near = [&](std::size_t i, const Imath::V3d& at) {
    EXPECT_LT((both.vertices[i] - at).length(), 1e-12) << i;
  };
  near(0, {12, 0, 0});
  near(1, {12, 0, -2});
  near(2, {12, 2, 0});
  near(4, {1, 0, 5});
  EXPECT_LT((area_vector(both, 0) - Imath::V3d(2, 0, 0)).length(), 1e-12);
  EXPECT_LT((area_vector(both, 1) - Imath::V3d(0, 0, -0.5)).length(), 1e-12) << "outward in a mirror";
}

TEST_F(GltfTest, BringsItsMaterials) {
  Asset asset;
  asset.more = R"(, "materials": [
    {"name": "paint", "pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.4, 0.9, 1], "metallicFactor": 0, "roughnessFactor": 0.4},
     "normalTexture": {"index": 0}},
    {"name": "window", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
     "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.7}}}])";
  const auto made_of = [&](const std::string& number) {
    Asset one = asset;
    if (!number.empty()) one.primitive += ", \"material\": " + number;
    write(folder_ / "a.gltf", one.text());
    return load(R"({"shapes": [{"mesh": "a.gltf"}]})");
  };
  const Loaded paint = made_of("0");
  ASSERT_TRUE(paint.scene) << paint.text();
  const LinearRgb color = linear_rgb(
      std::get<DiffuseMaterial>(paint->materials[paint->shapes[0].material].model).reflectance.curve());
  EXPECT_NEAR(color[0], 0.2, 1e-3);
  EXPECT_NEAR(color[1], 0.4, 1e-3);
  EXPECT_NEAR(color[2], 0.9, 1e-3);
  EXPECT_NE(paint.text().find("/shapes/0/mesh: warning: material \"paint\" of \"a.gltf\": roughness 0.4, "
                              "normal texture are not represented"),
            std::string::npos)
      << paint.text();
  const Loaded window = made_of("1");
  ASSERT_TRUE(window.scene);
  const auto& glass = std::get<DielectricMaterial>(window->materials[window->shapes[0].material].model);
  EXPECT_EQ(glass.index.n(550), 1.7);
  EXPECT_EQ(window.text().find("not represented"), std::string::npos) << window.text();
  EXPECT_NE(made_of("").text().find("material \"default\" of \"a.gltf\": metallic 1 is not represented"),
            std::string::npos);
  EXPECT_NE(made_of("2").text().find("a material does not exist"), std::string::npos);
  EXPECT_EQ(made_of("2").diagnostics.code(), ErrorCode::input);
}

TEST_F(GltfTest, RefusesBadFiles) {
  const auto in = ErrorCode::input;
  const auto with = [](auto Asset::*member, const std::string& text) {
    Asset asset;
    asset.*member = text;
    return asset.text();
  };
  const auto accessor = [&](const std::string& positions) {
    return with(
        &Asset::accessors,
        "[" + positions + R"(, {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}])");
  };
  const std::string whole = glb(Asset().text(), "");
  Asset within;
  within.buffer = R"({"byteLength": 52})";
  std::string beyond_end = glb(within.text(), triangle_bytes());
  beyond_end[beyond_end.size() - 52] = 52;  // length of its last chunk
  const std::string deep(300, '[');
  std::string chunky = whole;
  chunky[14] = '\x7F';
  expect_refused(
      "bad.gltf",
      {{"no JSON", "solid", in, "malformed JSON"},
       {"an old version", R"({"asset": {"version": "1.0"}})", in, "not a glTF 2.0 asset"},
       {"no scene", R"({"asset": {"version": "2.0"}})", in, "it has no scene"},
       {"a truncated GLB", whole.substr(0, whole.size() - 5), in, "malformed or truncated GLB"},
       {"only a magic", "glTF", in, "malformed or truncated GLB"},
       {"a last chunk longer by its header", beyond_end, in, "malformed or truncated GLB"},
       {"two buffers of one chunk", with(&Asset::buffer, R"({"byteLength": 1}, {"byteLength": 1})"), in,
        "more than one buffer has no uri"},
       {"deep", with(&Asset::more, ", \"extras\": " + deep + std::string(300, ']')), in, "nesting too deep"},
       {"an empty buffer", glb(with(&Asset::buffer, R"({"byteLength": 0})"), "1234"), in,
        "vector::_M_range_check"},
       {"a lying chunk", chunky, in, "malformed or truncated GLB"},
       {"a loop", with(&Asset::nodes, R"([{"mesh": 0, "children": [0]}])"), in, "node 0 is reached twice"},
       {"a child twice", with(&Asset::nodes, R"([{"children": [1, 1]}, {"mesh": 0}])"), in,
        "node 1 is reached twice"},
       {"no such node", with(&Asset::roots, "[7]"), in, "a node does not exist"},
       {"no such mesh", with(&Asset::nodes, R"([{"mesh": 1}])"), in, "a mesh does not exist"},
       {"no positions", with(&Asset::primitive, R"("attributes": {})"), in, "accessor -1: it does not exist"},
       {"a long accessor",
        accessor(R"({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"})"), in,
        "accessor 0: it needs more bytes than the buffer holds"},
       {"a huge accessor",
        accessor(R"({"bufferView": 0, "componentType": 5126, "count": 4611686018427387905, "type": "VEC3"})"),
        in, "needs more bytes"},
       {"a negative count",
        accessor(R"({"bufferView": 0, "componentType": 5126, "count": -1, "type": "VEC3"})"), in,
        "'count' property is not a positive integer"},
       {"a far offset",
        accessor(
            R"({"bufferView": 0, "byteOffset": 9007199254740000, "componentType": 5126, "count": 3, "type": "VEC3"})"),
        in, "needs more bytes"},
       {"an empty one", accessor(R"({"bufferView": 0, "componentType": 5126, "count": 0, "type": "VEC3"})"),
        in, "it is empty"},
       {"pairs", accessor(R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"})"), in,
        "wrong type (allowed VEC3)"},
       {"shorts", accessor(R"({"bufferView": 0, "componentType": 5123, "count": 3, "type": "VEC3"})"), in,
        "positions must be floats"},
       {"halves", accessor(R"({"bufferView": 0, "componentType": 5131, "count": 3, "type": "VEC3"})"), in,
        "Invalid `componentType` in accessor. Got 5131"},
       {"signed indices",
        with(&Asset::accessors, R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                                    {"bufferView": 1, "componentType": 5122, "count": 3, "type": "SCALAR"}])"),
        in, "indices must be integers >= 0"},
       {"sparse",
        accessor(
            R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}}})"),
        in, "sparse accessors are not supported"},
       {"a narrow stride",
        with(
            &Asset::views,
            R"([{"buffer": 0, "byteLength": 36, "byteStride": 4}, {"buffer": 0, "byteOffset": 36, "byteLength": 8}])"),
        in, "needs more bytes"},
       {"a long view",
        with(&Asset::views,
             R"([{"buffer": 0, "byteLength": 45}, {"buffer": 0, "byteOffset": 36, "byteLength": 8}])"),
        in, "its view exceeds the buffer"},
       {"a far view",
        with(
            &Asset::views,
            R"([{"buffer": 0, "byteOffset": 9007199254740992, "byteLength": 36}, {"buffer": 0, "byteLength": 8}])"),
        in, "its view exceeds the buffer"},
       {"no such buffer",
        with(&Asset::views, R"([{"buffer": 1, "byteLength": 36}, {"buffer": 0, "byteLength": 8}])"), in,
        "its view exceeds the buffer"},
       {"a long buffer",
        with(&Asset::buffer, R"({"byteLength": 44, "uri": "data:application/octet-stream;base64,AAAA"})"), in,
        "Failed to decode 'uri' : data:application/octet-stream;base64,AAAA"},
       {"no length", with(&Asset::buffer, R"({"uri": "data:application/octet-stream;base64,AAAA"})"), in,
        "'byteLength' property is missing in Buffer"},
       {"no base64",
        with(&Asset::buffer, R"({"byteLength": 1, "uri": "data:application/octet-stream;base64,A*A"})"), in,
        "Failed to decode 'uri' : data:application/octet-stream;base64,A*A"},
       {"no bytes", with(&Asset::buffer, R"({"byteLength": 1})"), in,
        "'uri' is missing from non binary glTF file buffer"},
       {"climbing out", with(&Asset::buffer, R"({"byteLength": 44, "uri": "a/../../secret"})"), in,
        "in its folder or below"},
       {"climbing in code", with(&Asset::buffer, R"({"byteLength": 44, "uri": "%2e%2E/secret"})"), in,
        "in its folder or below (got \"../secret\")"},
       {"absolute", with(&Asset::buffer, R"({"byteLength": 44, "uri": "/etc/passwd"})"), in,
        "in its folder or below"},
       {"a URL", with(&Asset::buffer, R"({"byteLength": 44, "uri": "https://example.org/a"})"), in,
        "in its folder or below"},
       {"missing", with(&Asset::buffer, R"({"byteLength": 44, "uri": "gone.bin"})"), in,
        "\"gone.bin\", which it names: no such file"},
       {"a primitive of no attributes", with(&Asset::primitive, R"("attributes": 1)"), in,
        "'attributes' property"},
       {"compressed", with(&Asset::more, R"(, "extensionsRequired": ["KHR_draco_mesh_compression"])"), in,
        "it requires the extension KHR_draco_mesh_compression"},
       {"too bright",
        with(&Asset::more, R"(, "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [2, 0, 0, 1]}}])"),
        in, "baseColorFactor (got [2, 0, 0, 1], allowed [0, 1])"},
       {"an index of 0",
        with(
            &Asset::more,
            R"(, "materials": [{"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 0}}}])"),
        in, "ior (got 0, allowed (0, 100])"}});
  Asset beyond;
  beyond.buffer = R"({"byteLength": 44, "uri": "data:application/octet-stream;base64,)" +
                  base64(raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + raw<std::uint16_t>({0, 1, 3, 0})) + "\"}";
  expect_refused("bad.gltf", {{"an index beyond", beyond.text(), in,
                               "an index names a vertex that does not exist (got 3, allowed [0, 2])"}});
}

}  // namespace
}  // namespace abbe
