#include <cstring>

#include <gtest/gtest.h>

#include "description.h"
#include "scene/shapes/mesh.h"
#include "scene/shapes/mesh_file.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

using testing::Fault;
using testing::Loaded;
using testing::shaped;
using testing::write;

constexpr const char* kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : bytes) {
    bits = bits << 8 | static_cast<unsigned char>(c);
    for (held += 8; held >= 6; held -= 6) text += digits[bits >> (held - 6) & 63];
  }
  if (held > 0) text += digits[bits << (6 - held) & 63];
  return text;
}

template <typename T>
std::string raw(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

// Three corners of a triangle of area 1/2 in xy, and its indices as shorts, padded to 44 bytes.
std::string triangle_bytes() {
  return raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + raw<std::uint16_t>({0, 1, 2, 0});
}

std::string glb(const std::string& json, const std::string& binary) {
  std::string padded = json + std::string((4 - json.size() % 4) % 4, ' ');
  const auto chunk = [](const std::string& body, std::uint32_t type) {
    return raw<std::uint32_t>({static_cast<std::uint32_t>(body.size()), type}) + body;
  };
  const std::string chunks = chunk(padded, 0x4E4F534A) + (binary.empty() ? "" : chunk(binary, 0x004E4942));
  return "glTF" + raw<std::uint32_t>({2, static_cast<std::uint32_t>(chunks.size() + 12)}) + chunks;
}

/// The parts of an asset that tests change.
struct Asset {
  std::string nodes = R"([{"mesh": 0}])";
  std::string roots = "[0]";
  std::string primitive = R"("attributes": {"POSITION": 0}, "indices": 1)";
  std::string accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                              {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}])";
  std::string views =
      R"([{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8}])";
  std::string buffer = R"({"byteLength": 44, "uri": "data:application/octet-stream;base64,)" +
                       base64(triangle_bytes()) + "\"}";
  std::string more;

  [[nodiscard]] std::string text() const {
    return R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": )" + roots + R"(}], "nodes": )" + nodes +
           R"(, "meshes": [{"primitives": [{)" + primitive + R"(}]}], "accessors": )" + accessors +
           R"(, "bufferViews": )" + views + R"(, "buffers": [)" + buffer + "]" + more + "}";
  }
};

class MeshFileTest : public testing::DescriptionTest {
 protected:
  MeshFile read(const std::string& name, const std::string& bytes,
                FileMaterials materials = FileMaterials::ignored) {
    write(folder_ / name, bytes);
    Diagnostics diagnostics;
    auto file = load_mesh_file(folder_ / name, materials, {}, diagnostics);
    EXPECT_TRUE(file) << diagnostics.text();
    return file.value_or(MeshFile{});
  }
  Mesh mesh(const std::string& name, const std::string& bytes) {
    MeshFile file = read(name, bytes);
    EXPECT_EQ(file.parts.size(), 1U);
    return file.parts.empty() ? Mesh{} : file.parts[0].mesh;
  }
  void expect_refused(const std::string& name, const std::vector<Fault>& faults) {
    for (const Fault& fault : faults) {
      SCOPED_TRACE(fault.what);
      write(folder_ / name, fault.fragment);
      const Loaded loaded = load(fmt::format(R"({{"shapes": [{{"mesh": "{}"}}]}})", name));
      EXPECT_FALSE(loaded.scene);
      EXPECT_EQ(loaded.diagnostics.code(), fault.code);
      EXPECT_NE(loaded.text().find(fault.message), std::string::npos) << loaded.text();
    }
  }
};

