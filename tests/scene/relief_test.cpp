#include <cmath>

#include <gtest/gtest.h>

#include "scene/scene.h"
#include "scene/shapes/shape.h"
#include "scenes.h"
#include "tests/angles.h"
#include "tests/description/mesh_files.h"

namespace abbe {
namespace {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using test::Loaded;

Scene in_relief(Shape shape, Relief relief) {
  Scene scene{};
  scene.camera = test::pinhole();
  scene.materials = {test::mirror()};
  scene.materials[0].relief = std::make_shared<const Relief>(std::move(relief));
  scene.shapes.push_back({"shape", std::move(shape), 0});
  scene.commit();
  return scene;
}
// The shading normal at a point hit from above.
V3f normal_at(const Scene& scene, float x, float y) {
  const auto hit = scene.intersect({{x, y, 5}, {0, 0, -1}});
  EXPECT_TRUE(hit);
  return hit ? textured_shading_point(scene, *hit, 0).frame.z : V3f(0);
}

// Tilted by (0.36, 0.48) of its length along u and v.
NormalMap leaning() {
  return {TextureImage(1, 1, 3, {0.68F, 0.74F, 0.9F}, {})};
}

TEST(Relief, NormalsLeanAlongTheCoordinates) {
  const Scene turned = in_relief(Quad{{2, 0, 0}, {0, 3, 0}, {-2, 0, 0}}, leaning());
  EXPECT_LT((normal_at(turned, 1, 1) - V3f(-0.48F, 0.36F, 0.8F)).length(), 1e-5F);
  // Mirrored coordinates with u against x.
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {{{{1, 0}, {0, 0}, {1, 1}}}}};
  EXPECT_LT((normal_at(in_relief(mesh, leaning()), 0.2F, 0.2F) - V3f(-0.36F, 0.48F, 0.8F)).length(), 1e-5F);
  // Outward remains outward for an instance.
  const auto below = std::make_shared<Placement>(placement(Imath::M44d().setScale(V3d(2, 1, -1))));
  const Shape placed = PlacedShape{make_prototype(Quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), below};
  EXPECT_LT((normal_at(in_relief(placed, leaning()), 0.5F, 0.5F) - V3f(0.36F, 0.48F, -0.8F)).length(), 1e-5F);
}

// A plane wave of heights on a skewed quad of 2 m x 1 m, compared with the normals of its gradient.
TEST(Relief, HeightsTurnNormalsByTheirGradient) {
  constexpr int kSide = 512;
  constexpr double kHeight = 0.01;
  const double wave = 2 * kPi * 3;
  std::vector<float> heights;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column)
      heights.push_back(
          static_cast<float>(std::sin(wave * ((column + 0.5) / kSide + 2 * (1 - (row + 0.5) / kSide)))));
  const Scene scene = in_relief(Quad{{0, 0, 0}, {2, 0, 0}, {0.5, 1, 0}},
                                BumpMap{TextureImage(kSide, kSide, 1, std::move(heights), {}), kHeight});
  test::Random random(2);
  for (int i = 0; i < 100; ++i) {
    const V2f uv = random.pair();
    const double u = static_cast<double>(uv.x);
    const double v = static_cast<double>(uv.y);
    const double slope = kHeight * wave * std::cos(wave * (u + 2 * v));
    // u = (x - y/2)/2, v = y: the heights' derivatives in x and y.
    const V3d expected = V3d(-slope / 2, -slope * (2 - 0.25), 1).normalized();
    const V3f found = normal_at(scene, static_cast<float>(2 * u + v / 2), static_cast<float>(v));
    EXPECT_LT((V3d(found) - expected).length(), 1e-3) << uv;
  }
}

TEST(Relief, FlatMapsChangeNothing) {
  const Scene bumps = in_relief(Sphere{{0, 0, 0}, 2}, BumpMap{TextureImage(1, 1, 1, {0.5F}, {}), 1});
  const Scene normals =
      in_relief(Sphere{{0, 0, 0}, 2}, NormalMap{TextureImage(1, 1, 3, {0.5F, 0.5F, 1}, {})});
  for (const Scene* scene : {&bumps, &normals})
    for (const V2f& p : {V2f(0, 0), V2f(0.3F, -0.9F), V2f(-1.5F, 1)}) {
      const V3f expected = V3f(p.x, p.y, std::sqrt(4 - p.length2())) / 2.0F;
      EXPECT_LT((normal_at(*scene, p.x, p.y) - expected).length(), 1e-5F) << p;
    }
}

