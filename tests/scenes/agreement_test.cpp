#include <cmath>
#include <ostream>

#include <fmt/format.h>

#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

// Path tracing and light tracing estimate the same film in different ways: where both reach a path, each
// checks the other. The lamps are so large that path tracing finds them by chance behind glass and mirrors,
// and their photons are traced all the same.

namespace abbe {
namespace {

// Family significance 1e-6 over 3 channels x 16 regions x 10 scenes: z = 6 by Sidak's correction.
constexpr double kLargestZOfTenScenes = 6;

struct Agreement {
  const char* name;
  const char* text;
  const char* integrator;  ///< Held against path tracing; "light" where no lamp, mirror or glass is seen.
  int path_samples;
  int light_samples;
  double margin;   ///< Of the means, relative.
  int by_day = 1;  ///< So many times fewer samples.
};

void PrintTo(const Agreement& scene, std::ostream* out) {
  *out << scene.name;
}

// Out of focus; lamps of every kind, each of another spectrum, one seen from both sides.
constexpr const char* kLamps = R"({
  "abbe": 1,
  "camera": {"thin_lens": {"focal_length": 0.05, "f_number": 0.5, "focus_distance": 1.2}, "from": [0, -3, 1.2], "to": [0, 0, 0.3], "up": [0, 0, 1]},
  "sensor": {"resolution": [32, 32], "pixel_pitch_um": 700, "observer": "1931"},
  "materials": {"red": {"diffuse": {"reflectance": "cornell_box_walls:red"}}, "white": {"diffuse": {"reflectance": 0.7}}},
  "lights": [
    {"disc": {"center": [-1.5, 0, 2.5], "normal": [1, 0, 0.2], "radius": 0.4}, "two_sided": true, "emission": {"illuminant": "FL11", "luminance": 300}},
    {"quad": {"corner": [1, 1, 3], "edge_u": [0, 0.6, 0], "edge_v": [0.6, 0.1, 0]}, "emission": {"illuminant": "A", "luminance": 400}},
    {"sphere": {"center": [1.8, -1.5, 1.5], "radius": 0.2}, "emission": {"daylight_K": 6504, "luminance": 500}},
    {"point": {"at": [0.6, -0.8, 1.1]}, "emission": {"lines": [{"nm": 546.1, "width_nm": 0.1, "power": 1}], "luminous_intensity": 60}},
    {"spot": {"at": [-0.4, -0.6, 2], "direction": [0.3, 0.3, -1], "half_angle_deg": 12}, "emission": {"blackbody_K": 9000, "luminous_intensity": 400}}
  ],
  "shapes": [
    {"mesh": {"vertices": [[-2.5, 1, 0.2], [-1.5, 1, 0.2], [-1.8, 1, 1.4], [-2.6, 1, 1.2]], "triangles": [[0, 1, 2], [2, 3, 0]]}, "material": "white", "emission": {"spectrum": {"band": [440, 480]}, "luminance": 100}},
    {"quad": {"corner": [-3, -3, 0], "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}, "material": "white"},
    {"sphere": {"center": [-0.3, 0, 0.4], "radius": 0.4}, "material": "red"},
    {"disc": {"center": [0.6, 0.2, 0.5], "normal": [0, -1, 0.3], "radius": 0.3}, "material": "white"}
  ],
  "render": {"max_depth": 8}
})";

// A ball of coloured, dispersive, absorbing glass.
constexpr const char* kColouredBall = R"({
  "abbe": 1,
  "camera": {"pinhole": {"fov_deg": 30}, "from": [4, 3, -5], "to": [0.3, 0.5, 0], "up": [0, 1, 0]},
  "sensor": {"resolution": [32, 32], "channels": {"B": {"band": [400, 500]}, "G": {"band": [500, 600]}, "R": {"band": [600, 700]}}},
  "materials": {"glass": {"dielectric": {"ior": 1.5, "absorption_per_m": {"table": {"wavelength_nm": [400, 550, 700], "values": [1, 0.1, 0.5], "outside": "clamp"}}}}, "grey": {"diffuse": {"reflectance": 0.5}}},
  "lights": [{"sphere": {"center": [-2.5, 4, -1.5], "radius": 1.2}, "emission": {"blackbody_K": 4000, "radiance": 1}}],
  "shapes": [
    {"quad": {"corner": [-20, 0, -20], "edge_u": [0, 0, 40], "edge_v": [40, 0, 0]}, "material": "grey"},
    {"sphere": {"center": [0, 1.001, 0], "radius": 1}, "material": "glass"}
  ],
  "render": {"max_depth": 12}
})";

