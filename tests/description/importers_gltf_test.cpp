// What glTF files of other programs hold and small examples do not.
#include <string>
#include <vector>

#include "gltf_asset.h"
#include "importers.h"
#include "mesh_files.h"
#include "scene/shapes/mesh.h"

namespace abbe {
namespace {

using test::Asset;

const std::string kPrimitive = R"("attributes": {"POSITION": 0}, "indices": 1)";

class GltfDoorTest : public test::ImportersTest {
 protected:
  // Two triangles of the materials 0 and 1, or as said, with a camera.
  static Asset two(
      const std::string& materials,
      const std::string& second = R"("attributes": {"POSITION": 0}, "indices": 1, "material": 1)") {
    Asset asset;
    asset.nodes = R"([{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5]}])";
    asset.roots = "[0, 1]";
    asset.primitive = kPrimitive + R"(, "material": 0}, {)" + second;
    asset.more = R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 1}}],
        "materials": [)" +
                 materials + "]";
    return asset;
  }
  // A triangle with coordinates and a normal map, whose texture info says more.
  static std::string imaged(const std::string& uri, const std::string& info) {
    Asset asset;
    asset.primitive = R"("attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0)";
    asset.accessors.back() = ',';
    asset.accessors += R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"}])";
    asset.more = R"(, "materials": [{"normalTexture": {"index": 0)" + info +
                 R"(}}], "textures": [{"source": 0}], "images": [{"uri": ")" + uri + "\"}]";
    return asset.text();
  }
  static const std::string& part(const spec::Scene& scene, std::size_t i) {
    return std::get<spec::MeshPart>(std::get<spec::MeshBody>(scene.shapes.at(i).kind).surface.value)
        .of_material.value;
  }
};

TEST_F(GltfDoorTest, MaterialsOfOneNameStayTwo) {
  const std::string paint = R"({"name": "paint", "pbrMetallicRoughness": {"metallicFactor": 0}})";
  const std::string lamp = R"({"name": "paint", "emissiveFactor": [1, 1, 1]})";
  const auto made = convert("a.gltf", two(paint + ", " + lamp).text());
  ASSERT_TRUE(made) << told_;
  ASSERT_EQ(made->shapes.size(), 2U);
  EXPECT_EQ(part(*made, 0), "paint");
  EXPECT_EQ(part(*made, 1), "paint 2");
  EXPECT_EQ(std::get<spec::Principled>(made->materials.at(0).value.model).metallic, 0);
  EXPECT_EQ(made->materials.at(1).name, "paint 2");
  EXPECT_FALSE(std::get<spec::MeshBody>(made->shapes[0].kind).emission);
  EXPECT_TRUE(std::get<spec::MeshBody>(made->shapes[1].kind).emission);
}

TEST_F(GltfDoorTest, NamesGivenForWantOfOneClashWithNone) {
  const auto numbered = convert("a.gltf", two(R"({}, {"name": "material 0"})").text());
  ASSERT_TRUE(numbered) << told_;
  EXPECT_EQ(part(*numbered, 0), "material 0");
  EXPECT_EQ(part(*numbered, 1), "material 0 2");
  const auto bare = convert("a.gltf", two(R"({"name": "default"})", kPrimitive).text());
  ASSERT_TRUE(bare) << told_;
  EXPECT_EQ(part(*bare, 0), "default 2");
  EXPECT_EQ(part(*bare, 1), "default");
}

TEST_F(GltfDoorTest, LinesAreDroppedAlone) {
  const std::string lines = kPrimitive + R"(, "mode": 1, "material": 1)";
  const auto made = convert("a.gltf", two(R"({"name": "brass"}, {"name": "wire"})", lines).text());
  ASSERT_TRUE(made) << told_;
  ASSERT_EQ(made->shapes.size(), 1U);
  EXPECT_EQ(part(*made, 0), "brass");
  EXPECT_TRUE(tells("points and lines have no surface: dropped")) << told_;
  Asset nothing = two(R"({"name": "brass"})", lines);
  nothing.primitive = kPrimitive + R"(, "mode": 0, "material": 0)";
  const auto empty = convert("a.gltf", nothing.text());
  ASSERT_TRUE(empty) << told_;
  EXPECT_TRUE(empty->shapes.empty());
}

TEST_F(GltfDoorTest, WhatIsDroppedIsTold) {
  Asset asset = two(R"({"name": "m"}, {"name": "n"})");
  asset.nodes =
      R"([{"mesh": 0, "skin": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {}}}}, {"camera": 0, "translation": [0, 0, 5]}])";
  asset.primitive =
      R"("attributes": {"POSITION": 0, "COLOR_0": 0}, "indices": 1, "material": 0, "targets": [{"POSITION": 0}],
      "extensions": {"KHR_materials_variants": {"mappings": []}})";
  asset.more += R"(, "skins": [{"joints": [0]}], "animations": [{"channels": [], "samplers": []}])";
  ASSERT_TRUE(convert("a.gltf", asset.text())) << told_;
  for (const char* what : {"EXT_mesh_gpu_instancing of a node is not supported: dropped",
                           "skins are not supported: the mesh is used as stored",
                           "morph targets are not supported: the mesh is used as stored",
                           "vertex colours are not supported: dropped",
                           "KHR_materials_variants of a primitive is not supported: dropped",
                           "animations are not supported: dropped"})
    EXPECT_TRUE(tells(what)) << told_ << "lacks " << what;
  EXPECT_TRUE(convert("a.gltf", two(R"({"name": "m"}, {"name": "n"})").text()));
  EXPECT_FALSE(tells("not supported")) << told_;
}

