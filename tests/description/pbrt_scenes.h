#pragma once

#include <string>
#include <vector>

#include "importers.h"

namespace abbe::test {

// A camera that needs no mirror, and the beginning of a world.
inline const std::string kBegin =
    "Scale -1 1 1\nLookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n";

/// Converts pbrt worlds.
class PbrtTest : public ImportersTest {
 protected:
  spec::Scene scene(const std::string& world) {
    auto made = convert("a.pbrt", kBegin + world);
    EXPECT_TRUE(made) << told_;
    return made.value_or(spec::Scene{});
  }
  template <typename Body>
  Body shape(const std::string& world, std::size_t i = 0) {
    const spec::Scene made = scene(world);
    EXPECT_LT(i, made.shapes.size()) << told_;
    return i < made.shapes.size() ? std::get<Body>(made.shapes[i].kind) : Body{};
  }
  template <typename Model>
  Model material(const std::string& directives) {
    const spec::Scene made = scene(directives + "\nShape \"sphere\"\n");
    EXPECT_FALSE(made.materials.empty()) << told_;
    return made.materials.empty() ? Model{} : std::get<Model>(made.materials[0].value.model);
  }
  void expect_refused(const std::vector<DoorFault>& faults) {
    for (const DoorFault& fault : faults) {
      SCOPED_TRACE(fault.what);
      EXPECT_FALSE(convert("a.pbrt", fault.text));
      EXPECT_TRUE(tells(fault.message)) << told_ << "lacks " << fault.message;
    }
  }
};

using SphereBody = spec::PlainBody<spec::Sphere>;
using QuadBody = spec::PlainBody<spec::Quad>;
using DiscBody = spec::PlainBody<spec::Disc>;

}  // namespace abbe::test
