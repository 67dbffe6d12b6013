#include "scene/coincident_shapes.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "floor_scenes.h"
#include "meshes.h"
#include "scene/coincidence.h"
#include "scene/shapes/shape.h"

namespace abbe::test {
namespace {

using Imath::V3d;

// The bounds contain the places where media and walls intersect or coincide, and no others.
TEST(Contact, FindsWhereMatterIsAtWalls) {
  const auto near_wall_bounds = [](const Shape& matter, const Shape& wall) {
    Scene scene = floor_scene();
    scene.shapes = {{"wall", wall, kDiffuse}, {"matter", matter, kGlass}};
    scene.commit();
    EXPECT_TRUE(scene.shapes[0].near_wall_bounds.isEmpty()) << "of the wall";
    return scene.shapes[1].near_wall_bounds;
  };
  const auto expect_near = [](const Imath::Box3f& box, const V3d& low, const V3d& high) {
    EXPECT_TRUE(box.min.equalWithAbsError(Imath::V3f(low), 1e-4F)) << box.min;
    EXPECT_TRUE(box.max.equalWithAbsError(Imath::V3f(high), 1e-4F)) << box.max;
  };
  const Mesh block = box({-1, -1, 0}, {1, 1, 1});
  const Quad table{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}};
  const Quad through{{0.5, -3, -3}, {0, 6, 0}, {0, 0, 6}};
  expect_near(near_wall_bounds(block, table), {-1, -1, 0}, {1, 1, 0});
  expect_near(near_wall_bounds(block, through), {0.5, -1, 0}, {0.5, 1, 1});
  expect_near(near_wall_bounds(Sphere{{0, 0, 0.5}, 1}, table), {-1, -1, 0}, {1, 1, 0});
  expect_near(near_wall_bounds(block, Sphere{{0, 0, 1}, 0.5}), {-0.5, -0.5, 0.5}, {0.5, 0.5, 1});
  EXPECT_TRUE(near_wall_bounds(Sphere{{0, 0, 1.001}, 1}, table).isEmpty());
  EXPECT_TRUE(near_wall_bounds(block, box({-3, -3, -1}, {3, 3, 2})).isEmpty()) << "in a room";
  const Quad slanted{{-3, -3, -3}, {6, 0, 0}, {0, 6, 6}};
  EXPECT_FALSE(near_wall_bounds(block, slanted).isEmpty());
  EXPECT_TRUE(near_wall_bounds(Sphere{{0, -1, 1.2}, 1}, slanted).isEmpty()) << "above it, in its box";
}

void add_lamp_surface(Scene& scene, const Shape& shape) {
  scene.lights.push_back({"lamp", AreaLight{static_cast<std::uint32_t>(scene.shapes.size())}, Curve(1.0)});
  scene.shapes.push_back({"lamp", shape, kDiffuse});
}
// The first of two coincident objects: a wall, which precedes the lights as in scene files, or "lamp"; "" for
// none.
std::string lost_on(const std::vector<Shape>& walls, const std::vector<Shape>& lamps,
                    std::uint32_t of_walls = kDiffuse) {
  Scene scene = floor_scene();
  scene.shapes.clear();
  for (const Shape& wall : walls) scene.shapes.push_back({"wall", wall, of_walls});
  for (const Shape& lamp : lamps) add_lamp_surface(scene, lamp);
  scene.commit();
  const auto lost = find_lost_surfaces(scene);
  return lost ? scene.shapes[lost->shape].name : "";
}

TEST(Contact, TellsLampsThatLieOnOpaqueSurfaces) {
  const auto lamp_at = [](double z) { return Quad{{-1, -1, z}, {0, 2, 0}, {2, 0, 0}}; };
  const Quad ceiling{{-2, -2, 0.5}, {0, 4, 0}, {4, 0, 0}};
  const Mesh block = box({-2, -2, 0.5}, {2, 2, 1});
  EXPECT_EQ(lost_on({ceiling}, {lamp_at(0.5)}), "wall");
  EXPECT_EQ(lost_on({ceiling}, {lamp_at(0.5)}, kMirror), "wall");
  EXPECT_EQ(lost_on({block}, {lamp_at(0.5)}), "wall") << "on its backing plate";
  EXPECT_EQ(lost_on({ceiling}, {lamp_at(0.499)}), "");
  EXPECT_EQ(lost_on({block}, {lamp_at(0.5)}, kGlass), "");
  EXPECT_EQ(lost_on({Quad{{1, -2, 0.5}, {0, 4, 0}, {4, 0, 0}}}, {lamp_at(0.5)}), "") << "in an opening";
  const auto turned = [](const Quad& quad) {
    const Imath::M44d turn = Imath::M44d().setAxisAngle(V3d(1, 2, 3).normalized(), 0.6);
    return Quad{quad.corner * turn, quad.edge_u * turn, quad.edge_v * turn};
  };
  EXPECT_EQ(lost_on({turned(ceiling)}, {turned(lamp_at(0.5))}), "wall");
  EXPECT_EQ(lost_on({turned(ceiling)}, {turned(lamp_at(0.499))}), "");
}

TEST(Contact, TellsLampsThatLieOnLamps) {
  const Quad down{{-1, -1, 0.5}, {0, 2, 0}, {2, 0, 0}};
  const Quad up{{-1, -1, 0.5}, {2, 0, 0}, {0, 2, 0}};
  const Disc disc{{0, 0, 0.5}, {0, 0, -1}, 1};
  EXPECT_EQ(lost_on({}, {down, up}), "lamp") << "back to back";
  EXPECT_EQ(lost_on({}, {disc, disc}), "lamp") << "listed twice";
  EXPECT_EQ(lost_on({}, {down}), "");
  EXPECT_EQ(lost_on({}, {down, Quad{{1, -1, 0.5}, {0, 2, 0}, {2, 0, 0}}}), "") << "side by side";
  EXPECT_EQ(lost_on({}, {box({-1, -1, 0}, {1, 1, 1})}), "");
  EXPECT_EQ(lost_on({}, {icosphere(4, false)}), "");
}

// Coincident faces of closed lights and their supports that face each other are invisible.
TEST(Contact, ClosedLampsLoseNothingBetweenThemAndWhatTheyTouch) {
  const Mesh lamp = box({-1, -1, 0}, {1, 1, 1});
  const Mesh socket = box({-1, -1, -1}, {1, 1, 0});
  const Mesh block = box({-2, -2, -2}, {2, 2, 1});
  const Quad ceiling{{-2, -2, 1}, {0, 4, 0}, {4, 0, 0}};
  const Quad below{{-2, -2, 0}, {0, 4, 0}, {4, 0, 0}};
  EXPECT_EQ(lost_on({socket}, {lamp}), "");
  EXPECT_EQ(lost_on({box({-2, -2, -1}, {2, 2, 0})}, {lamp}), "") << "a table";
  EXPECT_EQ(lost_on({inside_out(box({-3, -3, 0}, {3, 3, 1}))}, {lamp}), "") << "a room";
  EXPECT_EQ(lost_on({}, {lamp, box({1, -1, 0}, {3, 1, 1})}), "") << "side by side";
  EXPECT_EQ(lost_on({ceiling}, {lamp}), "");
  EXPECT_EQ(lost_on({block}, {lamp}), "wall") << "let into it";
  EXPECT_EQ(lost_on({below}, {lamp}), "wall") << "above a ceiling without an opening";
  EXPECT_EQ(lost_on({}, {lamp, lamp}), "lamp") << "listed twice";
  Mesh open = lamp;
  open.triangles.erase(open.triangles.begin());
  EXPECT_EQ(lost_on({socket}, {open}), "wall");
  EXPECT_EQ(lost_on({socket}, {inside_out(lamp)}), "wall");
  const Imath::M44d mirror = Imath::M44d().setScale(V3d(-1, 1, 1));
  EXPECT_EQ(lost_on({placed(socket, mirror)}, {lamp}), "");
  EXPECT_EQ(lost_on({placed(block, mirror)}, {lamp}), "wall");
}

TEST(Contact, AClosedLampThatShinesInwardTooLosesLight) {
  Scene scene = floor_scene();
  scene.shapes = {{"wall", box({-1, -1, -1}, {1, 1, 0}), kDiffuse}};
  add_lamp_surface(scene, box({-1, -1, 0}, {1, 1, 1}));
  scene.commit();
  EXPECT_FALSE(find_lost_surfaces(scene));
  std::get<AreaLight>(scene.lights[0].kind).two_sided = true;
  scene.commit();
  EXPECT_TRUE(find_lost_surfaces(scene));
}

TEST(Contact, LampsThatTouchAlongAnEdgeOrAtAPointLoseNothing) {
  const Quad ceiling{{-2, -2, 0.5}, {0, 4, 0}, {4, 0, 0}};
  const auto hinged = [](double down) { return Quad{{-1, -1, 0.5}, {0, 2, 0}, {2, 0, -down}}; };
  EXPECT_EQ(lost_on({ceiling}, {hinged(0.07)}), "") << "by 2 degrees";
  EXPECT_EQ(lost_on({ceiling}, {hinged(0.001)}), "");
  EXPECT_EQ(lost_on({ceiling}, {hinged(1e-8)}), "wall");
  Mesh pyramid;
  pyramid.vertices = {{0, 0, 0.5}, {0.5, 0, 0.49}, {0, 0.5, 0.49}, {-0.5, 0, 0.49}, {0, -0.5, 0.49}};
  pyramid.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  EXPECT_EQ(lost_on({ceiling}, {pyramid}), "");
}

TEST(Contact, TellsBallsAtOnePlace) {
  const Sphere ball{{0.1, 0.2, 0.3}, 2};
  const Sphere beside{{0.101, 0.2, 0.3}, 2};
  const Sphere larger{{0.1, 0.2, 0.3}, 2.001};
  EXPECT_EQ(lost_on({ball}, {ball}), "wall");
  EXPECT_EQ(lost_on({}, {ball, ball}), "lamp") << "listed twice";
  EXPECT_EQ(lost_on({}, {ball}), "");
  for (const Sphere& apart : {beside, larger}) EXPECT_EQ(lost_on({apart}, {ball}), "");
  const Imath::M44d larger_by_half = Imath::M44d().setScale(1.5);
  EXPECT_EQ(lost_on({placed(ball, larger_by_half)}, {Sphere{ball.center * 1.5, 3}}), "wall");
  EXPECT_EQ(lost_on({placed(ball, larger_by_half)}, {ball}), "");
}

// The shape on which a body of glass without thickness lies; "" for none.
std::string coat_lost_on(const Shape& body, const Shape& glass, std::uint32_t material = kGlass) {
  Scene scene = floor_scene();
  scene.shapes = {{"body", body, kDiffuse}, {"glass", glass, material}};
  scene.commit();
  const auto lost = find_lost_surfaces(scene);
  return lost ? scene.shapes[lost->shape].name : "";
}

TEST(Contact, FindsGlassWithoutThicknessOnOpaqueBodies) {
  const Sphere ball{{0.1, 0.2, 0.3}, 1};
  EXPECT_EQ(coat_lost_on(ball, ball), "body");
  EXPECT_EQ(coat_lost_on(ball, placed(Sphere{{0, 0, 0}, 0.5},
                                      Imath::M44d().setScale(2) * Imath::M44d().setTranslation(ball.center))),
            "body");
  EXPECT_EQ(coat_lost_on(ball, ball, kMirror), "") << "no medium";
  EXPECT_EQ(coat_lost_on(ball, Sphere{ball.center, 1.001}), "");
  EXPECT_EQ(coat_lost_on(ball, Sphere{{0.101, 0.2, 0.3}, 1}), "");
  const Mesh block = box({-1, -1, 0}, {1, 1, 1});
  EXPECT_EQ(coat_lost_on(block, block), "body");
  EXPECT_EQ(coat_lost_on(block, box({-1, -1, 0}, {1, 1, 1.1})), "") << "its sides alone lie on it";
  EXPECT_EQ(coat_lost_on(block, box({-2, -2, 0}, {2, 2, 2})), "") << "a candle in glass";
  EXPECT_EQ(coat_lost_on(block, box({-1, -1, 1}, {1, 1, 2})), "") << "glass on a table";
  EXPECT_EQ(coat_lost_on(inside_out(block), block), "") << "glass that fills a room";
}

// True if a probe at x = `at` that looks along -x lies on a light.
bool lies_on_light(double at, const Shape& light, double looks = -1, bool two_sided = false) {
  Scene scene = lit_by(light, two_sided);
  scene.camera = {IrradianceProbe{ProbePoint{{at, 0, 0}, {looks, 0, 0}}}, 1, 1, 1};
  scene.commit();
  return find_light_on_probe(scene).has_value();
}

TEST(Contact, FindsMetersOnLightsThatTheyFace) {
  const Sphere bulb{{0, 0, 0}, 1};
  for (const double at : {1.0, 1 + 1e-7, 1 + 3e-7}) EXPECT_TRUE(lies_on_light(at, bulb)) << at;
  for (const double at : {1 + 1e-6, 1.1}) EXPECT_FALSE(lies_on_light(at, bulb)) << at;
  EXPECT_FALSE(lies_on_light(1, bulb, 1)) << "it looks away";
  const Quad panel{{1, -1, -1}, {0, 2, 0}, {0, 0, 2}};
  EXPECT_TRUE(lies_on_light(1, panel));
  EXPECT_FALSE(lies_on_light(1, panel, 1)) << "it looks away";
  EXPECT_FALSE(lies_on_light(1.001, panel));
  EXPECT_TRUE(lies_on_light(1, panel, 1, true)) << "which emits to both sides";
}

// A disc extends to 1 from its center, and its bounding square to 1.41.
TEST(Contact, ADiscCoversNoCornersOfTheSquareAroundIt) {
  const Disc disc{{0, 0, 0.5}, {0, 0, -1}, 1};
  const auto wall_from = [](double corner) { return Quad{{corner, corner, 0.5}, {0, 4, 0}, {4, 0, 0}}; };
  EXPECT_EQ(lost_on({wall_from(0.8)}, {disc}), "");
  EXPECT_EQ(lost_on({wall_from(0.4)}, {disc}), "wall");
}

TEST(Contact, LampsThatAreDarkOrMoveLoseNothing) {
  const Quad wall{{-2, -2, 0.5}, {0, 4, 0}, {4, 0, 0}};
  const auto is_lost = [&](const Shape& lamp, double emission) {
    Scene scene = floor_scene();
    scene.shapes = {{"wall", wall, kDiffuse}};
    add_lamp_surface(scene, lamp);
    scene.lights[0].emission = Curve(emission);
    scene.commit();
    return find_lost_surfaces(scene).has_value();
  };
  auto moving = std::make_shared<Placement>(placement(Imath::M44d()));
  moving->motion = std::make_shared<Motion>(
      std::vector<Motion::Keyframe>{{0, {0, 0, 0}, 0, {0, 0, 0}}, {1, {0, 0, 0}, 0, {0, 0, -1}}});
  EXPECT_TRUE(is_lost(wall, 1));
  EXPECT_FALSE(is_lost(wall, 0));
  EXPECT_FALSE(is_lost(PlacedShape{make_prototype(wall), moving}, 1));
}

TEST(Contact, FindsALampAmongThousands) {
  Scene scene = floor_scene();
  scene.shapes = {{"hall", box({-31, -31, 0}, {31, 31, 3}), kDiffuse}};
  for (int y = -30; y < 30; ++y)
    for (int x = -30; x < 30; ++x)
      add_lamp_surface(scene, Quad{V3d(x, y, x == 4 && y == -10 ? 3 : 2.99), {0, 0.5, 0}, {0.5, 0, 0}});
  scene.commit();
  const auto lost = find_lost_surfaces(scene);
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->shape, 0U);
  EXPECT_EQ(lost->on, 1235U);
  EXPECT_EQ(lost->others, 0U);
}

