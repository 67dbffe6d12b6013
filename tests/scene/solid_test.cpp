#include "scene/shapes/solid.h"

#include <cmath>
#include <cstdint>
#include <ctime>

#include <gtest/gtest.h>

#include "meshes.h"
#include "tests/description/mesh_files.h"

namespace abbe {
namespace {

using test::box;
using test::inside_out;
using test::joined;
using test::Loaded;
using test::torn;
using test::volume;

const Mesh kBox = box({0, 0, 0}, {1, 1, 1});
const Mesh kHole = box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75});
constexpr double kHollow = 1 - 0.125;

Mesh open_box() {
  Mesh open = kBox;
  open.triangles.resize(10);
  return open;
}

struct Case {
  const char* what;
  Mesh mesh;
  SolidReport expected;
  double volume;
};

TEST(Solid, ReportsAndMends) {
  Mesh mixed = kBox;
  for (const std::size_t i : {1U, 6U, 11U}) std::swap(mixed.triangles[i][0], mixed.triangles[i][1]);
  Mesh repeated = kBox;
  repeated.triangles.push_back({6, 0, 4});
  Mesh backed = kBox;
  backed.triangles.push_back({4, 0, 6});
  Mesh wall = joined(kBox, box({1, 0, 0}, {2, 1, 1}));
  Mesh zeros = torn(kBox);
  for (std::size_t i = 0; i < zeros.vertices.size(); i += 2) zeros.vertices[i] *= Imath::V3d(1, -1, 1);
  for (std::size_t i = 0; i < zeros.vertices.size(); i += 2)
    zeros.vertices[i].y = zeros.vertices[i].y == 0 ? -0.0 : 1;
  const Mesh inner = box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6});
  const Case cases[] = {
      {"closed", kBox, {}, 1},
      {"seams", torn(kBox), {}, 1},
      {"signs of zero", zeros, {}, 1},
      {"one side missing", open_box(), {.open_edges = 4}, volume(open_box())},
      {"inside out", inside_out(kBox), {.inverted = 1}, 1},
      {"seams, inside out", inside_out(torn(kBox)), {.inverted = 1}, 1},
      {"a cavity", joined(kBox, inside_out(kHole)), {}, kHollow},
      {"a cavity first", joined(inside_out(kHole), kBox), {}, kHollow},
      {"a cavity, all of it inside out", joined(inside_out(kBox), kHole), {.inverted = 2}, kHollow},
      {"a cavity in what is inside out",
       joined(inside_out(kBox), inside_out(kHole)),
       {.inverted = 1},
       kHollow},
      {"a body in a body", joined(kBox, kHole), {.buried = 1}, 1 + 0.125},
      {"an island in a cavity", joined(joined(kBox, inside_out(kHole)), inner), {}, kHollow + 0.008},
      {"an island, all of it inside out",
       joined(joined(inside_out(kBox), kHole), inside_out(inner)),
       {.inverted = 3},
       kHollow + 0.008},
      {"an island inside out",
       joined(joined(kBox, inside_out(kHole)), inside_out(inner)),
       {.inverted = 1},
       kHollow + 0.008},
      {"beside another", joined(kBox, inside_out(box({3, 0, 0}, {4, 1, 1}))), {.inverted = 1}, 2},
      {"mixed windings", mixed, {.rewound = 3}, 1},
      {"mixed windings, inside out", inside_out(mixed), {.rewound = 3, .inverted = 1}, 1},
      {"a repeated triangle", repeated, {.repeated = 1}, 1},
      {"an edge in common", joined(kBox, box({1, 1, 0}, {2, 2, 1})), {}, 2},
      {"a wall in common", wall, {.back_to_back = 2}, 2},
      {"a triangle backing another", backed, {.crowded_edges = 3, .back_to_back = 1}, volume(backed)},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    Mesh mesh = c.mesh;
    const SolidReport report = make_solid(mesh);
    EXPECT_EQ(report.repeated, c.expected.repeated);
    EXPECT_EQ(report.rewound, c.expected.rewound);
    EXPECT_EQ(report.inverted, c.expected.inverted);
    EXPECT_EQ(report.open_edges, c.expected.open_edges);
    EXPECT_EQ(report.crowded_edges, c.expected.crowded_edges);
    EXPECT_EQ(report.clashing_edges, c.expected.clashing_edges);
    EXPECT_EQ(report.back_to_back, c.expected.back_to_back);
    EXPECT_EQ(report.buried, c.expected.buried);
    EXPECT_NEAR(volume(mesh), c.volume, 1e-12);
    if (!c.expected.repaired()) {
      EXPECT_EQ(mesh.triangles, c.mesh.triangles);
    }
  }
}

