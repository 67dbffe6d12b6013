// What films tell of the first surface that a pixel sees.
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/text.h"
#include "tests/scenes/scene_fixture.h"
#include "transport/render/part.h"

namespace abbe {
namespace {

using Imath::V3d;

const std::vector<Feature> kAll{Feature::depth,          Feature::position, Feature::normal,
                                Feature::shading_normal, Feature::albedo,   Feature::id};

// In a corner of the world, in centimetres. Its camera looks along +y, 400 cm from the middle of what it
// sees.
constexpr V3d kMiddle(30000, -20000, 5000);
std::string scene_of(const std::string& shapes, const std::string& materials,
                     const char* integrator = "path") {
  return fmt::format(R"({{"abbe": 1, "units": "cm",
    "camera": {{"pinhole": {{"fov_deg": 20}}, "from": [{}, {}, {}], "to": [{}, {}, {}], "up": [0, 0, 1]}},
    "sensor": {{"resolution": [20, 20], "response": "energy",
                "channels": {{"red": {{"band": [600, 700]}}, "blue": {{"band": [400, 500]}}}}}},
    "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
    "materials": {{{}}},
    "shapes": [{}],
    "render": {{"samples": 32, "integrator": "{}"}}}})",
                     kMiddle.x, kMiddle.y - 400, kMiddle.z, kMiddle.x, kMiddle.y, kMiddle.z, materials,
                     shapes, integrator);
}

std::string at(const V3d& offset) {
  const V3d p = kMiddle + offset;
  return fmt::format("[{}, {}, {}]", p.x, p.y, p.z);
}

// 0.2 at 400 nm, rising to 0.8 at 700 nm.
constexpr const char* kRamp = R"("ramp": {"diffuse": {"reflectance":
  {"table": {"wavelength_nm": [400, 700], "values": [0.2, 0.8], "outside": "clamp"}}}})";

std::string ball(const char* name, const char* material, const V3d& offset, double radius) {
  return fmt::format(R"({{"name": "{}", "sphere": {{"center": {}, "radius": {}}}, "material": "{}"}})", name,
                     at(offset), radius, material);
}

Image seen(const Scene& scene, const std::vector<Feature>& features = kAll, RenderOptions how = {}) {
  how.features = features;
  const RenderPart part{{{"sensor_channels", fmt::format("{}", fmt::join(scene.film_planes(), ","))},
                         {kFeaturesKey, to_text(features)}},
                        render(scene, how)};
  Image image{scene.camera.width, scene.camera.height, {}, {}};
  add_features(image, part);
  return image;
}

double value(const Image& image, const std::string& channel, std::size_t pixel) {
  return static_cast<double>(image.find(channel)->values[pixel]);
}
V3d vector(const Image& image, const std::string& layer, std::size_t pixel) {
  return {value(image, layer + ".X", pixel), value(image, layer + ".Y", pixel),
          value(image, layer + ".Z", pixel)};
}

// A plane through the middle that leans by 45 degrees. Means over a pixel lie on it, since it is plane.
TEST(Features, APlaneIsToldWhereItStands) {
  const Image image = seen(test::load_text(
      scene_of(fmt::format(R"({{"name": "wall", "quad": {{"corner": {}, "edge_u": [2000, 0, 0],
        "edge_v": [0, 2000, 2000]}}, "material": "ramp"}})",
                           at({-1000, -1000, -1000})),
               kRamp)));
  const V3d normal = V3d(0, -1, 1).normalized();
  for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel) {
    const V3d from_middle = vector(image, "P", pixel) - kMiddle;
    EXPECT_EQ(value(image, "Coverage", pixel), 1);
    EXPECT_NEAR(from_middle.dot(normal), 0, 0.004) << pixel;  // a float step of 30000 is 0.002
    EXPECT_NEAR(value(image, "depth.Z", pixel), 400 + from_middle.y, 0.004) << pixel;
    EXPECT_LT((vector(image, "N", pixel) - normal).length(), 1e-6);
    EXPECT_LT((vector(image, "Ns", pixel) - normal).length(), 1e-6);
    EXPECT_NEAR(value(image, "Albedo.red", pixel), 0.7, 0.002);
    EXPECT_NEAR(value(image, "Albedo.blue", pixel), 0.3, 0.002);
    EXPECT_EQ(value(image, "Id", pixel), 1);
    // Where the pixel's middle looks.
    const double half = 10 / std::tan(10 * std::acos(-1.0) / 180);
    const double x = (static_cast<double>(pixel % 20) + 0.5 - 10) / half;
    EXPECT_NEAR(from_middle.x / (400 + from_middle.y), x, 0.1 / half) << pixel;
  }
}