TEST(FaceFinder, FindsAllThatMeetABox) {
  Random random(7);
  Mesh mesh;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const V3d at = random.in_cube(1) + V3d(2e-3 * i, 0, 0);  // consecutive points are near each other
    for (int corner = 0; corner < 3; ++corner) mesh.vertices.push_back(at + random.in_cube(0.1));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Imath::M44d turned = Imath::M44d().setAxisAngle(V3d(1, 2, 3).normalized(), 0.6);
  const Shape plain = mesh;
  const Shape placed = PlacedShape{make_prototype(mesh), std::make_shared<Placement>(placement(turned))};
  FaceFinder finder;
  for (int i = 0; i < 100; ++i) {
    Imath::Box3d box(random.in_cube(2));
    box.extendBy(box.min + random.in_cube(0.3));
    for (const auto& [shape, to_world] : {std::pair(&plain, Imath::M44d()), std::pair(&placed, turned)}) {
      std::size_t expected = 0;
      for (const auto& triangle : mesh.triangles) {
        Imath::Box3d around;
        for (const std::uint32_t vertex : triangle) around.extendBy(mesh.vertices[vertex] * to_world);
        expected += around.intersects(box);
      }
      EXPECT_EQ(finder.near(*shape, box).size(), expected);
    }
  }
}

}  // namespace
}  // namespace abbe::test