// A strip of four squares joined after half a turn has one side and a border.
TEST(Solid, OneSidedStripsAreLeft) {
  Mesh strip;
  for (int i = 0; i < 4; ++i)
    for (const double z : {0.0, 1.0}) strip.vertices.emplace_back(std::cos(1.5 * i), std::sin(1.5 * i), z);
  for (std::uint32_t i = 0; i < 8; i += 2) {
    const bool last = i == 6;
    const std::uint32_t low = last ? 1 : i + 2;
    const std::uint32_t high = last ? 0 : i + 3;
    strip.triangles.push_back({i, low, high});
    strip.triangles.push_back({i, high, i + 1});
  }
  const Mesh before = strip;
  const SolidReport report = make_solid(strip);
  EXPECT_EQ(report.open_edges, 8U);
  EXPECT_EQ(report.clashing_edges, 1U);
  EXPECT_FALSE(report.repaired());
  EXPECT_EQ(strip.triangles, before.triangles);
}

TEST(Solid, CornersAreTurnedWithTheirTriangle) {
  Mesh mesh = inside_out(kBox);
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto uv = [](std::uint32_t i) { return Imath::V2f(static_cast<float>(i), 0); };
    const auto normal = [](std::uint32_t i) { return Imath::V3f(static_cast<float>(i), 0, 1); };
    mesh.coordinates.push_back({uv(a), uv(b), uv(c)});
    mesh.normals.push_back({normal(a), normal(b), normal(c)});
  }
  EXPECT_EQ(make_solid(mesh).inverted, 1U);
  for (std::size_t i = 0; i < 12; ++i)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      EXPECT_EQ(mesh.coordinates[i].at(corner).x, static_cast<float>(mesh.triangles[i].at(corner)));
      EXPECT_EQ(mesh.normals[i].at(corner).x, static_cast<float>(mesh.triangles[i].at(corner)));
    }
}

// Four times as many droplets take about four times as long, not sixteen.
TEST(Solid, ManyComponentsTakeNoLongerThanTheirNumber) {
  const Mesh drop = box({0, 0, 0}, {0.5, 0.5, 0.5});
  const auto seconds = [&](std::size_t count) {
    Mesh drops;
    for (std::size_t i = 0; i < count; ++i) {
      const auto first = static_cast<std::uint32_t>(drops.vertices.size());
      for (const Imath::V3d& v : drop.vertices)
        drops.vertices.push_back(v + Imath::V3d(static_cast<double>(i), 0, 0));
      for (const auto& [a, b, c] : drop.triangles)
        drops.triangles.push_back({first + a, first + (i % 2 ? c : b), first + (i % 2 ? b : c)});
    }
    const std::clock_t start = std::clock();
    EXPECT_EQ(make_solid(drops).inverted, count / 2);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  EXPECT_LT(seconds(40000), 8 * seconds(10000));
}

class SolidTest : public test::MeshFileTest {
 protected:
  Loaded made_of(const std::string& matter, const std::string& mesh) {
    return load(fmt::format(
        R"({{"materials": {{"m": {{{}}}}}, "shapes": [{{"mesh": {}, "material": "m"}}],
            "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}]}})",
        matter, mesh));
  }
  // Diagnostics of the scene that was loaded last, under --strict.
  Diagnostics strictly() {
    Diagnostics diagnostics(Strictness::strict);
    const bool loaded = load_scene(folder_ / "scene.json", {}, diagnostics).has_value();
    EXPECT_NE(loaded, diagnostics.has_errors());
    return diagnostics;
  }
};

constexpr const char* kClearGlass = R"("dielectric": {"ior": 1.5})";

TEST_F(SolidTest, OpenMatterIsWarnedOfAndRefusedWhenStrict) {
  test::write(folder_ / "open.obj", test::obj_text(open_box()));
  const std::string fault = R"(mesh "open.obj" around medium "m" is not a closed surface: 4 open edges)";
  for (const char* matter : {kClearGlass, R"("dielectric": {"ior": 1.5, "roughness": 0.3})",
                             R"("medium": {"scattering_per_m": 2})"}) {
    const Loaded loaded = made_of(matter, "\"open.obj\"");
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_NE(loaded.text().find("/shapes/0/mesh: warning: " + fault), std::string::npos) << loaded.text();
    const Diagnostics strict = strictly();
    EXPECT_EQ(strict.code(), ErrorCode::scene);
    EXPECT_NE(strict.text().find("/shapes/0/mesh: error: " + fault), std::string::npos) << strict.text();
  }
  for (const char* surface : {R"("diffuse": {"reflectance": 0.5})", R"("thin_glass": {"ior": 1.5})",
                              R"("conductor": {"ior": "Ag_Johnson"})"}) {
    EXPECT_EQ(made_of(surface, "\"open.obj\"").text().find("open edges"), std::string::npos) << surface;
    EXPECT_FALSE(strictly().has_errors()) << surface;
  }
}

TEST_F(SolidTest, WhatIsPutRightIsNoFault) {
  const Loaded loaded = made_of(kClearGlass, test::inline_mesh(inside_out(kBox)));
  ASSERT_TRUE(loaded.scene);
  EXPECT_NEAR(volume(std::get<Mesh>(loaded->shapes[0].shape)), 1, 1e-12);
  EXPECT_NE(loaded.text().find(R"(warning: the mesh around medium "m": repaired: 1 component facing inward)"),
            std::string::npos)
      << loaded.text();
  EXPECT_FALSE(strictly().has_errors());
  const Loaded opaque = made_of(R"("diffuse": {"reflectance": 0.5})", test::inline_mesh(inside_out(kBox)));
  EXPECT_NEAR(volume(std::get<Mesh>(opaque->shapes[0].shape)), -1, 1e-12) << "left alone";
}

TEST_F(SolidTest, ObjectsAndMaterialsOfFilesToo) {
  test::write(folder_ / "box.obj", test::obj_text(inside_out(kBox)));
  const Loaded placed = load(fmt::format(
      R"({{"materials": {{"m": {{{}}}}}, "objects": {{"o": {{"shapes": [{{"mesh": "box.obj", "material": "m"}}]}}}},
          "shapes": [{{"instance": {{"of": "o"}}}}, {{"instance": {{"of": "o", "transform": {{"scale": [1, -1, 2]}}}}}}]}})",
      kClearGlass));
  ASSERT_TRUE(placed.scene) << placed.text();
  EXPECT_NEAR(volume(std::get<Mesh>(std::get<PlacedShape>(placed->shapes[1].shape).of->shape)), 1, 1e-12);
}