// Where `focus_distance` counts from, wherever rays leave the lens.
TEST(Features, DepthCountsFromTheFirstVertexOfALens) {
  const std::string wall = fmt::format(
      R"({{"quad": {{"corner": {}, "edge_u": [400, 0, 0], "edge_v": [0, 0, 400]}}, "material": "ramp"}})",
      at({-200, 0, -200}));
  const std::string camera = fmt::format(
      R"({{"lens_system": {{"prescription": "double_gauss", "focus_distance": 400}}, "from": {}, "to": {},
           "up": [0, 0, 1]}})",
      at({0, -400, 0}), at({0, 0, 0}));
  const Image image =
      seen(test::load_text(scene_of(wall, kRamp), {{"/camera", camera}, {"/sensor/pixel_pitch_um", "1000"}}),
           {Feature::depth});
  for (std::size_t pixel = 0; pixel < 400; ++pixel)
    EXPECT_NEAR(value(image, "depth.Z", pixel), 400, 0.004) << pixel;
}

// A disc that pixels see parts of, the rest being sky: lengths are those of the part, directions and albedo
// count the rest as 0.
TEST(Features, WhatIsHalfCoveredIsToldByItsCover) {
  const Scene scene =
      test::load_text(scene_of(fmt::format(R"({{"name": "card", "disc": {{"center": {}, "normal": [0, -1, 0],
        "radius": 37}}, "material": "grey"}})",
                                           at({0, 0, 0})),
                               R"("grey": {"diffuse": {"reflectance": 0.3}})"));
  const Image image = seen(scene);
  int parts = 0;
  double covered = 0;
  for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel) {
    const double cover = value(image, "Coverage", pixel);
    covered += cover;
    parts += cover > 0 && cover < 1;
    EXPECT_EQ(value(image, "depth.Z", pixel),
              cover > 0 ? 400.0 : static_cast<double>(kFeatureDepthOfNothing));
    EXPECT_NEAR(value(image, "P.Y", pixel), cover > 0 ? kMiddle.y : 0, 0.002);
    EXPECT_NEAR(value(image, "N.Y", pixel), -cover, 1e-6);
    EXPECT_NEAR(value(image, "Albedo.red", pixel), 0.3 * cover, 1e-6);
    if (cover == 0 || cover == 1) {
      EXPECT_EQ(value(image, "Id", pixel), cover);
    }
  }
  EXPECT_GT(parts, 20);
  const double pixel_cm = 2 * 400 * std::tan(10 * std::acos(-1.0) / 180) / 20;
  EXPECT_NEAR(covered, std::acos(-1.0) * 37 * 37 / (pixel_cm * pixel_cm), 0.4);
}

// Glass, whose light goes on by two ways and at many wavelengths, loses nothing; nor does what is behind it
// show. A boundary of matter is looked through.
TEST(Features, AlbedoIsWhatLeavesByAnyWay) {
  const std::string matter =
      R"("glass": {"dielectric": {"ior": "hikari/F2"}}, "silver": {"mirror": {"reflectance": 0.75}},
    "fog": {"medium": {"scattering_per_m": 0.1}}, "air": {"dielectric": {"ior": 1}}, "grey": {"diffuse": {"reflectance": 0.25}},
    "half": {"mixture": [{"material": "silver", "weight": 0.5}, {"material": "grey", "weight": 0.5}]})";
  const auto middle = [&](const std::string& shapes) {
    const Image image = seen(test::load_text(scene_of(shapes, matter)));
    const std::size_t pixel = 10 * 20 + 10;
    EXPECT_EQ(value(image, "Albedo.red", pixel), value(image, "Albedo.blue", pixel)) << shapes;
    return std::pair(value(image, "Albedo.red", pixel), value(image, "Id", pixel));
  };
  const std::string silver = ball("back", "silver", {0, 200, 0}, 40);
  EXPECT_EQ(middle(silver), std::pair(0.75, 1.0));
  for (const char* unseen : {"fog", "air"})
    EXPECT_EQ(middle(silver + ", " + ball("front", unseen, {0, 0, 0}, 60)), std::pair(0.75, 1.0)) << unseen;
  EXPECT_EQ(middle(silver + ", " + ball("out", "glass", {0, 0, 0}, 900) + ", " +
                   ball("in", "glass", {0, 0, 0}, 60)),
            std::pair(0.75, 1.0))
      << "glass in glass, around the camera";
  const auto [glass, id] = middle(silver + ", " + ball("front", "glass", {0, 0, 0}, 60));
  EXPECT_NEAR(glass, 1, 1e-6);
  EXPECT_EQ(id, 2);
  EXPECT_NEAR(middle(ball("mixed", "half", {0, 0, 0}, 60)).first, 0.5, 1e-3);
}

