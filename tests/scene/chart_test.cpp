#include <gtest/gtest.h>

#include <algorithm>

#include "scene/chart/readout.h"
#include "scene/shapes/basic.h"
#include "tests/description/description.h"

namespace abbe {
namespace {

using Imath::V2d;
using Imath::V3d;
using ChartFileTest = test::DescriptionTest;
using test::Loaded;

// A chart of 6 x 4 m viewed perpendicularly from 10 m, with 20 pixels per metre.
std::string chart_scene(const std::string& chart, const std::string& more = "") {
  return R"({"camera": {"pinhole": {"focal_length": 0.001}, "from": [0, 0, 10], "to": [0, 0, 0], "up": [0, 1, 0]},
  "sensor": {"resolution": [160, 120], "pixel_pitch_um": 5, "channels": {"all": 1}},
  "shapes": [{"name": "c", "chart": {)" +
         chart + R"(}})" + more + "]}";
}
const std::string kPlaced = R"("corner": [-3, -2, 0], "edge_u": [6, 0, 0], "edge_v": [0, 4, 0])";
const std::string kTable = R"("reflectances": "colorchecker24_babelcolor_average", )";

const Quad& quad_of(const Scene& scene, std::uint32_t shape) {
  return std::get<Quad>(scene.shapes.at(shape).shape);
}
V3d middle_of(const Quad& quad) {
  return quad.corner + (quad.edge_u + quad.edge_v) / 2;
}

// A film with values column + 1000 row, each with a variance of 2.
Image ramp() {
  Image film{160, 120, {{"all", {}}}, {}};
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) film.channels[0].values.push_back(static_cast<float>(x + 1000 * y));
  return film;
}

TEST_F(ChartFileTest, PatchesStandRowByRowFromTheTopLeft) {
  const Loaded scene = load(chart_scene(kTable + kPlaced));
  ASSERT_TRUE(scene.scene) << scene.text();
  ASSERT_EQ(scene->charts.size(), 1U);
  ASSERT_EQ(scene->charts[0].patches, 24U);
  EXPECT_EQ(scene->shapes.at(0).name, "c/dark skin");
  EXPECT_EQ(scene->shapes.at(18).name, "c/white 9.5 (.05 D)");
  const auto close = [&](std::uint32_t patch, double x, double y) {
    EXPECT_LT((middle_of(quad_of(*scene.scene, patch)) + scene->origin_m - V3d(x, y, 0)).length(), 1e-12)
        << patch;
  };
  close(0, -2.5, 1.5);
  close(5, 2.5, 1.5);
  close(6, -2.5, 0.5);
  close(23, 2.5, -1.5);
  EXPECT_NEAR(quad_of(*scene.scene, 0).edge_u.x, 0.86, 1e-12);
  EXPECT_GT(normal_of(quad_of(*scene.scene, 0)).z, 0.99) << "faces the reader";
  const auto& white = std::get<DiffuseMaterial>(scene->materials.at(scene->shapes[18].material).model);
  EXPECT_NEAR(white.reflectance.curve()(550), 0.9, 0.03);
}

TEST_F(ChartFileTest, PatchesAndSurroundFillTheRectangleOnce) {
  const Loaded scene = load(chart_scene(kTable + kPlaced));
  ASSERT_TRUE(scene.scene);
  double total = 0;
  for (const ShapeInstance& shape : scene->shapes) total += area(shape.shape);
  EXPECT_NEAR(total, 24, 1e-9);
  for (double x = -2.99; x < 3; x += 0.13)
    for (double y = -1.99; y < 2; y += 0.11)
      EXPECT_TRUE(scene->intersect({Imath::V3f(V3d(x, y, 5) - scene->origin_m), {0, 0, -1}}))
          << x << ' ' << y;
}

TEST_F(ChartFileTest, ATableOfTheUsersMayHaveAnyNumberOfPatches) {
  test::write(folder_ / "mine.csv",
              "# unit: 1\n# outside: clamp\nwavelength_nm,a,b\n400,0.1,0.2\n700,0.3,0.4\n");
  const Loaded scene = load(chart_scene(R"("reflectances": "mine.csv", "surround": 0.5, )" + kPlaced));
  ASSERT_TRUE(scene.scene) << scene.text();
  ASSERT_EQ(scene->shapes.size(), 3U);
  EXPECT_NEAR(middle_of(quad_of(*scene.scene, 1)).x + scene->origin_m.x, -1.5, 1e-12);
  EXPECT_EQ(std::get<DiffuseMaterial>(scene->materials.at(scene->shapes[2].material).model)
                .reflectance.curve()(500),
            0.5);
}

TEST_F(ChartFileTest, EachHasASurroundOfItsOwn) {
  const auto chart = [](const char* surround) {
    return R"({"name": "c", "chart": {)" + kTable + kPlaced + R"(, "surround": )" + surround + "}}";
  };
  const Loaded scene =
      load(R"({"materials": {"c/surround": {"diffuse": {"reflectance": 0.5}}}, "shapes": [)" + chart("0.25") +
           ", " + chart("0.75") + "]}");
  ASSERT_TRUE(scene.scene) << scene.text();
  ASSERT_EQ(scene->shapes.size(), 50U);
  const auto reflectance_of = [&](std::uint32_t shape) {
    const Material& material = scene->materials.at(scene->shapes.at(shape).material);
    return std::get<DiffuseMaterial>(material.model).reflectance.curve()(500);
  };
  EXPECT_EQ(reflectance_of(24), 0.25);
  EXPECT_EQ(reflectance_of(49), 0.75);
  EXPECT_EQ(scene->shapes[0].material, scene->shapes[25].material) << "patches are shared";
}

TEST_F(ChartFileTest, ATransformMovesAllOfIt) {
  const std::string text = chart_scene(kTable + kPlaced);
  const Loaded scene = load(R"({"shapes": [{"name": "c", "chart": {)" + kTable + kPlaced +
                            R"(}, "transform": {"scale": 2, "translate": [10, 0, 0]}}]})");
  ASSERT_TRUE(scene.scene) << scene.text();
  EXPECT_LT((middle_of(quad_of(*scene.scene, 0)) + scene->origin_m - V3d(5, 3, 0)).length(), 1e-9);
}

TEST_F(ChartFileTest, FaultsAreTold) {
  const auto fault = [this](const std::string& chart, const std::string& message) {
    const Loaded scene = load(chart_scene(chart));
    EXPECT_FALSE(scene.scene) << chart;
    EXPECT_NE(scene.text().find(message), std::string::npos) << scene.text();
  };
  fault(kPlaced, "reflectances");
  fault(R"("reflectances": "colorchecker25", )" + kPlaced, "unknown reflectance");
  fault(kTable + R"("corner": [0, 0, 0], "edge_u": [6, 0, 0], "edge_v": [2, 0, 0])", "a chart of zero area");
  test::write(folder_ / "bright.csv", "# unit: 1\n# outside: clamp\nwavelength_nm,a\n400,0.1\n700,1.3\n");
  fault(R"("reflectances": "bright.csv", )" + kPlaced, "is no reflectance");
}

TEST_F(ChartFileTest, ReadOutFindsEachPatchOnTheFilm) {
  const Loaded scene = load(chart_scene(kTable + kPlaced));
  ASSERT_TRUE(scene.scene);
  const std::vector<PatchReading> patches = read_patches(*scene.scene, scene->charts[0], ramp(), {"all"});
  ASSERT_EQ(patches.size(), 24U);
  // The inner 0.602 m of the cell around (-2.5, 1.5) m are 12.04 pixels wide: the whole ones are 24 to 35 in
  // both directions.
  EXPECT_EQ(patches[0].name, "dark skin");
  EXPECT_EQ(patches[0].pixels, 144U);
  EXPECT_NEAR(patches[0].mean[0], 29.5 + 1000 * 29.5, 1e-2);
  EXPECT_NEAR(patches[23].mean[0], 129.5 + 1000 * 89.5, 1e-2);
  EXPECT_NEAR((*patches[18].reflectance)(550), 0.9, 0.03);
}

// Camera rays from the film outline of a patch hit the corners of the patch. This also holds off the axis of
// a lens whose pupil moves so much with the field that no ray passes the center of the entrance.
TEST_F(ChartFileTest, ReadOutFindsPatchesThroughAFisheye) {
  const auto seen = [this](const std::string& corner) {
    return load(R"({"camera": {"lens_system": {"prescription": "fisheye"},
      "from": [0, 0, 0], "to": [0, 1, 0], "up": [0, 0, 1]},
    "sensor": {"resolution": [128, 128], "pixel_pitch_um": 150, "channels": {"all": {"band": [500, 600]}}},
    "lights": [{"environment": {}, "emission": {"spectrum": 1}}],
    "shapes": [{"name": "c", "chart": {)" +
                kTable + R"("corner": )" + corner + R"(, "edge_u": [0.4, 0, 0], "edge_v": [0, 0, 0.4]}}]})");
  };
  const Loaded scene = seen("[-0.2, 0.5, -0.2]");
  ASSERT_TRUE(scene.scene) << scene.text();
  const auto outlines = chart_outlines(*scene.scene, scene->charts[0]);
  ASSERT_EQ(outlines.size(), 24U);
  for (std::uint32_t patch = 0; patch < 24; ++patch) {
    const Quad& quad = quad_of(*scene.scene, patch);
    const V3d corner = quad.corner + 0.15 * (quad.edge_u + quad.edge_v);
    V3d sum(0, 0, 0);
    int passed = 0;
    for (int i = 0; i < 256; ++i) {
      const Imath::V2f lens(V2d(i % 16 + 0.5, i / 16 + 0.5) / 16);
      const CameraRay ray =
          sample_ray(scene->camera, Imath::V2f(outlines[patch].corners[0]), lens, SampledSpectrum(550), 0, 0);
      if (!(ray.weight[0] > 0)) continue;
      const V3d origin(ray.ray.origin);
      const V3d direction(ray.ray.direction);
      sum += origin + direction * ((corner.y - origin.y) / direction.y);
      ++passed;
    }
    ASSERT_GT(passed, 50);
    EXPECT_LT((sum / passed - corner).length(), 2e-3) << patch << ", where a pixel sees 7 mm";
  }
  const Loaded beside = seen("[-4, 0.5, -0.2]");
  ASSERT_TRUE(beside.scene) << beside.text();
  EXPECT_THROW((void)chart_outlines(*beside.scene, beside->charts[0]), Error);
}

TEST_F(ChartFileTest, ReadOutRefusesOtherFilms) {
  const auto refused = [](const Scene& scene, const Image& film, const char* channel, const char* message) {
    try {
      static_cast<void>(read_patches(scene, scene.charts[0], film, {channel}));
      ADD_FAILURE() << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::input);
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  };
  const Loaded scene = load(chart_scene(kTable + kPlaced));
  refused(*scene.scene, {2, 120, {{"all", std::vector<float>(240)}}, {}}, "all",
          "does not have the size of this scene's camera");
  refused(*scene.scene, {160, 1, {{"all", std::vector<float>(160)}}, {}}, "all",
          "does not have the size of this scene's camera");
  refused(*scene.scene, ramp(), "Y", "no channel Y");
  const Loaded aside =
      load(chart_scene(kTable + R"("corner": [3, -2, 0], "edge_u": [6, 0, 0], "edge_v": [0, 4, 0])"));
  refused(*aside.scene, ramp(), "all", "its inner part is outside the film");
  const Loaded small =
      load(chart_scene(kTable + R"("corner": [0, 0, 0], "edge_u": [0.6, 0, 0], "edge_v": [0, 0.4, 0])"));
  refused(*small.scene, ramp(), "all", "contains no whole pixel");
}

}  // namespace
}  // namespace abbe