TEST_F(GltfDoorTest, TexturesOfExtensionsAreToldToBeDropped) {
  const std::string coat =
      R"({"name": "m", "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.25, "clearcoatTexture": {"index": 0}}}})";
  ASSERT_TRUE(convert("a.gltf", two(coat + R"(, {"name": "n"})").text())) << told_;
  EXPECT_TRUE(tells("clearcoatTexture is not supported: dropped")) << told_;
}

TEST_F(GltfDoorTest, ImagesAreNamedByUris) {
  const auto file = [&](const std::string& uri) {
    const auto made = convert("a.gltf", imaged(uri, ""));
    EXPECT_TRUE(made) << told_;
    return made ? std::get<spec::NormalMap>(made->materials.at(0).value.relief).file.image.value : "";
  };
  for (const char* name : {"my photo.exr", "50%.exr", "ü+1.exr"}) put_image(name, false);
  EXPECT_EQ(file("my%20photo.exr"), "my photo.exr");
  EXPECT_EQ(file("my photo.exr"), "my photo.exr");
  EXPECT_EQ(file("%6dy photo%2Eexr"), "my photo.exr");
  EXPECT_EQ(file("50%25.exr"), "50%.exr");
  EXPECT_EQ(file("50%.exr"), "50%.exr");
  EXPECT_EQ(file("%C3%BC+1.exr"), "ü+1.exr");
}

TEST_F(GltfDoorTest, CoordinatesOfAnImageAreThoseOfItsTransform) {
  put_image("photo.exr", false);
  const auto told_of = [&](const std::string& info) {
    EXPECT_TRUE(convert("a.gltf", imaged("photo.exr", ", " + info))) << told_;
    return tells("only the first set of texture coordinates is supported");
  };
  const auto transform = [](const std::string& set) {
    return R"("extensions": {"KHR_texture_transform": {"scale": [1, 1])" + set + "}}";
  };
  EXPECT_TRUE(told_of(R"("texCoord": 1)"));
  EXPECT_TRUE(told_of(transform(R"(, "texCoord": 1)")));
  EXPECT_TRUE(told_of(R"("texCoord": 1, )" + transform("")));
  EXPECT_FALSE(told_of(R"("texCoord": 1, )" + transform(R"(, "texCoord": 0)"))) << told_;
  EXPECT_FALSE(told_of(transform(""))) << told_;
}

TEST_F(GltfDoorTest, PerspectiveCamerasComeFirst) {
  const auto distance = [&](const std::string& cameras, int more) {
    Asset asset = two(R"({"name": "m"}, {"name": "n"})");
    asset.nodes =
        R"([{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5]}, {"camera": 1, "translation": [0, 0, 7]},
        {"camera": 2, "translation": [0, 0, 9]}])";
    asset.roots = more == 2 ? "[0, 1, 2, 3]" : "[0, 1]";
    asset.more = R"(, "materials": [{"name": "m"}, {"name": "n"}], "cameras": [)" + cameras + "]";
    const auto made = convert("a.gltf", asset.text());
    EXPECT_TRUE(made) << told_;
    return made ? std::get<spec::PinholeCamera>(made->camera->kind).view.from.z : 0;
  };
  const std::string flat =
      R"({"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 1, "zfar": 9}})";
  const std::string deep = R"({"type": "perspective", "perspective": {"yfov": 0.5, "znear": 1}})";
  EXPECT_EQ(distance(flat + "," + deep + "," + deep, 2), 7);
  EXPECT_TRUE(tells("a scene has one camera: the first perspective camera, if any, is used (2 times)"))
      << told_;
  EXPECT_FALSE(tells("not supported")) << told_;
  EXPECT_EQ(distance(deep + "," + flat + "," + deep, 2), 5);
  EXPECT_EQ(distance(flat, 0), 5);
  EXPECT_TRUE(tells("orthographic cameras are not supported")) << told_;
  EXPECT_FALSE(tells("one camera")) << told_;
}

// The format leaves the scale of a camera's node out.
TEST_F(GltfDoorTest, CamerasHaveNoScale) {
  const auto camera_of = [&](const std::string& scale) {
    Asset asset = two(R"({"name": "m"}, {"name": "n"})");
    asset.nodes = R"([{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5], "scale": )" + scale + "}]";
    return written("a.gltf", asset.text());
  };
  const auto plain = camera_of("[1, 1, 1]");
  ASSERT_TRUE(plain) << told_;
  EXPECT_EQ(camera_of("[1, 2, 4]"), plain);
  EXPECT_FALSE(tells("non-uniform scale")) << told_;
}

TEST_F(GltfDoorTest, BinaryFilesAreOfVersion2) {
  std::string old = test::whole_glb();
  old[4] = 1;
  EXPECT_FALSE(convert("a.glb", old));
  EXPECT_TRUE(tells("not of version 2")) << told_;
}

TEST_F(GltfDoorTest, RotationsHaveADirection) {
  Asset asset = two(R"({"name": "m"}, {"name": "n"})");
  asset.nodes = R"([{"mesh": 0, "rotation": [0, 0, 0, 0]}, {"camera": 0, "translation": [0, 0, 5]}])";
  EXPECT_FALSE(convert("a.gltf", asset.text()));
  EXPECT_TRUE(tells("/nodes/0/rotation: error: a rotation quaternion must not be 0")) << told_;
}

using GltfMeshTest = test::MeshFileTest;

TEST_F(GltfMeshTest, RotationsHaveADirection) {
  Asset asset;
  asset.nodes = R"([{"mesh": 0, "rotation": [0, 0, 0, 0]}])";
  expect_refused("a.gltf",
                 {{"no rotation", asset.text(), ErrorCode::input, "node 0: a rotation of length 0"}});
}

}  // namespace
}  // namespace abbe
