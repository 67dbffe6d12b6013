#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "description/meshes/mesh_file.h"
#include "scene/camera/camera.h"
#include "scene/shapes/mesh.h"
#include "spectral/colorimetry.h"
#include "tests/validation/bench_runs.h"
#include "validation/bench/generated_scene.h"
#include "validation/bench/run.h"

namespace abbe {
namespace {

using test::BenchFolder;

BenchSuite small_furnace(const std::string& reflectance = "0.8") {
  return {"small",
          "",
          "scenes/furnace.json",
          {{"/sensor/resolution", "[4, 4]"}, {"/materials/wall/diffuse/reflectance", reflectance}}};
}

TEST(BenchReference, IsFoundAgainAndAnotherSceneIsNot) {
  const BenchFolder folder;
  const Scene scene = load_suite(small_furnace(), folder.path(), false);
  const Reference first = reference_of(scene, folder.path(), "1", 7, 4, 1);
  const Reference again = reference_of(scene, folder.path(), "1", 7, 4, 1);
  EXPECT_FALSE(first.cached);
  EXPECT_TRUE(again.cached);
  EXPECT_EQ(first.key, again.key);
  for (const char* name : {"R", "G", "B", "Variance.R", "Variance.G", "Variance.B"}) {
    ASSERT_NE(again.image.find(name), nullptr) << name;
    EXPECT_EQ(first.image.find(name)->values, again.image.find(name)->values) << name;
  }
  const Scene other = load_suite(small_furnace("0.7"), folder.path(), false);
  EXPECT_FALSE(reference_of(other, folder.path(), "1", 7, 4, 1).cached);
  EXPECT_FALSE(reference_of(scene, folder.path(), "1", 7, 8, 1).cached);
  EXPECT_FALSE(reference_of(scene, folder.path(), "1", 8, 4, 1).cached);
  EXPECT_FALSE(reference_of(scene, folder.path(), "2", 7, 4, 1).cached);
}

TEST(BenchReference, TheKeyHangsOnEverything) {
  const ReferenceKey key{"scene", 4, 3, "1", "data", 7, 64};
  EXPECT_EQ(key.text(), (ReferenceKey{"scene", 4, 3, "1", "data", 7, 64}).text());
  for (const ReferenceKey& other : {ReferenceKey{"other", 4, 3, "1", "data", 7, 64},
                                    {"scene", 5, 3, "1", "data", 7, 64},
                                    {"scene", 4, 4, "1", "data", 7, 64},
                                    {"scene", 4, 3, "2", "data", 7, 64},
                                    {"scene", 4, 3, "1", "other", 7, 64},
                                    {"scene", 4, 3, "1", "data", 8, 64},
                                    {"scene", 4, 3, "1", "data", 7, 65}})
    EXPECT_NE(key.text(), other.text());
}

TEST(BenchReference, ExposesInLinearSrgb) {
  Scene scene;
  scene.channels = observer_channels(Observer::cie1931);
  const Curve y = scene.channels[1].weight;
  expose_in_srgb(scene);
  ASSERT_EQ(scene.channels.size(), 3U);
  EXPECT_EQ(scene.channels[0].name, "R");
  // Y is 0.2126 R + 0.7152 G + 0.0722 B in linear sRGB.
  for (const double nm : {450.0, 550.5, 620.0}) {
    const double sum = 0.212639 * scene.channels[0].weight(nm) + 0.715169 * scene.channels[1].weight(nm) +
                       0.072192 * scene.channels[2].weight(nm);
    EXPECT_NEAR(sum / y(nm), 1, 1e-4) << nm;
  }
  EXPECT_LT(scene.channels[0].weight(500), 0) << "spectral cyan is out of the gamut";
}

TEST(BenchReference, WhiteOfTheObserverIsWhiteInSrgb) {
  const Image film{1, 1, {{"X", {0.95046F}}, {"Y", {1}}, {"Z", {1.08906F}}, {"Variance.X", {9}}}, {}};
  const Image rgb = linear_srgb(film);
  ASSERT_EQ(rgb.channels.size(), 3U);
  for (const char* name : {"R", "G", "B"}) EXPECT_NEAR(rgb.find(name)->values[0], 1, 1e-4) << name;
}

TEST(BenchSuites, AFurnaceIsMeasuredAgainstItsReference) {
  const BenchFolder folder;
  BenchSettings settings;
  settings.samples = {2, 32};
  settings.seeds = 2;
  settings.cache = folder.path();
  const SuiteRun run = run_suite(small_furnace(), settings);
  EXPECT_EQ(run.conditions.reference_samples, 64 * 32);
  ASSERT_EQ(run.rows.size(), 4U);
  EXPECT_EQ(run.rows[1].samples, 2);
  EXPECT_EQ(run.rows[1].seed, 2U);
  EXPECT_EQ(run.rows[1].paths, 4U * 4 * 2);
  EXPECT_NE(run.rows[0].rel_mse, run.rows[1].rel_mse);
  const std::vector<BenchRow> means = means_over_seeds(run.rows);
  EXPECT_GT(means[0].rel_mse, 4 * means[1].rel_mse);
  EXPECT_GT(means[1].rel_mse, 0);
}

TEST(BenchSuites, QuickOnesHaveAQuarterOfTheEdges) {
  const BenchFolder folder;
  const Scene whole = load_suite(choose_suites({"cornell"}).front(), folder.path(), false);
  const Scene quick = load_suite(choose_suites({"cornell"}).front(), folder.path(), true);
  EXPECT_EQ(whole.camera.width, 256);
  EXPECT_EQ(quick.camera.width, 64);
  EXPECT_DOUBLE_EQ(quick.camera.pixel_pitch, 4 * whole.camera.pixel_pitch);
}

TEST(BenchSuites, NarrowLampHasTheSameLuminanceInTenNanometres) {
  const BenchFolder folder;
  const Scene scene = load_suite(choose_suites({"cornell-10nm"}).front(), folder.path(), false);
  const Curve emission = scene.lights.at(0).emission.curve();
  EXPECT_EQ(emission(583.9), 0);
  EXPECT_GT(emission(584), 0);
  EXPECT_GT(emission(593.9), 0);
  EXPECT_EQ(emission(594), 0);
  EXPECT_NEAR(photometric(emission), 20 * kLuminousEfficacy, 1e-6);
}

// Without a closed shape there would be no caustic, and a slab with a hole would not disperse.
TEST(BenchSuites, CausticsAreSeenBesideAndThroughClosedShapes) {
  const BenchFolder folder;
  for (const char* name : {"ring", "through-pane", "through-slab"}) {
    const BenchSuite suite = choose_suites({name}).front();
    const Scene scene = load_suite(suite, folder.path(), true);
    EXPECT_TRUE(scene.features.caustics && scene.features.light_tracing) << name;
  }
  const Scene slab = load_suite(choose_suites({"through-slab"}).front(), folder.path(), true);
  // The ray from the camera to its target hits the slab from outside and enters its medium.
  const CameraRay ray = sample_ray(slab.camera, {32, 32}, {0.5F, 0.5F}, SampledSpectrum(550.0F), 0, 0);
  const auto hit = slab.intersect(ray.ray);
  ASSERT_TRUE(hit);
  EXPECT_EQ(slab.shapes[hit->shape].name, "slab");
  EXPECT_LT(hit->normal.dot(ray.ray.direction), 0);
}

TEST(BenchSuites, TheConditionsAreThoseThatARunIsTakenUnder) {
  const BenchFolder folder;
  BenchSettings settings;
  settings.samples = {1};
  settings.seeds = 1;
  settings.threads = 2;
  settings.reference_samples = 2;
  settings.cache = folder.path();
  const BenchConditions told = conditions_of(small_furnace(), settings);
  const BenchConditions taken = run_suite(small_furnace(), settings).conditions;
  EXPECT_EQ(taken.width, 4);
  EXPECT_EQ(taken.threads, 2);
  EXPECT_EQ(told.width, taken.width);
  EXPECT_EQ(told.height, taken.height);
  EXPECT_EQ(told.scene_sha256, taken.scene_sha256);
  EXPECT_EQ(told.reference_samples, taken.reference_samples);
  EXPECT_EQ(told.threads, taken.threads);
}

TEST(BenchSuites, ANameThatIsGivenTwiceIsOneSuite) {
  const std::vector<BenchSuite> suites = choose_suites({"ring", "cornell", "ring"});
  ASSERT_EQ(suites.size(), 2U);
  EXPECT_EQ(suites[0].name, "ring");
  EXPECT_EQ(suites[1].name, "cornell");
}

TEST(BenchSuites, UnknownNamesComeWithTheNearest) {
  try {
    static_cast<void>(choose_suites({"cornel"}));
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code, ErrorCode::usage);
    EXPECT_NE(std::string(e.what()).find("did you mean \"cornell\""), std::string::npos) << e.what();
  }
}

TEST(BenchMeshes, TheBallIsClosedAndFacesOutwardsAndTheTerrainUpwards) {
  const Mesh ball = make_bumpy_ball(64);
  EXPECT_EQ(ball.triangles.size(), 4U * 64 * 63);
  double volume = 0;
  Imath::V3d outside(0, 0, 0);
  for (std::size_t i = 0; i < ball.triangles.size(); ++i) {
    outside += area_vector(ball, i);
    volume += area_vector(ball, i).dot(ball.vertices[ball.triangles[i][0]]) / 3;
  }
  EXPECT_NEAR(outside.length(), 0, 1e-9);
  EXPECT_NEAR(volume, 4.0 / 3 * std::numbers::pi * 3.375, 0.1);
  const Mesh terrain = make_terrain(16);
  EXPECT_EQ(terrain.triangles.size(), 2U * 16 * 16);
  for (std::size_t i = 0; i < terrain.triangles.size(); ++i) EXPECT_GT(area_vector(terrain, i).y, 0);
}

// A polygon of 64 corners at the radius encloses the fraction 64/(2 pi) sin(2 pi/64) of the circle.
TEST(BenchMeshes, TheRingIsClosedAndFacesOutwards) {
  const Mesh ring = make_ring(64);
  EXPECT_EQ(ring.triangles.size(), 8U * 64);
  double volume = 0;
  Imath::V3d outside(0, 0, 0);
  for (std::size_t i = 0; i < ring.triangles.size(); ++i) {
    outside += area_vector(ring, i);
    volume += area_vector(ring, i).dot(ring.vertices[ring.triangles[i][0]]) / 3;
  }
  EXPECT_NEAR(outside.length(), 0, 1e-12);
  EXPECT_NEAR(volume, 32 * std::sin(2 * std::numbers::pi / 64) * (1 - 0.81) * 0.5, 1e-12);
}

TEST(BenchMeshes, ComeBackFromPly) {
  const BenchFolder folder;
  const Mesh ball = make_bumpy_ball(8);
  write_ply(folder.path() / "ball.ply", ball);
  Diagnostics diagnostics;
  const auto file = load_mesh_file(folder.path() / "ball.ply", FileMaterials::ignored, {}, diagnostics);
  ASSERT_TRUE(file && file->submeshes.size() == 1) << diagnostics.text();
  const Mesh& read = file->submeshes.front().mesh;
  EXPECT_EQ(read.triangles, ball.triangles);
  ASSERT_EQ(read.vertices.size(), ball.vertices.size());
  EXPECT_NEAR((read.vertices.back() - ball.vertices.back()).length(), 0, 1e-6);
}

}  // namespace
}  // namespace abbe
