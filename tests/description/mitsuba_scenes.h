#pragma once

#include <string>

#include "importers.h"

namespace abbe::test {

// A scene with a camera.
inline std::string whole(const std::string& elements) {
  return "<scene version=\"3.0.0\">\n"
         "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/></sensor>\n" +
         elements + "\n</scene>\n";
}

/// Converts Mitsuba scenes.
class MitsubaTest : public ImportersTest {
 protected:
  spec::Scene scene(const std::string& elements) {
    auto made = convert("a.xml", whole(elements));
    EXPECT_TRUE(made) << told_;
    return made.value_or(spec::Scene{});
  }
  template <typename Body>
  Body shape(const std::string& elements, std::size_t i = 0) {
    const spec::Scene made = scene(elements);
    EXPECT_LT(i, made.shapes.size()) << told_;
    return i < made.shapes.size() ? std::get<Body>(made.shapes[i].kind) : Body{};
  }
  template <typename Model>
  Model material(const std::string& bsdf) {
    const spec::Scene made = scene("<shape type=\"sphere\">" + bsdf + "</shape>");
    EXPECT_FALSE(made.materials.empty()) << told_;
    return made.materials.empty() ? Model{} : std::get<Model>(made.materials[0].value.model);
  }
};

using SphereBody = spec::PlainBody<spec::Sphere>;
using QuadBody = spec::PlainBody<spec::Quad>;

}  // namespace abbe::test
