#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/scene/scenes.h"
#include "transport/path/free_path.h"
#include "transport/path/media.h"
#include "transport/path/path_recorder.h"
#include "transport/plan/plan.h"
#include "transport/technique/path_starts.h"

namespace abbe {
namespace {

MediumAt absorbing_medium() {
  SampledSpectrum::Values absorption;
  absorption.fill(2);
  absorption[3] = 0;
  return {true, SampledSpectrum(absorption)};
}

TEST(Medium, AttenuatesByBeersLaw) {
  SampledSpectrum lanes(0.5F);
  absorbing_medium().attenuate(lanes, 0.25F);
  EXPECT_FLOAT_EQ(lanes[0], 0.5F * std::exp(-0.5F));
  EXPECT_EQ(lanes[3], 0.5F);
}

TEST(Medium, AttenuatesPreciselyAtAnyDepth) {
  for (float depth = 0; depth < 87; depth += 0.0137F) {
    SampledSpectrum lanes(1.0F);
    MediumAt{true, SampledSpectrum(1.0F)}.attenuate(lanes, depth);
    const double expected = std::exp(-static_cast<double>(depth));
    ASSERT_NEAR(lanes[5], expected, 3e-7 * expected) << depth;
  }
  SampledSpectrum lanes(1.0F);
  MediumAt{true, SampledSpectrum(1.0F)}.attenuate(lanes, 88);
  EXPECT_EQ(lanes[5], 0);
}

TEST(Medium, AnInfiniteWayLeavesWhatIsNotAbsorbed) {
  SampledSpectrum lanes(0.5F);
  absorbing_medium().attenuate(lanes, std::numeric_limits<float>::infinity());
  EXPECT_EQ(lanes[0], 0);
  EXPECT_EQ(lanes[3], 0.5F);
}

// Rounded to floats alone, some points would be behind the plane at which the ray ends.
TEST(FreePath, WhatFloatsDoNotTellFromASurfaceLiesInFrontOfIt) {
  test::Random random(3);
  const auto draw = [&] {
    return Imath::V3f(random.uniform(), random.uniform(), random.uniform()) - Imath::V3f(0.5F);
  };
  for (int i = 0; i < 10'000; ++i) {
    const Imath::V3f normal = draw().normalized();
    const Ray ray{draw() * 8, draw().normalized()};
    const float end = 1 + random.uniform();
    const Imath::V3d plane = Imath::V3d(ray.origin) + Imath::V3d(ray.direction) * static_cast<double>(end);
    const double towards = Imath::V3d(normal).dot(Imath::V3d(ray.direction));
    for (const float distance : {end, std::nextafter(end, 0.0F), end * (1 - 3e-7F), 0.5F * end}) {
      const Imath::V3d point(point_along(ray, distance, end, normal));
      ASSERT_GT((plane - point).dot(Imath::V3d(normal)) * std::copysign(1.0, towards), 0) << distance / end;
      const Imath::V3d straight =
          Imath::V3d(ray.origin) + Imath::V3d(ray.direction) * static_cast<double>(distance);
      ASSERT_LT((point - straight).length(), 8e-7 * 6) << distance / end;
    }
  }
}

TEST(FreePath, WaysWithoutAnEndStayStraight) {
  const Ray ray{{1, 2, 3}, {0, 0, 1}};
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(point_along(ray, 0.5F, infinity, Imath::V3f(0)), Imath::V3f(1, 2, 3.5F));
}

// An optical depth of x is passed with probability e^-x, however small that is.
TEST(FreePath, LastsForTheDepthThatItsNumbersDraw) {
  const Scene scene{};
  RayCaster caster(scene);
  const Medium matter{.scattering_per_m = Curve(4.0)};
  constexpr float kMost = 1 - 0x1p-24F;
  for (const auto& [u, left] :
       {std::pair(Imath::V2f(0.5F, 0), 0.5), std::pair(Imath::V2f(0, 0), 1 - 0x1p-49),
        std::pair(Imath::V2f(0, 0.5F), 1 - 0x1p-25 - 0x1p-49),
        std::pair(Imath::V2f(kMost, 0), 0x1p-24 - 0x1p-49), std::pair(Imath::V2f(kMost, kMost), 0x1p-49)}) {
    PathState walk(Sampler(0, Purpose::camera, 0, 0, 0), 0);
    walk.ray = {{0, 0, 0}, {0, 0, 1}};
    walk.media.medium = {true, SampledSpectrum(4.0F), &matter, SampledSpectrum(4.0F)};
    std::optional<SurfaceHit> hit;
    ASSERT_EQ(propagate(scene, caster, u, walk, hit), SegmentEnd::medium);
    const double expected = -std::log(left) / 4;
    EXPECT_NEAR(walk.ray.origin.z, expected, 2e-7 * expected) << u;
  }
}

// With isotropic scattering, a direction and the free path along it are one point of a three-dimensional
// sequence. Four of its first 256 points are in each of 64 boxes.
TEST(FreePath, FillsDirectionsAndWaysTogether) {
  constexpr double kScatteringPerM = 2;
  constexpr std::size_t kEdge = 4;  // boxes along one dimension
  Scene scene{};
  const CameraFrame frame{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  scene.camera = {Pinhole{frame, 0.05, 0.005}, 1, 1, 1e-8};
  scene.channels = {energy_channel("all", band(450, 650))};
  MediumMaterial fog;
  fog.interior_medium.scattering_per_m = Curve(kScatteringPerM);
  scene.materials = {{"fog", fog}};
  scene.shapes.push_back({"fog", Sphere{{0, 0, 0}, 1000}, 0});
  scene.render.roulette_depth = -1;
  scene.render.max_depth = 3;
  scene.commit();
  const Plan plan = make_plan(scene);
  RayCaster caster(scene);
  PathRecorder<TransportMode::radiance> recorder(scene, caster);
  for (std::uint32_t i = 0; i < 256; ++i) {
    RecordedPath& path = recorder.paths().emplace_back(Sampler(5, Purpose::camera, 0, 0, i), i);
    WavelengthImages none;
    start_from_camera(plan, 0, 0, 0, path, none);
  }
  recorder.run();
  std::array<int, kEdge * kEdge * kEdge> found{};
  for (const RecordedPath& path : recorder.paths()) {
    ASSERT_GE(path.vertices.size(), 3U);
    const auto point = [&](std::size_t i) { return std::get<MediumVertex>(path.vertices[i].at).point; };
    const Imath::V3d way(point(2) - point(1));
    const double turn = std::atan2(way.y, way.x) / (2 * std::numbers::pi) + 0.5;
    const auto box = [](double u) { return static_cast<std::size_t>(u * kEdge); };
    ++found.at((box(way.z / way.length() / 2 + 0.5) * kEdge + box(turn)) * kEdge +
               box(-std::expm1(-kScatteringPerM * way.length())));
  }
  for (const int of : found) EXPECT_EQ(of, 4);
}

std::vector<std::uint32_t> around(const Scene& scene, const Imath::V3f& point) {
  const MediumStack inside = enclosing_media(scene, point);
  return {inside.shapes().begin(), inside.shapes().end()};
}

// Two bodies of six faces each, of one material.
TEST(MediumStack, KnowBodiesMadeOfFaces) {
  Scene scene{};
  scene.materials = {{"fog", DielectricMaterial{"glass", RefractiveIndex(1.5)}}};
  const Imath::V3d x(1, 0, 0);
  const Imath::V3d y(0, 1, 0);
  const Imath::V3d z(0, 0, 1);
  for (const double left : {0.0, 3.0}) {
    const Imath::V3d low(left, 0, 0);
    const Imath::V3d high = low + x + y + z;
    for (const auto& [u, v] : {std::pair(x, y), std::pair(y, z), std::pair(z, x)}) {
      scene.shapes.push_back({"", Quad{high, -u, -v}, 0});
      scene.shapes.push_back({"", Quad{low, v, u}, 0});
    }
  }
  scene.commit();
  EXPECT_EQ(around(scene, Imath::V3f(0.2F, 0.6F, 0.7F) - Imath::V3f(scene.origin_m)).size(), 1U);
  EXPECT_LT(around(scene, Imath::V3f(0.2F, 0.6F, 0.7F) - Imath::V3f(scene.origin_m)).at(0), 6U);
  EXPECT_GE(around(scene, Imath::V3f(3.5F, 0.5F, 0.5F) - Imath::V3f(scene.origin_m)).at(0), 6U);
  EXPECT_TRUE(around(scene, Imath::V3f(2, 0.5F, 0.5F) - Imath::V3f(scene.origin_m)).empty());
  EXPECT_TRUE(around(scene, Imath::V3f(-0.5F, -0.8F, -1) - Imath::V3f(scene.origin_m)).empty());
}

// A ball of glass within another, next to a cube, a card and a pane of glass that encloses nothing.
TEST(MediumStack, AreFoundFromTheOutermost) {
  Scene scene{};
  scene.materials = {{"card", DiffuseMaterial{Curve(0.5)}},
                     {"glass", DielectricMaterial{"glass", RefractiveIndex(1.5)}}};
  Mesh cube;
  for (int i = 0; i < 8; ++i) cube.vertices.emplace_back(9 + (i & 1), (i >> 1) & 1, i >> 2);
  cube.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  scene.shapes = {{"inner", Sphere{{0.5, 0, 0}, 1}, 1},
                  {"outer", Sphere{{0, 0, 0}, 3}, 1},
                  {"cube", cube, 1},
                  {"ball", Sphere{{0.5, 0, 0}, 0.5}, 0},
                  {"pane", Quad{{-50, -50, 20}, {100, 0, 0}, {0, 100, 0}}, 1}};
  scene.commit();
  using Shapes = std::vector<std::uint32_t>;
  EXPECT_EQ(around(scene, {0.5F, 0, 0.2F}), (Shapes{1, 0}));
  EXPECT_EQ(around(scene, {-0.7F, 0, 0}), Shapes{1});
  EXPECT_EQ(around(scene, {0, 3.5F, 0}), Shapes{});
  EXPECT_EQ(around(scene, {9.5F, 0.4F, 0.7F}), Shapes{2});
  EXPECT_EQ(around(scene, {0, 0, 10}), Shapes{});
}

TEST(MediumStack, ReturnToWhatIsAround) {
  Scene scene{};
  scene.materials = {{"glass", DielectricMaterial{"glass", RefractiveIndex(1.5)}},
                     {"water", DielectricMaterial{"water", RefractiveIndex(1.33)}},
                     {.name = "ice", .model = DielectricMaterial{"ice", RefractiveIndex(1.3)}, .priority = 3},
                     {"pane", ThinGlassMaterial{"glass", RefractiveIndex(1.5)}}};
  for (std::uint32_t i = 0; i < 120; ++i)
    scene.shapes.push_back({"", Sphere{{0, 0, 0}, 1}, i == 3 ? 1U : 0U});
  scene.shapes[9].material = 2;
  scene.shapes[8].material = 3;
  MediumStack inside;
  inside.cross(scene, 7, false);  // arrival from behind a surface that encloses nothing
  EXPECT_TRUE(inside.empty());
  inside.cross(scene, 3, true);
  inside.cross(scene, 5, true);
  inside.cross(scene, 5, true);
  EXPECT_EQ(inside.innermost(), 5U);
  inside.cross(scene, 8, true);
  EXPECT_EQ(inside.innermost(), 5U) << "a pane has no inside";
  inside.cross(scene, 6, false);  // another face of the same body
  EXPECT_EQ(inside.innermost(), 3U);
  inside.cross(scene, 9, true);
  inside.cross(scene, 5, true);
  EXPECT_EQ(inside.innermost(), 9U) << "by its priority";
  inside.cross(scene, 9, false);
  EXPECT_EQ(inside.innermost(), 5U);
  for (std::uint32_t shape = 100; inside.shapes().size() < MediumStack::kMaxShapes; ++shape)
    inside.cross(scene, shape, true);
  EXPECT_THROW(inside.cross(scene, 99, true), Error);
}

}  // namespace
}  // namespace abbe
