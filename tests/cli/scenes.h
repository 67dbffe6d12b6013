#pragma once

#include <string>

#include "tests/cli/program.h"

namespace abbe::test {

/// Scene file with these shapes and materials.
inline std::string scene_text(const std::string& materials, const std::string& shapes,
                              const std::string& units = "mm") {
  return R"({"abbe": 1, "units": ")" + units + R"(",
  "camera": {"pinhole": {"fov_deg": 40}, "from": [0, -300, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
  "sensor": {"resolution": [24, 16], "observer": "1931"},
  "materials": {)" +
         materials + R"(},
  "lights": [{"environment": {}, "emission": {"illuminant": "D65", "radiance": 1}}],
  "shapes": [)" +
         shapes + R"(],
  "render": {"samples": 8}})";
}

/// A 60 degree prism of N-BK7, its apex towards +z; the middle of its left face is at (-7.5, 0, 4.3301270)
/// mm.
inline std::string prism_scene() {
  return scene_text(
      R"("glass": {"dielectric": {"ior": "N-BK7"}})",
      R"({"name": "prism", "prism": {"apex_deg": 60, "side": 30, "length": 40}, "material": "glass"})");
}

/// A white ball in uniform light from all directions.
inline std::string ball_scene() {
  return scene_text(
      R"("white": {"diffuse": {"reflectance": 0.8}})",
      R"({"name": "ball", "sphere": {"center": [0, 0, 0], "radius": 50}, "material": "white"})");
}

/// Files that belong to this process: that scene, and any other by its name.
inline std::string ball() {
  return scratch().write("ball.json", ball_scene()).string();
}
inline std::string file(const std::string& name) {
  return (scratch() / name).string();
}

}  // namespace abbe::test
