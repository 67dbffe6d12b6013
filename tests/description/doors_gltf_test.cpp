// What glTF files of other programs hold and small examples do not.
#include <string>
#include <vector>

#include "doors.h"
#include "gltf_asset.h"
#include "mesh_files.h"
#include "scene/shapes/mesh.h"

namespace abbe {
namespace {

using testing::Asset;

const std::string kPrimitive = R"("attributes": {"POSITION": 0}, "indices": 1)";

class GltfDoorTest : public testing::DoorsTest {
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
  static const std::string& part(const spec::Scene& scene, std::size_t i) {
    return std::get<spec::MeshPart>(std::get<spec::MeshBody>(scene.shapes.at(i).kind).surface.value)
        .of_material.value;
  }
};

using GltfMeshTest = testing::MeshFileTest;

}  // namespace
}  // namespace abbe