// They are those of the scene, whatever renders it, in however many threads and parts; and the film stays.
TEST(Features, TheirBitsDependOnNothingButTheSamples) {
  const std::string text =
      scene_of(ball("a", "ramp", {0, 0, 0}, 50) + ", " + ball("b", "ramp", {40, 100, 20}, 50), kRamp);
  const auto sums = [&](const char* integrator, RenderOptions how) {
    how.features = kAll;
    const RenderResult result = render(test::load_text(text, {{"/render/integrator", integrator}}), how);
    return std::string(result.features->sums().bytes());
  };
  const std::string expected = sums("path", {.threads = 1});
  for (const char* integrator :
       {"path", "auto", "light", "bdpt", "photon-map", "ppm", "sppm", "vcm", "adjoint-brute"})
    EXPECT_EQ(sums(integrator, {.threads = 3}), expected) << integrator;
  const Scene scene = test::load_text(text);
  RenderOptions how{.threads = 2};
  const std::string plain(render(scene, how).film.bytes());
  how.features = kAll;
  EXPECT_EQ(render(scene, how).film.bytes(), plain);
}

TEST(Features, PartsAddUpThroughFiles) {
  const Scene scene =
      test::load("cornell.json", {{"/sensor/resolution", "[40, 24]"}, {"/render/samples", "12"}});
  const FilmIdentity identity{{"sensor_channels", "X,Y,Z"}, {kFeaturesKey, to_text(kAll)}};
  RenderOptions how;
  how.features = kAll;
  const RenderPart whole{identity, render(scene, how)};
  const auto part = [&](SampleRange range) {
    const auto path =
        std::filesystem::path(testing::TempDir()) / fmt::format("abbe_features_{}.abbepart", ::getpid());
    how.samples = range;
    write_part(path, identity, render(scene, how));
    RenderPart read = read_part(path);
    std::filesystem::remove(path);
    return read;
  };
  RenderPart sum = part({5, 12});
  merge(sum, part({0, 5}), "part");
  EXPECT_EQ(sum.result.features->sums().bytes(), whole.result.features->sums().bytes());
  EXPECT_EQ(sum.result.film.bytes(), whole.result.film.bytes());
  RenderPart begun = part({0, 7});
  how.samples.reset();
  begun.result = render(scene, how, std::move(begun.result));
  EXPECT_EQ(begun.result.features->sums().bytes(), whole.result.features->sums().bytes());
  how.features.clear();
  EXPECT_THROW((void)render(scene, how, part({0, 7}).result), Error);
}

TEST(Features, ACropHasThoseOfTheWhole) {
  const Scene scene =
      test::load("cornell.json", {{"/sensor/resolution", "[40, 24]"}, {"/render/samples", "4"}});
  const Image whole = seen(scene);
  const Image part = seen(scene, kAll, {.crop = Crop{7, 3, 25, 20}});
  for (const ImageChannel& channel : whole.channels)
    for (std::size_t pixel = 0; pixel < whole.pixels(); ++pixel) {
      const std::size_t x = pixel % 40;
      const std::size_t y = pixel / 40;
      const double outside = channel.name == "depth.Z" ? static_cast<double>(kFeatureDepthOfNothing) : 0;
      const bool inside = x >= 7 && x < 25 && y >= 3 && y < 20;
      EXPECT_EQ(value(part, channel.name, pixel),
                inside ? static_cast<double>(channel.values[pixel]) : outside)
          << channel.name << " " << x << " " << y;
    }
}

}  // namespace
}  // namespace abbe