// Light from inside a ball of absorbing glass.
constexpr const char* kLampInGlass = R"({
  "abbe": 1,
  "camera": {"pinhole": {"fov_deg": 30}, "from": [4, 3, -5], "to": [0.3, 0.5, 0], "up": [0, 1, 0]},
  "sensor": {"resolution": [32, 32], "channels": {"B": {"band": [400, 500]}, "R": {"band": [600, 700]}}},
  "materials": {"glass": {"dielectric": {"ior": 1.5, "absorption_per_m": {"table": {"wavelength_nm": [400, 700], "values": [1, 0.2], "outside": "clamp"}}}}, "grey": {"diffuse": {"reflectance": 0.5}}},
  "lights": [{"sphere": {"center": [0.1, 1.1, 0], "radius": 0.4}, "emission": {"spectrum": 1}, "material": "grey"}],
  "shapes": [
    {"quad": {"corner": [-20, 0, -20], "edge_u": [0, 0, 40], "edge_v": [40, 0, 0]}, "material": "grey"},
    {"sphere": {"center": [0, 1.001, 0], "radius": 1}, "material": "glass"}
  ],
  "render": {"max_depth": 12}
})";

// A gold mirror throws the light of a lamp onto a wall, a lens of glass focuses it.
constexpr const char* kMirror = R"({
  "abbe": 1,
  "camera": {"thin_lens": {"focal_length": 0.05, "f_number": 1}, "from": [0, -4, 1], "to": [0, 0, 0.5], "up": [0, 0, 1]},
  "sensor": {"resolution": [32, 32], "pixel_pitch_um": 700, "observer": "1931"},
  "materials": {"gold": {"conductor": {"ior": "Au_Johnson"}}, "white": {"diffuse": {"reflectance": 0.7}}, "flint": {"dielectric": {"ior": "F2"}}},
  "lights": [
    {"quad": {"corner": [1.5, -1, 1], "edge_u": [0, 1, 0], "edge_v": [-0.3, 0, 1]}, "emission": {"illuminant": "D65", "luminance": 100}},
    {"disc": {"center": [0, 0, 3], "normal": [0, 0, -1], "radius": 0.7}, "emission": {"illuminant": "FL11", "luminance": 100}}
  ],
  "shapes": [
    {"quad": {"corner": [-3, -3, 0], "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}, "material": "white"},
    {"quad": {"corner": [-3, 1.5, 0], "edge_u": [6, 0, 0], "edge_v": [0, 0, 4]}, "material": "white"},
    {"quad": {"corner": [-1, -1, 0.01], "edge_u": [0.3, 0, 1.5], "edge_v": [0, 2, 0]}, "material": "gold"},
    {"sphere": {"center": [0.3, -0.2, 0.6], "radius": 0.3}, "material": "flint"}
  ],
  "render": {"max_depth": 10}
})";