class ReliefTest : public test::MeshFileTest {
 protected:
  static std::string glossy(const std::string& keys) {
    return fmt::format(R"({{"materials": {{"m": {{"conductor": {{"ior": "Ag_Johnson"}}, {}}}}}}})", keys);
  }
};

TEST_F(ReliefTest, KeysOfAnyMaterial) {
  write_exr(folder_ / "heights.exr", {2, 1, {{"Z", {0, 1}}}, {}});
  const Loaded normals = load(glossy(R"("normal_map": {"image": "normals.exr"})"));
  ASSERT_TRUE(normals.scene) << normals.text();
  EXPECT_NEAR(std::get<NormalMap>(*normals->materials[0].relief).normal({0, 0}).y, 0.6, 1e-6);
  const Loaded bumps = load(
      R"({"units": "mm", "materials": {"m": {"diffuse": {"reflectance": 0.5}, "bump_map": {"image": "heights.exr", "height": 3, "wrap": "clamp"}}}})");
  ASSERT_TRUE(bumps.scene) << bumps.text();
  EXPECT_NEAR(std::get<BumpMap>(*bumps->materials[0].relief).slope({0.5F, 0.5F}).x, 2 * 0.003, 1e-9);
  EXPECT_EQ(load(glossy("\"name\": 1")).scene.has_value(), false);
}

TEST_F(ReliefTest, FaultsAreRefused) {
  write_exr(folder_ / "inward.exr", {1, 2, {{"R", {0.5F, 0.5F}}, {"G", {0.5F, 0.5F}}, {"B", {1, 0.5F}}}, {}});
  write_exr(folder_ / "signed.exr", {1, 2, {{"R", {0, 0.6F}}, {"G", {0, -0.25F}}, {"B", {1, 0.8F}}}, {}});
  write_exr(folder_ / "beyond.exr", {1, 1, {{"R", {0.5F}}, {"G", {0.5F}}, {"B", {1.5F}}}, {}});
  DescriptionTest::expect_refused(
      {{"two channels for normals", glossy(R"("normal_map": {"image": "paint.exr"})"), ErrorCode::input,
        "texture \"paint.exr\": a normal map needs channels R, G, B (got 2 channels)"},
       {"three for heights", glossy(R"("bump_map": {"image": "photo.exr", "height": 1})"), ErrorCode::input,
        "texture \"photo.exr\": a bump map needs one channel (got 3 channels)"},
       {"inward", glossy(R"("normal_map": {"image": "inward.exr"})"), ErrorCode::input,
        "texel (0, 1) is a normal that does not point outward (got B = 0.5, allowed (0.5, 1])"},
       {"components in place of codes", glossy(R"("normal_map": {"image": "signed.exr"})"), ErrorCode::input,
        "texel (0, 1) is not an encoded normal (got G = -0.25, allowed [0, 1])"},
       {"more than 1", glossy(R"("normal_map": {"image": "beyond.exr"})"), ErrorCode::input,
        "texel (0, 0) is not an encoded normal (got B = 1.5, allowed [0, 1])"},
       {"no height", glossy(R"("bump_map": {"image": "sky.exr"})"), ErrorCode::scene, "height"},
       {"both",
        glossy(R"("normal_map": {"image": "photo.exr"}, "bump_map": {"image": "sky.exr", "height": 1})"),
        ErrorCode::scene, "a material has a normal_map or a bump_map (got normal_map and bump_map)"}});
}

TEST_F(ReliefTest, WhatRoundingLeavesOfANormalIsTaken) {
  write_exr(folder_ / "rounded.exr", {1, 1, {{"R", {0.5F}}, {"G", {-0.0005F}}, {"B", {1.0005F}}}, {}});
  const Loaded rounded = load(glossy(R"("normal_map": {"image": "rounded.exr"})"));
  EXPECT_TRUE(rounded.scene) << rounded.text();
}

TEST_F(ReliefTest, AMeshWithoutCoordinatesTakesNone) {
  write_exr(folder_ / "heights.exr", {2, 1, {{"Z", {0, 1}}}, {}});
  const Loaded loaded = load(
      R"({"materials": {"m": {"diffuse": {"reflectance": 0.5}, "bump_map": {"image": "heights.exr", "height": 3}}},
          "shapes": [{"mesh": "bench.ply", "material": "m"}]})");
  EXPECT_FALSE(loaded.scene);
  EXPECT_NE(loaded.text().find("mesh \"bench.ply\": no texture coordinates, which its material \"m\" needs"),
            std::string::npos)
      << loaded.text();
}

}  // namespace
}  // namespace abbe