// A corner on a neighbour's edge, with a triangle of zero area in between.
TEST_F(SolidTest, TrianglesWithoutAreaJoinEdges) {
  Mesh split = kBox;
  split.vertices.emplace_back(0.5, 0, 0);
  split.triangles[9] = {0, 3, 8};
  split.triangles.push_back({8, 3, 1});
  EXPECT_NE(made_of(kClearGlass, test::inline_mesh(split)).text().find("3 open edges"), std::string::npos);
  split.triangles.push_back({0, 8, 1});
  const Loaded joint = made_of(kClearGlass, test::inline_mesh(split));
  EXPECT_EQ(joint.text().find("open edges"), std::string::npos) << joint.text();
  EXPECT_EQ(std::get<Mesh>(joint->shapes[0].shape).triangles.size(), 13U);
  EXPECT_NEAR(enclosed_volume(std::get<Mesh>(joint->shapes[0].shape)), 1, 1e-12);
  const Loaded opaque = made_of(R"("diffuse": {"reflectance": 0.5})", test::inline_mesh(split));
  EXPECT_TRUE(std::get<Mesh>(opaque->shapes[0].shape).slivers.empty());
}

TEST(EnclosedVolume, IsThatOfTheLargestComponentOfWhatIsClosed) {
  Mesh two = joined(kBox, box({1e5, 0, 0}, {1e5 + 2, 2, 2}));
  EXPECT_NEAR(enclosed_volume(kBox), 1, 1e-12);
  EXPECT_NEAR(enclosed_volume(inside_out(kBox)), 1, 1e-12);
  EXPECT_NEAR(enclosed_volume(two), 8, 1e-9);
  two.triangles.pop_back();
  EXPECT_NEAR(enclosed_volume(two), 1, 1e-12) << "the other is open";
  EXPECT_NEAR(enclosed_volume(Sphere{{1, 2, 3}, 0.5}), 0.5235987755982989, 1e-15);
  EXPECT_EQ(enclosed_volume(Quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), 0);
}

TEST(Shape, MayMeetABoxThatItsSurfaceComesNearTo) {
  const auto around = [](const Imath::V3d& center, double half) {
    return Imath::Box3d(center - Imath::V3d(half), center + Imath::V3d(half));
  };
  for (const Shape& solid : {Shape(Sphere{{1, 0, 0}, 2}), Shape(test::box({-1, -2, -2}, {3, 2, 2}))}) {
    EXPECT_FALSE(may_intersect(solid, around({1.5, 0, 0}, 0.5))) << "wholly within";
    EXPECT_FALSE(may_intersect(solid, around({4, 0, 0}, 0.9))) << "wholly outside";
    EXPECT_TRUE(may_intersect(solid, around({3, 0, 0}, 0.1)));
    EXPECT_TRUE(may_intersect(solid, around({1, 0, 0}, 5))) << "wholly around it";
  }
  EXPECT_TRUE(may_intersect(Quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, around({0.5, 0.5, 0}, 0.1)));
}

}  // namespace
}  // namespace abbe
