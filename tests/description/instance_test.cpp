#include <gtest/gtest.h>

#include "description.h"
#include "scene/shapes/shape.h"
#include "tests/scene/scenes.h"

namespace abbe {
namespace {

using Imath::M44d;
using Imath::V3d;
using Imath::V3f;
using test::Fault;
using test::Loaded;
using test::Random;
using test::scene_of;
using InstanceFileTest = test::DescriptionTest;

// A random affine map: a rotation, scales that differ by up to a factor of 30, possibly a mirror, a rotation
// and a translation.
M44d random_map(Random& random, bool uniform) {
  const auto turn = [&random] { return M44d().setAxisAngle(random.direction(), random.between(0, 6)); };
  const double size = std::pow(10.0, random.between(-2, 2));
  const auto stretch = [&] { return uniform ? size : size * std::pow(30.0, random.between(-0.5, 0.5)); };
  const double mirror = random.uniform() < 0.5F ? -1 : 1;
  const double x = stretch();
  const double y = stretch();
  return turn() * M44d().setScale(V3d(x, y, stretch() * mirror)) * turn() *
         M44d().setTranslation(random.in_cube(3 * size));
}

Shape placed(const PlainShape& shape, const M44d& map) {
  return PlacedShape{make_prototype(shape), std::make_shared<const Placement>(placement(map))};
}

// The same surface without an instance; for spheres and discs the map must preserve angles.
Shape written_out(const PlainShape& shape, const M44d& map) {
  const bool mirror = map.determinant() < 0;
  const double scale = std::cbrt(std::abs(map.determinant()));
  const auto turned = [&map](const V3d& v) {
    V3d moved;
    map.multDirMatrix(v, moved);
    return moved;
  };
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    Mesh moved = *mesh;
    for (V3d& vertex : moved.vertices) vertex *= map;
    if (mirror)
      for (auto& triangle : moved.triangles) std::swap(triangle[1], triangle[2]);
    return moved;
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    return Sphere{sphere->center * map, sphere->radius * scale};
  if (const auto* disc = std::get_if<Disc>(&shape))
    return Disc{disc->center * map, turned(disc->normal).normalized(), disc->radius * scale};
  const auto& quad = std::get<Quad>(shape);
  const V3d u = turned(quad.edge_u);
  const V3d v = turned(quad.edge_v);
  return Quad{quad.corner * map, mirror ? v : u, mirror ? u : v};
}

// A ray around or within a box, the same for both scenes.
Ray ray_near(Random& random, const Imath::Box3d& box) {
  const double size = box.size().length();
  const V3d at = box.center() + random.in_cube(size);
  const V3d towards = box.center() + random.in_cube(size / 3);
  return {V3f(at), V3f((towards - at).normalized())};
}

TEST(Instance, IsTheShapeWrittenOut) {
  Random random(11);
  const std::vector<PlainShape> shapes{make_prism(60, 1.5, 2), Quad{{-1, -1, 0.2}, {2, 0.1, 0}, {0, 2, 0.5}},
                                       Sphere{{0.3, 0.1, 0.2}, 0.7},
                                       Disc{{0.1, 0, 0.2}, V3d(1, 2, 3).normalized(), 0.9}};
  int hits = 0;
  int inside = 0;
  for (int k = 0; k < 200; ++k) {
    const PlainShape& shape = shapes[static_cast<std::size_t>(k) % shapes.size()];
    const M44d map =
        random_map(random, std::holds_alternative<Sphere>(shape) || std::holds_alternative<Disc>(shape));
    const Shape beside = Sphere{V3d(0, 0, 3e4), 1};  // makes the tested shape not the first
    const Shape moved = written_out(shape, map);
    const Imath::Box3d box = bounds(moved);
    const Scene instance = scene_of({beside, placed(shape, map)});
    const Scene plain = scene_of({beside, moved});
    const double size = box.size().length();
    const double near = 1e-5 * (size + box.center().length());
    const Imath::Box3d around = bounds(instance.shapes[1].shape);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(around.min[axis] - box.min[axis], near) << "the bounds hold the shape";
      EXPECT_LE(box.max[axis] - around.max[axis], near);
    }
    for (int i = 0; i < 1000; ++i) {
      const Ray ray = ray_near(random, box);
      const auto a = instance.intersect(ray);
      const auto b = plain.intersect(ray);
      const BasicRay<double> exact_ray{V3d(ray.origin), V3d(ray.direction)};
      const auto exact = intersect_exact(instance, exact_ray, 0);
      const auto truth = intersect_exact(plain, exact_ray, 0);
      ASSERT_EQ(exact.has_value(), truth.has_value()) << k << " " << i;
      EXPECT_EQ(instance.occluded(ray), a.has_value());
      if (a.has_value() != truth.has_value() || b.has_value() != truth.has_value())
        continue;  // grazes an edge
      if (!truth) continue;
      EXPECT_LT((exact->hit.point - truth->hit.point).length(), 1e-11 * near / 1e-5);
      EXPECT_LT((exact->hit.normal - truth->hit.normal).length(), 1e-11);
      if (std::abs(truth->hit.normal.dot(exact_ray.direction)) < 1e-3 || truth->hit.t < 2 * near) continue;
      ++hits;
      inside += a->normal.dot(ray.direction) > 0;
      EXPECT_EQ(a->shape, 1U);
      EXPECT_EQ(exact->shape, 1U);
      EXPECT_NEAR(static_cast<double>(a->t), exact->hit.t, near);
      EXPECT_LT((V3d(a->point) - exact->hit.point).length(), near);
      EXPECT_LT((V3d(a->normal) - exact->hit.normal).length(), 1e-5);
      EXPECT_FALSE(instance.occluded(Ray{ray.origin, ray.direction, a->t - static_cast<float>(near)}));
      EXPECT_TRUE(instance.occluded(Ray{ray.origin, ray.direction, a->t + static_cast<float>(near)}));
    }
  }
  EXPECT_GT(hits, 30000);
  EXPECT_GT(inside, 5000);
}

TEST(Instance, StretchedSphereIsAnEllipsoid) {
  const V3d axes(0.5, 2, 3);
  const Scene scene = scene_of({placed(Sphere{{0, 0, 0}, 1}, M44d().setScale(axes))});
  Random random(12);
  int hits = 0;
  for (int i = 0; i < 10000; ++i) {
    const auto hit = scene.intersect({V3f(random.in_cube(5)), V3f(random.direction())});
    if (!hit) continue;
    ++hits;
    const V3d p(hit->point);
    EXPECT_NEAR((p / axes).length2(), 1, 1e-5);
    EXPECT_LT((V3d(hit->normal) - (p / (axes * axes)).normalized()).length(), 3e-5);
  }
  EXPECT_GT(hits, 500);
}

TEST(Instance, RaysLeavingItNeverMeetItAgain) {
  Random random(13);
  const std::vector<PlainShape> shapes{make_prism(60, 1.5, 2), Sphere{{0.3, 0.1, 0.2}, 0.7}};
  int acne = 0;
  int lost[2] = {0, 0};
  int rays = 0;
  for (int k = 0; k < 400; ++k) {
    const PlainShape& shape = shapes[static_cast<std::size_t>(k) % shapes.size()];
    M44d map = random_map(random, false);
    if (k % 4 < 2)
      map = map * M44d().setTranslation(random.direction() * (30 * std::cbrt(std::abs(map.determinant()))));
    const Scene scene = scene_of({placed(shape, map)});
    for (int i = 0; i < 500; ++i) {
      const auto hit = scene.intersect(ray_near(random, scene.bounds));
      if (!hit) continue;
      V3f out(random.direction());
      if (i % 2 == 0) out = (out - hit->normal * (out.dot(hit->normal) * 0.9999F)).normalized();
      if (out.dot(hit->normal) < 0) out = -out;
      if (out.dot(hit->normal) < 1e-6F) continue;  // rounding decides the side
      ++rays;
      const Ray outward = spawn(hit->point, hit->normal, out, 0);
      acne += scene.intersect(outward).has_value() + scene.occluded(outward);
      lost[k % 2] += !scene.intersect(spawn(hit->point, hit->normal, -out, 0)).has_value();
    }
  }
  EXPECT_GT(rays, 40000);
  EXPECT_EQ(acne, 0);
  EXPECT_LE(lost[0], 4) << "beside an edge of a prism";
  EXPECT_EQ(lost[1], 0) << "within a ball";
}

TEST(Instance, CostsATransformOnly) {
  Random random(14);
  Mesh mesh;
  for (int i = 0; i < 30000; ++i) mesh.vertices.push_back(random.in_cube(1));
  for (std::uint32_t i = 0; i < 30000; i += 3) mesh.triangles.push_back({i, i + 1, i + 2});
  const auto prototype = make_prototype(mesh);
  const auto scene_with = [&](int copies) {
    std::vector<Shape> shapes;
    for (int i = 0; i < copies; ++i)
      shapes.emplace_back(PlacedShape{prototype, std::make_shared<const Placement>(
                                                     placement(M44d().setTranslation(V3d(i * 3.0, 0, 0))))});
    return scene_of(std::move(shapes));
  };
  const Scene one = scene_with(1);
  const Scene many = scene_with(1001);
  EXPECT_EQ(one.triangle_count(), 10000U);
  EXPECT_EQ(many.triangle_count(), 10010000U);
  EXPECT_GT(one.memory_bytes() + 10000 * sizeof(Imath::V3f) + 400000, scene_of({mesh}).memory_bytes())
      << "a prototype is counted like a shape, which has normals besides";
  const std::size_t each = (many.memory_bytes() - one.memory_bytes()) / 1000;
  EXPECT_LT(each, 1500U);
  const auto at = std::make_shared<const Placement>(placement(M44d()));
  const Scene stacked = scene_of(std::vector<Shape>(1001, PlacedShape{prototype, at}));
  EXPECT_GT(many.memory_bytes(), stacked.memory_bytes() + 400 * sizeof(Placement)) << "less by all but one";
  EXPECT_GT(many.bounds.max.x, 3000);
}

constexpr const char* kMaterials =
    R"({"materials": {"glass": {"dielectric": {"ior": "N-BK7"}}, "card": {"diffuse": {"reflectance": 0.5}}},)";

TEST_F(InstanceFileTest, PlacesTheShapesOfObjects) {
  const Loaded loaded = load(std::string(kMaterials) + R"(
    "units": "mm",
    "objects": {"thing": {"shapes": [
      {"sphere": {"center": [1000, 0, 0], "radius": 1}, "material": "glass", "name": "ball"},
      {"prism": {"apex_deg": 60, "side": 2, "length": 3}, "material": "card", "transform": {"translate": [1000, 0, 5]}}]}},
    "shapes": [
      {"instance": {"of": "thing"}, "name": "first"},
      {"instance": {"of": "thing", "transform": [{"scale": [2, 1, -1], "translate": [0, 10, 0]},
                                                 {"matrix": [0, -1, 0, 7, 1, 0, 0, 0, 0, 0, 1, 0]}]}},
      {"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "card"}]})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  const Scene& scene = *loaded.scene;
  ASSERT_EQ(scene.shapes.size(), 5U);
  EXPECT_EQ(scene.shapes[0].name, "first/ball");
  EXPECT_EQ(scene.shapes[3].name, "shape 1/shape 1");
  EXPECT_EQ(scene.materials[scene.shapes[2].material].name, "glass");
  EXPECT_EQ(scene.materials[scene.shapes[3].material].name, "card");
  EXPECT_EQ(scene.triangle_count(), 16U);
  const auto& second = std::get<PlacedShape>(scene.shapes[2].shape);
  EXPECT_EQ(second.of, std::get<PlacedShape>(scene.shapes[0].shape).of);
  EXPECT_EQ(second.at, std::get<PlacedShape>(scene.shapes[3].shape).at);
  EXPECT_LT(second.of->bounds.center().length(), 0.01) << "objects keep their own coordinates small";
  // (1000, 0, 0) is scaled to (2000, 0, 0), translated to (2000, 10, 0), and rotated to (-10 + 7, 2000, 0).
  const V3d middle = second.of->bounds.center() * second.at->to_world + scene.origin_m;
  EXPECT_LT((middle * 1000 - V3d(-3, 2000, 0)).length(), 1e-9);
  // The extent of the ellipsoid follows its scale, and the mirrored prism points down.
  const auto hit = [&](const V3d& origin, const V3d& direction) {
    return intersect_exact(scene, {origin * 1e-3 - scene.origin_m, direction}, 0);
  };
  const auto ball = hit({-3, 1000, 0}, {0, 1, 0});
  ASSERT_TRUE(ball);
  EXPECT_EQ(ball->shape, 2U);
  EXPECT_NEAR(ball->hit.t, 0.998, 1e-12);
  EXPECT_LT((ball->hit.normal - V3d(0, -1, 0)).length(), 1e-12);
  const auto base = hit({-3.01, 2000.01, 0.0}, {0, 0, -1});
  ASSERT_TRUE(base);
  EXPECT_EQ(base->shape, 2U) << "the inside of the ball";
  const auto prism = hit({-3.01, 2000.01, -2}, {0, 0, -1});
  ASSERT_TRUE(prism);
  EXPECT_EQ(prism->shape, 3U);
  EXPECT_LT((prism->hit.normal - V3d(0, 0, 1)).length(), 1e-12) << "outward through a mirror";
}

TEST_F(InstanceFileTest, CountsForTheNeeds) {
  const auto fragment = [](const std::string& material, const std::string& shape) {
    return std::string(kMaterials) + R"("objects": {"o": {"shapes": [{)" + shape + R"(, "material": ")" +
           material +
           R"("}]}}, "lights": [{"point": {"at": [0, 0, 3]}, "emission": {"spectrum": 1}}],
      "shapes": [{"instance": {"of": "o", "transform": {"translate": [0, 0, 1]}}},
                 {"quad": {"corner": [-9, -9, 0], "edge_u": [18, 0, 0], "edge_v": [0, 18, 0]}, "material": "card"}]})";
  };
  const std::string ball = R"("sphere": {"center": [0, 0, 0], "radius": 0.5})";
  const std::string disc = R"("disc": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": 0.5})";
  const Loaded glass = load(fragment("glass", ball));
  EXPECT_TRUE(glass->features.dispersion && glass->features.caustics && glass->features.light_tracing);
  EXPECT_TRUE(glass->features.polarisation_relevant) << "two interfaces of one ball";
  EXPECT_FALSE(load(fragment("glass", disc))->features.polarisation_relevant);
  EXPECT_FALSE(load(fragment("card", ball))->features.caustics);
}