TEST_F(MeshFileTest, ReadsObj) {
  const Mesh cut =
      mesh("a.obj", std::string("# a comment\r\n") + kCorners +
                        "vn 0 0 1\nvt 0 0\ng part\nf 1/1/1 2/1/1 3/1/1\nf -4//1 -2//1 -1//1 2\n");
  const std::vector<std::array<std::uint32_t, 3>> expected{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
  EXPECT_EQ(cut.triangles, expected);
  EXPECT_EQ(cut.vertices.size(), 4U);
}

TEST_F(MeshFileTest, ObjBringsItsMaterials) {
  write(folder_ / "a.mtl",
        "newmtl red paint\nKd 0.8 0.1 0.05\nKs 1 1 1\nNs 10\nillum 2\nKs 0.5 0.5 0.5\n"
        "newmtl plain\nKd 0.5 0.5 0.5\n");
  write(folder_ / "a.obj", std::string("mtllib a.mtl\n") + kCorners +
                               "usemtl red paint\nf 1 2 3\nusemtl plain\nf 1 2 4\nf 1 3 4\n");
  const Loaded loaded =
      load(R"({"units": "cm", "shapes": [{"mesh": "a.obj", "name": "thing", "transform": {"scale": 2}}]})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  ASSERT_EQ(loaded->shapes.size(), 2U);
  EXPECT_EQ(loaded->shapes[0].name, "thing/red paint");
  const auto& second = std::get<Mesh>(loaded->shapes[1].shape);
  EXPECT_EQ(second.vertices.size(), 4U);
  EXPECT_NEAR(area(second), 4e-4, 1e-12) << "two halves of a square of 2 cm";
  const auto& [from, along, up] = second.triangles.at(0);
  EXPECT_LT((second.vertices[up] - second.vertices[from] - Imath::V3d(0, 0, 0.02)).length(), 1e-12);
  EXPECT_LT((second.vertices[along] - second.vertices[from] - Imath::V3d(0.02, 0, 0)).length(), 1e-12);
  const Material& red = loaded->materials[loaded->shapes[0].material];
  EXPECT_EQ(red.name, "a.obj:red paint");
  const LinearRgb color = linear_rgb(std::get<DiffuseMaterial>(red.model).reflectance);
  EXPECT_NEAR(color[0], 0.8, 1e-3);
  EXPECT_NEAR(color[1], 0.1, 1e-3);
  EXPECT_NEAR(color[2], 0.05, 1e-3);
  EXPECT_NE(loaded.text().find(
                "/shapes/0/mesh: warning: material \"red paint\" of \"a.obj\": Ks, Ns are not represented"),
            std::string::npos)
      << loaded.text();
  EXPECT_EQ(loaded.text().find("\"plain\""), std::string::npos) << "nothing of it is lost";

  write(folder_ / "two words.mtl", "newmtl plain\nKd 1 1 1\n");
  write(folder_ / "b.obj", std::string("mtllib two words.mtl\n") + kCorners + "usemtl plain\nf 1 2 3\n");
  EXPECT_TRUE(load(R"({"shapes": [{"mesh": "b.obj"}]})").scene);

  // The scene's hash knows the materials too.
  const std::string before = loaded->sha256;
  write(folder_ / "a.mtl", "newmtl red paint\nKd 0.8 0.1 0.06\nnewmtl plain\n");
  EXPECT_NE(
      load(R"({"units": "cm", "shapes": [{"mesh": "a.obj", "name": "thing", "transform": {"scale": 2}}]})")
          ->sha256,
      before);

  const Loaded own = load(shaped(R"("mesh": "a.obj")"));
  ASSERT_TRUE(own.scene) << own.text();
  EXPECT_EQ(own->shapes.size(), 1U) << "one material for all";
  EXPECT_EQ(own->materials.size(), 1U);
}

TEST_F(MeshFileTest, RefusesBadObj) {
  const auto in = ErrorCode::input;
  write(folder_ / "bad.mtl", "newmtl a\nKd 0.1 2 0\n");
  write(folder_ / "curve.mtl", "newmtl a\n  Kd spectral a.rfl\n");
  write(folder_ / "early.mtl", "Kd 0.1 0 0\n");
  expect_refused(
      "bad.obj",
      {{"an index beyond", std::string(kCorners) + "f 1 2 5\n", in,
        "line 5: no such vertex (got 5, allowed [1, 4])"},
       {"an index before", std::string(kCorners) + "f 1 2 -5\n", in, "no such vertex (got -5"},
       {"zero", std::string(kCorners) + "f 1 2 0\n", in, "no such vertex (got 0"},
       {"no number", std::string(kCorners) + "f 1 2 x\n", in, "no such vertex (got 0"},
       {"two corners", std::string(kCorners) + "f 1 2\n", in,
        "line 5: a face of 2 corners (allowed 3 or more)"},
       {"half a vertex", "v 1 2\nf 1 1 1\n", in, "line 1: a vertex needs three finite numbers (got 1 2)"},
       {"infinite", "v 1 2 inf\n", in, "three finite numbers"},
       {"empty", "", in, "no faces"},
       {"no area", std::string(kCorners) + "f 1 1 2\n", in, "a mesh without a triangle of any area"},
       {"missing library", "mtllib gone.mtl\n", in, "\"gone.mtl\", which it names: no such file"},
       {"climbing out", "mtllib ../a.mtl\n", in, "it may name files beside it only (got \"../a.mtl\")"},
       {"absolute", "mtllib /etc/passwd\n", in, "beside it only (got \"/etc/passwd\")"},
       {"unknown material", "mtllib bad.mtl\n", in,
        "\"bad.mtl\" line 2: Kd (got 0.1 2 0, allowed three of [0, 1])"},
       {"a curve", "mtllib curve.mtl\n", in,
        "\"curve.mtl\" line 2: Kd (got spectral a.rfl, allowed three of [0, 1])"},
       {"a material without a name", "mtllib early.mtl\n", in,
        "line 1: \"early.mtl\" has a material without a name"},
       {"unknown material", std::string(kCorners) + "usemtl wod\nf 1 2 3\n", in,
        "line 5: unknown material \"wod\""},
       {"no material", std::string(kCorners) + "f 1 2 3\n", ErrorCode::scene,
        "triangles without a material"}});
  write(folder_ / "bad.stl", "solid");
  EXPECT_NE(load(shaped(R"("mesh": "bad.stl")"))
                .text()
                .find("unknown format (got \".stl\", allowed .ply, .obj, .gltf, .glb)"),
            std::string::npos);
}

TEST_F(MeshFileTest, ReadsGltf) {
  const Asset asset;
  const std::vector<std::array<std::uint32_t, 3>> one{{0, 1, 2}};
  EXPECT_EQ(mesh("a.gltf", asset.text()).triangles, one);
  EXPECT_EQ(mesh("a.gltf", asset.text()).vertices[1], Imath::V3d(1, 0, 0));

  Asset outside = asset;
  write(folder_ / "two words.bin", triangle_bytes());
  outside.buffer = R"({"byteLength": 44, "uri": "two%20words.bin"})";
  const MeshFile file = read("a.gltf", outside.text());
  EXPECT_EQ(file.parts.at(0).mesh.triangles, one);
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

TEST_F(MeshFileTest, NodesPlaceMeshes) {
  Asset asset;
  asset.roots = "[0, 3]";
  // Scale, turn z to x by a quarter about y, move; the child doubles it all; the last is a mirror.
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

TEST_F(MeshFileTest, GltfBringsItsMaterials) {
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
  const LinearRgb color =
      linear_rgb(std::get<DiffuseMaterial>(paint->materials[paint->shapes[0].material].model).reflectance);
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

TEST_F(MeshFileTest, RefusesBadGltf) {
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
  beyond_end[beyond_end.size() - 52] = 52;  // the length of its last chunk
  const std::string deep(300, '[');
  std::string chunky = whole;
  chunky[14] = '\x7F';
  expect_refused(
      "bad.gltf",
      {{"no JSON", "solid", in, "malformed JSON"},
       {"an old version", R"({"asset": {"version": "1.0"}})", in, "no glTF 2.0 asset"},
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
       {"no positions", with(&Asset::primitive, R"("attributes": {})"), in, "accessor -1: there is none"},
       {"a long accessor",
        accessor(R"({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"})"), in,
        "accessor 0: it promises more than the buffer holds"},
       {"a huge accessor",
        accessor(R"({"bufferView": 0, "componentType": 5126, "count": 4611686018427387905, "type": "VEC3"})"),
        in, "promises more"},
       {"a negative count",
        accessor(R"({"bufferView": 0, "componentType": 5126, "count": -1, "type": "VEC3"})"), in,
        "'count' property is not a positive integer"},
       {"a far offset",
        accessor(
            R"({"bufferView": 0, "byteOffset": 9007199254740000, "componentType": 5126, "count": 3, "type": "VEC3"})"),
        in, "promises more"},
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
        in, "sparse accessors are not read"},
       {"a narrow stride",
        with(
            &Asset::views,
            R"([{"buffer": 0, "byteLength": 36, "byteStride": 4}, {"buffer": 0, "byteOffset": 36, "byteLength": 8}])"),
        in, "promises more"},
       {"a long view",
        with(&Asset::views,
             R"([{"buffer": 0, "byteLength": 45}, {"buffer": 0, "byteOffset": 36, "byteLength": 8}])"),
        in, "its view leaves the buffer"},
       {"a far view",
        with(
            &Asset::views,
            R"([{"buffer": 0, "byteOffset": 9007199254740992, "byteLength": 36}, {"buffer": 0, "byteLength": 8}])"),
        in, "its view leaves the buffer"},
       {"no such buffer",
        with(&Asset::views, R"([{"buffer": 1, "byteLength": 36}, {"buffer": 0, "byteLength": 8}])"), in,
        "its view leaves the buffer"},
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
        "beside it only"},
       {"climbing in code", with(&Asset::buffer, R"({"byteLength": 44, "uri": "%2e%2E/secret"})"), in,
        "beside it only (got \"../secret\")"},
       {"absolute", with(&Asset::buffer, R"({"byteLength": 44, "uri": "/etc/passwd"})"), in,
        "beside it only"},
       {"a URL", with(&Asset::buffer, R"({"byteLength": 44, "uri": "https://example.org/a"})"), in,
        "beside it only"},
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

// Any prefix of a file, and any byte of it changed, is read or refused: never more.
TEST_F(MeshFileTest, SurvivesDamage) {
  Asset within;
  within.buffer = R"({"byteLength": 44})";
  const std::string sound = glb(within.text(), triangle_bytes());
  int refused = 0;
  const auto attempt = [&](const std::string& bytes) {
    write(folder_ / "damaged.glb", bytes);
    Diagnostics diagnostics;
    const auto file = load_mesh_file(folder_ / "damaged.glb", FileMaterials::wanted, {}, diagnostics);
    EXPECT_NE(file.has_value(), diagnostics.has_errors());
    EXPECT_TRUE(file || diagnostics.code() == ErrorCode::input);
    refused += !file;
  };
  for (std::size_t i = 0; i < sound.size(); i += 3) attempt(sound.substr(0, i));
  for (std::size_t i = 0; i < sound.size(); ++i) {
    std::string changed = sound;
    changed[i] = static_cast<char>(changed[i] ^ (i % 2 == 0 ? 0x7F : 0x11));
    attempt(changed);
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace abbe