// Ground glass that colours light within, and ground metal, brushed one way.
constexpr const char* kGround = R"({
  "abbe": 1,
  "camera": {"pinhole": {"fov_deg": 30}, "from": [4, 3, -5], "to": [0.3, 0.5, 0], "up": [0, 1, 0]},
  "sensor": {"resolution": [32, 32], "channels": {"B": {"band": [400, 500]}, "G": {"band": [500, 600]}, "R": {"band": [600, 700]}}},
  "materials": {
    "glass": {"dielectric": {"ior": 1.5, "absorption_per_m": {"table": {"wavelength_nm": [400, 550, 700], "values": [1, 0.1, 0.5], "outside": "clamp"}}, "roughness": 0.3}},
    "flint": {"dielectric": {"ior": "F2", "roughness": {"alpha": 0.15, "distribution": "beckmann"}}},
    "copper": {"conductor": {"ior": "Cu_Johnson", "roughness": [0.4, 0.1]}},
    "grey": {"diffuse": {"reflectance": 0.5}}
  },
  "lights": [{"sphere": {"center": [-2.5, 4, -1.5], "radius": 1.2}, "emission": {"blackbody_K": 4000, "radiance": 1}}],
  "shapes": [
    {"quad": {"corner": [-20, 0, -20], "edge_u": [0, 0, 40], "edge_v": [40, 0, 0]}, "material": "grey"},
    {"sphere": {"center": [0, 0.801, 0], "radius": 0.8}, "material": "glass"},
    {"sphere": {"center": [1.4, 0.501, -0.8], "radius": 0.5}, "material": "flint"},
    {"sphere": {"center": [0.2, 0.401, -1.5], "radius": 0.4}, "material": "copper"}
  ],
  "render": {"max_depth": 12}
})";

// The spectrum of a wide beam.
constexpr const char* kPrism = R"({
  "abbe": 1, "units": "mm",
  "camera": {"pinhole": {"fov_deg": 30}, "from": [10, 0, -12], "to": [16, 0, -11], "up": [0, 1, 0]},
  "sensor": {"resolution": [32, 32], "observer": "1931"},
  "materials": {"glass": {"dielectric": {"ior": "N-SF11"}}, "white": {"diffuse": {"reflectance": 0.8}}},
  "lights": [{"quad": {"corner": [-8.7458892, -2, -6.0408141], "edge_u": [1.64, 0, -2.51], "edge_v": [0, 4, 0]}, "emission": {"illuminant": "E", "luminance": 100}}],
  "shapes": [
    {"prism": {"apex_deg": 60, "side": 8, "length": 8}, "material": "glass"},
    {"quad": {"corner": [13.363612, -5, -17.061843], "edge_u": [8.754304, 0, 13.392608], "edge_v": [0, 10, 0]}, "material": "white"}
  ],
  "render": {"max_depth": 10}
})";