TEST_F(InstanceFileTest, RefusesWhatCannotBePlaced) {
  const auto placed_by = [](const std::string& transform) {
    return std::string(kMaterials) +
           R"("objects": {"ball": {"shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "card"}]}},
              "shapes": [{"instance": {"of": "ball", "transform": )" +
           transform + "}}]}";
  };
  const auto object_of = [](const std::string& shape) {
    return std::string(kMaterials) + R"("objects": {"o": {"shapes": [{)" + shape + "}]}}}";
  };
  const std::string singular = "/shapes/0/instance/transform: error: transform is singular (determinant got ";
  const std::vector<Fault> faults{
      {"a zero scale", placed_by(R"({"scale": [1, 0, 2]})"), ErrorCode::scene,
       "singular (determinant got 0, allowed not 0)"},
      {"dependent rows", placed_by(R"({"matrix": [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0]})"), ErrorCode::scene,
       singular.c_str()},
      {"dependent up to rounding",
       placed_by(R"({"matrix": [0.1, 0.2, 0.3, 0, 0.4, 0.5, 0.6, 0, 0.7, 0.8, 0.9, 0]})"), ErrorCode::scene,
       singular.c_str()},
      {"overflow", placed_by(R"([{"scale": 1e9}, {"scale": 1e9}])"), ErrorCode::scene,
       "transform is out of range (got lengths times"},
      {"underflow", placed_by(R"({"scale": 1e-300})"), ErrorCode::scene, "transform is "},
      {"not affine", placed_by(R"({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2]})"),
       ErrorCode::scene, "a transform must be affine (got the last row [0, 0, 0, 2], allowed [0, 0, 0, 1])"},
      {"13 numbers", placed_by(R"({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0]})"), ErrorCode::scene,
       "(got 13 numbers, allowed 12 or 16)"},
      {"matrix and scale", placed_by(R"({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0], "scale": 2})"),
       ErrorCode::scene, "unknown key \"scale\""},
      {"unknown object",
       std::string(kMaterials) +
           R"("objects": {"ball": {"shapes": []}}, "shapes": [{"instance": {"of": "bal"}}]})",
       ErrorCode::scene, "unknown object \"bal\""},
      {"nothing in it", std::string(kMaterials) + R"("objects": {"ball": {"shapes": []}}})", ErrorCode::scene,
       "expected an array of shapes"},
      {"an instance within", object_of(R"("instance": {"of": "o"})"), ErrorCode::scene,
       "/objects/o/shapes/0/instance: error: an object holds shapes, not instances"},
      {"emission within",
       object_of(
           R"("disc": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1}, "material": "card", "emission": {"spectrum": 1})"),
       ErrorCode::scene, "/objects/o/shapes/0/emission: error: a shape of an object cannot emit"},
      {"a stretched plain shape",
       test::shaped(R"("sphere": {"center": [0, 0, 0], "radius": 1}, "transform": {"scale": [1, 2, 3]})"),
       ErrorCode::scene, "expected a number (got an array"},
      {"no objects", std::string(kMaterials) + R"("objects": []})", ErrorCode::scene,
       "expected an object of objects"},
  };
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.what);
    const Loaded loaded = load(fault.fragment);
    EXPECT_FALSE(loaded.scene);
    EXPECT_EQ(loaded.diagnostics.code(), fault.code);
    EXPECT_NE(loaded.text().find(fault.message), std::string::npos) << loaded.text();
  }
}

}  // namespace
}  // namespace abbe