// Matter that mirrors and scatters at once, beside a pane that throws the light of a lamp on it.
constexpr const char* kGlazed = R"({
  "abbe": 1,
  "camera": {"thin_lens": {"focal_length": 0.05, "f_number": 1}, "from": [0, -4, 1.5], "to": [0, 0, 0.5], "up": [0, 0, 1]},
  "sensor": {"resolution": [32, 32], "pixel_pitch_um": 700, "observer": "1931"},
  "materials": {
    "white": {"diffuse": {"reflectance": 0.6}}, "silver": {"mirror": {"reflectance": 0.9}},
    "glaze": {"coated_diffuse": {"ior": "F2", "reflectance": "cornell_box_walls:red"}},
    "spotted": {"mixture": [{"material": "silver", "weight": {"band": [500, 700], "value": 0.6}}, {"material": "glaze", "weight": 0.3}, {"material": "lobe", "weight": 0.1}]},
    "lobe": {"cosine_power": {"reflectance": 0.9, "exponent": 2}},
    "lacquer": {"principled": {"base_color": "cornell_box_walls:green", "roughness": 0.6, "clearcoat": 1, "clearcoat_gloss": 0}},
    "clay": {"oren_nayar": {"reflectance": 0.7, "sigma_deg": 40}}, "shine": {"phong": {"reflectance": 0.4, "exponent": 8}},
    "pane": {"thin_glass": {"ior": 1.8, "thickness": 0.01, "absorption_per_m": {"table": {"wavelength_nm": [400, 700], "values": [80, 5], "outside": "clamp"}}}}
  },
  "lights": [
    {"quad": {"corner": [1.6, -1, 1], "edge_u": [0, 1, 0], "edge_v": [-0.3, 0, 1]}, "emission": {"illuminant": "D65", "luminance": 100}},
    {"disc": {"center": [0, 0, 3], "normal": [0, 0, -1], "radius": 0.7}, "emission": {"illuminant": "FL11", "luminance": 100}}
  ],
  "shapes": [
    {"quad": {"corner": [-3, -3, 0], "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}, "material": "clay"},
    {"quad": {"corner": [-3, 1.5, 0], "edge_u": [6, 0, 0], "edge_v": [0, 0, 4]}, "material": "white"},
    {"quad": {"corner": [-1, -1, 0.01], "edge_u": [0.3, 0, 1.5], "edge_v": [0, 2, 0]}, "material": "spotted"},
    {"quad": {"corner": [0.9, -1, 0.2], "edge_u": [0, 1.5, 0], "edge_v": [0.3, 0, 1.2]}, "material": "pane"},
    {"sphere": {"center": [0.2, -0.4, 0.4], "radius": 0.4}, "material": "glaze"},
    {"sphere": {"center": [0.3, 0.7, 0.5], "radius": 0.5}, "material": "lacquer"},
    {"sphere": {"center": [0.7, -1.2, 0.25], "radius": 0.25}, "material": "shine"}
  ],
  "render": {"max_depth": 8}
})";
// In fog, which the camera and all lamps stand in, about a ball of turbid glass and a block of thicker fog.
std::string fog(const std::string& lamp, const std::string& ball) {
  std::string text = R"({
  "abbe": 1,
  "camera": {"thin_lens": {"focal_length": 0.05, "f_number": 1, "focus_distance": 3}, "from": [0, -3, 1], "to": [0, 0, 0.6], "up": [0, 0, 1]},
  "sensor": {"resolution": [32, 32], "pixel_pitch_um": 700, "channels": {"B": {"band": [400, 500]}, "G": {"band": [500, 600]}, "R": {"band": [600, 700]}}},
  "materials": {
    "fog": {"medium": {"scattering_per_m": {"table": {"wavelength_nm": [400, 700], "values": [0.4, 0.1], "outside": "clamp"}}, "absorption_per_m": 0.05, "phase": {"henyey_greenstein": 0.6}}},
    "thick": {"medium": {"scattering_per_m": {"table": {"wavelength_nm": [400, 700], "values": [1, 6], "outside": "clamp"}}, "phase": "rayleigh"}},
    "opal": {"dielectric": {"ior": 1.5, "absorption_per_m": 0.2, "scattering_per_m": 2}},
    "white": {"diffuse": {"reflectance": 0.7}}
  },
  "lights": [
    {"quad": {"corner": [-1, 0.5, 2.5], "edge_u": [0, 1, 0], "edge_v": [1, 0, 0]}, "emission": {"illuminant": "D65", "luminance": 100}}LAMP
  ],
  "shapes": [
    {"quad": {"corner": [-3, -3, 0], "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}, "material": "white"},
    {"sphere": {"center": [0, 0, 0], "radius": 9}, "material": "fog"},
    {"sphere": {"center": [-0.6, 0, 0.5], "radius": 0.4}, "material": "thick"}PLUS
  ],
  "render": {"max_depth": 10}
})";
  const auto put = [&text](const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
  };
  put("LAMP", ", " + lamp);
  put("PLUS", ball);
  return text;
}
const std::string kFog = fog(
    R"({"point": {"at": [0.9, -0.6, 1.6]}, "emission": {"illuminant": "A", "luminous_intensity": 30}})", "");
const std::string kFogAroundGlass = fog(
    R"({"sphere": {"center": [1.5, -0.6, 2], "radius": 0.5}, "emission": {"illuminant": "A", "luminance": 300}})",
    R"(, {"sphere": {"center": [0.6, 0, 0.5], "radius": 0.4}, "material": "opal"})");

// More lamps than are weighed one by one, of several kinds and strengths, turned to all sides above a floor,
// and one at infinity.
std::string many_lamps() {
  std::string text = R"({
  "abbe": 1,
  "camera": {"pinhole": {"fov_deg": 40}, "from": [0, -6, 3], "to": [0, 0, 0.5], "up": [0, 0, 1]},
  "sensor": {"resolution": [32, 32], "observer": "1931"},
  "materials": {"white": {"diffuse": {"reflectance": 0.6}}, "copper": {"conductor": {"ior": "Cu_Johnson", "roughness": 0.3}}},
  "shapes": [
    {"quad": {"corner": [-3, -3, 0], "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}, "material": "white"},
    {"sphere": {"center": [0.2, 0.3, 0.6], "radius": 0.6}, "material": "copper"}
  ],
  "render": {"max_depth": 6},
  "lights": [{"directional": {"towards": [0.3, -0.5, 1]}, "emission": {"illuminant": "D65", "illuminance": 50}})";
  for (int i = 0; i < 48; ++i) {
    const double x = -2.6 + 0.75 * (i % 8);
    const double y = -2.5 + 0.95 * (i / 8);
    const double z = 3.1 + 0.2 * (i % 5);
    const double strength = 1 + i % 7;
    const double turn = 0.7 * i;
    if (i % 3 == 0)
      text += fmt::format(
          R"(, {{"point": {{"at": [{}, {}, {}]}}, "emission": {{"illuminant": "A", "luminous_intensity": {}}}}})",
          x, y, z, strength);
    else if (i % 3 == 1)
      text += fmt::format(
          R"(, {{"spot": {{"at": [{}, {}, {}], "direction": [{}, {}, -1], "half_angle_deg": 40}}, "emission": {{"illuminant": "FL11", "luminous_intensity": {}}}}})",
          x, y, z, std::cos(turn), std::sin(turn), 5 * strength);
    else
      text += fmt::format(
          R"(, {{"disc": {{"center": [{}, {}, {}], "normal": [{}, {}, -0.6], "radius": 0.15}}, "emission": {{"illuminant": "D65", "luminance": {}}}}})",
          x, y, z, std::cos(turn), std::sin(turn), 100 * strength);
  }
  return text + "]}";
}
const std::string kManyLamps = many_lamps();

RenderResult render_by(const Agreement& item, const char* integrator, int samples) {
  Scene scene = test::load_text(
      item.text, {{"/render/integrator", integrator}, {"/render/samples", std::to_string(samples)}});
  scene.features.light_tracing = true;
  scene.features.light_is_traced.assign(scene.lights.size(), true);
  return render(scene, {});
}

class Agreements : public testing::TestWithParam<Agreement> {};

TEST_P(Agreements, OfTechniques) {
  const Agreement& item = GetParam();
  const int fewer = test::nightly() ? 1 : item.by_day;
  const RenderResult path = render_by(item, "path", item.path_samples / fewer);
  const RenderResult light = render_by(item, item.integrator, item.light_samples / fewer);
  EXPECT_EQ(path.stats.nonfinite_samples + light.stats.nonfinite_samples, 0U);
  const test::Comparison c = test::compare_regions(path.film, light.film, 4);
  std::printf("largest z %.2f, ratio of the means %.5f\n", c.largest_z, c.ratio);
  EXPECT_LT(c.largest_z, kLargestZOfTenScenes);
  EXPECT_NEAR(c.ratio, 1, test::ratio_margin(path.film, light.film, item.margin, 0.05));
}

std::string name_of(const testing::TestParamInfo<Agreement>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Agreements,
                         testing::Values(Agreement{"Lamps", kLamps, "light", 1024, 4096, 0.02, 2},
                                         Agreement{"ColouredBall", kColouredBall, "auto", 2048, 512, 0.01, 8},
                                         Agreement{"Glazed", kGlazed, "auto", 2048, 512, 0.01, 16}),
                         name_of);
INSTANTIATE_TEST_SUITE_P(
    Nightly, Agreements,
    testing::Values(Agreement{"LampInGlass", kLampInGlass, "auto", 1024, 256, 0.01},
                    Agreement{"Mirror", kMirror, "auto", 1024, 256, 0.01},
                    Agreement{"Ground", kGround, "light", 1024, 4096, 0.01},
                    Agreement{"Prism", kPrism, "auto", 4096, 1024, 0.02},
                    Agreement{"ManyLamps", kManyLamps.c_str(), "light", 1024, 4096, 0.02},
                    Agreement{"Fog", kFog.c_str(), "light", 512, 65536, 0.02},
                    Agreement{"FogAroundGlass", kFogAroundGlass.c_str(), "auto", 2048, 512, 0.02}),
    name_of);

}  // namespace
}  // namespace abbe
