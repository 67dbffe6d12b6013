#include <cfenv>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "scene/shapes/shape.h"
#include "scenes.h"
#include "tests/scene/expect_near.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;
using test::expect_near;
using test::Random;
using test::scene_of;

// A closed sphere of triangles that face outward.
Mesh globe(double radius, int rings, int sectors) {
  Mesh mesh;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double theta = std::numbers::pi * i / rings;
      const double phi = 2 * std::numbers::pi * j / sectors;
      const double ring = i == 0 || i == rings ? 0.0 : std::sin(theta);
      mesh.vertices.push_back(V3d(ring * std::cos(phi), ring * std::sin(phi), std::cos(theta)) * radius);
    }
  const auto at = [sectors](int i, int j) { return static_cast<std::uint32_t>(i * sectors + j % sectors); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i < rings - 1) mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

template <typename T>
class ShapeTest : public ::testing::Test {
 public:
  using Ray = BasicRay<T>;
  using V = Imath::Vec3<T>;
  static constexpr double kTolerance = std::is_same_v<T, double> ? 1e-14 : 1e-6;
  static auto hit(const Shape& shape, const V& origin, const V& direction, T t_min = 0) {
    return intersect<T>(shape, Ray{origin, direction}, t_min);
  }
};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(ShapeTest, Scalars);

TYPED_TEST(ShapeTest, SphereIsMetWhereItIs) {
  using V = typename TestFixture::V;
  const Shape sphere = Sphere{{1, 0, 0}, 0.5};
  const auto near = this->hit(sphere, V(1, 0, -2), V(0, 0, 1));
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->t, 1.5, this->kTolerance);
  expect_near(near->point, V(1, 0, TypeParam(-0.5)), this->kTolerance);
  expect_near(near->normal, V(0, 0, -1), this->kTolerance);
  const auto far = this->hit(sphere, V(1, 0, -2), V(0, 0, 1), TypeParam(1.6));
  ASSERT_TRUE(far);
  EXPECT_NEAR(far->t, 2.5, this->kTolerance);
  expect_near(far->normal, V(0, 0, 1), this->kTolerance);
  EXPECT_FALSE(this->hit(sphere, V(1, TypeParam(0.51), -2), V(0, 0, 1)));
  EXPECT_FALSE(this->hit(sphere, V(1, 0, 2), V(0, 0, 1)));
  EXPECT_NEAR(this->hit(sphere, V(1, 0, -2), V(0, 0, 2))->t, 0.75, this->kTolerance)
      << "direction of length 2";
}

TYPED_TEST(ShapeTest, FlatShapesAreMetWhereTheyAre) {
  using V = typename TestFixture::V;
  const Shape disc = Disc{{0, 0, 1}, {0, 0, -1}, 0.5};
  const Shape quad = Quad{{-1, -1, 1}, {0, 2, 0}, {2, 0, 0}};
  const Shape mesh = Mesh{{{-1, -1, 1}, {0, 2, 1}, {1, -1, 1}}, {{0, 1, 2}}};
  const TypeParam slant = TypeParam(0.3);
  const V direction = V(slant, 0, 1).normalized();
  for (const Shape* shape : {&disc, &quad, &mesh}) {
    const auto hit = this->hit(*shape, V(0, 0, 0), direction);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, std::sqrt(1.09), 2 * this->kTolerance);
    expect_near(hit->point, V(slant, 0, 1), this->kTolerance);
    expect_near(hit->normal, V(0, 0, -1), this->kTolerance);
    EXPECT_FALSE(this->hit(*shape, V(0, 0, 0), direction, TypeParam(1.1)));
    EXPECT_FALSE(intersect<TypeParam>(*shape, {V(0, 0, 0), direction, TypeParam(1.0)}, 0));
    EXPECT_FALSE(this->hit(*shape, V(2, 0, 0), V(0, 0, 1)));
  }
  EXPECT_FALSE(this->hit(disc, V(0, TypeParam(0.51), 0), V(0, 0, 1)));
  EXPECT_TRUE(this->hit(quad, V(TypeParam(0.99), TypeParam(-0.99), 0), V(0, 0, 1)));
  EXPECT_FALSE(this->hit(mesh, V(TypeParam(0.9), TypeParam(0.9), 0), V(0, 0, 1)));
}

// Detected before any division by zero.
TYPED_TEST(ShapeTest, NothingIsMetAlongAFlatShapeNorWhereThereIsNone) {
  using V = typename TestFixture::V;
  using Ray = typename TestFixture::Ray;
  const V a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  std::feclearexcept(FE_ALL_EXCEPT);
  for (const TypeParam height : {TypeParam(-1), TypeParam(0), TypeParam(1)}) {
    const Ray along{V(-1, TypeParam(0.25), height), V(1, 0, 0)};
    EXPECT_FALSE(intersect_triangle(a, b, c, along));
    EXPECT_FALSE(intersect(Disc{V3d(0), V3d(0, 0, 1), 1}, along, TypeParam(0)));
    EXPECT_FALSE(intersect(Quad{V3d(0), V3d(1, 0, 0), V3d(0, 1, 0)}, along, TypeParam(0)));
  }
  for (const V& corner : {a, b, V(2, 0, 0)})
    EXPECT_FALSE(intersect_triangle(a, b, corner, Ray{V(TypeParam(0.5), 0, 1), V(0, 0, -1)}));
  EXPECT_EQ(std::fetestexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW), 0);
}

TEST(Shape, FarAndLargeSpheresKeepTheirDigits) {
  Random random(1);
  for (const double radius : {1e-4, 1.0, 1e6})
    for (int i = 0; i < 1000; ++i) {
      const V3d center = random.in_cube(radius);
      const V3d origin = center + random.direction() * (1e6 * radius);
      const V3d target = center + random.direction() * (0.99 * radius);
      const V3d direction = (target - origin).normalized();
      const auto hit = intersect<double>(Sphere{center, radius}, {origin, direction}, 0);
      ASSERT_TRUE(hit);
      EXPECT_NEAR((hit->point - center).length() / radius, 1, 1e-14);
      EXPECT_LT((hit->point - origin).cross(direction).length() / radius, 2e-8) << "off the ray";
    }
}

TEST(Shape, SharedEdgesOfAMeshAreMet) {
  const Shape prism = make_prism(60, 0.03, 0.04);
  const BasicRay<double> through_diagonal{{-1, 0, 0.0037}, {1, 0, 0}};
  const auto enter = intersect(prism, through_diagonal, 0.0);
  ASSERT_TRUE(enter);
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    // Any point of the diagonal that splits the face, seen from any point in front.
    const auto& mesh = std::get<Mesh>(prism);
    const double s = random.between(0.01, 0.99);
    const V3d target = mesh.vertices[1] * (1 - s) + mesh.vertices[5] * s;
    const V3d origin = target + V3d(1, 0, 0.577) + random.in_cube(0.4);
    ASSERT_TRUE(intersect(prism, BasicRay<double>{origin, target - origin}, 0.0)) << i;
  }
}

TEST(Shape, PrismIsClosedAndHasItsAngles) {
  const double apex_deg = 60;
  const double side = 0.03;
  const double length = 0.04;
  const Mesh prism = make_prism(apex_deg, side, length);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0;
  for (const auto& [a, b, c] : prism.triangles) {
    ++edges[{a, b}], ++edges[{b, c}], ++edges[{c, a}];
    volume += prism.vertices[a].dot(prism.vertices[b].cross(prism.vertices[c])) / 6;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U);
  }
  const double base_area = side * side * std::sin(apex_deg * std::numbers::pi / 180) / 2;
  EXPECT_NEAR(volume, base_area * length, 1e-18);
  EXPECT_NEAR(area(prism), 2 * base_area + 3 * side * length, 1e-15);

  // The axis has equal distances to the three faces, and the two equal faces enclose the apex angle.
  const double inradius = side * std::sqrt(3.0) / 6;
  const auto right = intersect<double>(prism, {{0, 0, 0}, V3d(1, 0, 0.5).normalized()}, 0);
  const auto down = intersect<double>(prism, {{0, 0, 0}, {0, 0, -1}}, 0);
  ASSERT_TRUE(right && down);
  EXPECT_NEAR(down->t, inradius, 1e-15);
  EXPECT_NEAR(right->point.dot(right->normal), inradius, 1e-15);
  EXPECT_NEAR(right->normal.x, std::cos(apex_deg / 2 * std::numbers::pi / 180), 1e-14);
  EXPECT_NEAR(bounds(prism).max.z, side * std::sqrt(3.0) / 3, 1e-15);
}

TEST(Shape, AreaSamplesAreUniform) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0, 2}, {5, 0, 2}, {3, 0, 5}}, {{0, 1, 2}, {3, 4, 5}}};
  const struct {
    Shape shape;
    double area;
    V3d centroid;
  } cases[] = {{Sphere{{1, 2, 3}, 2}, 16 * std::numbers::pi, {1, 2, 3}},
               {Disc{{1, 2, 3}, V3d(1, 2, -2).normalized(), 2}, 4 * std::numbers::pi, {1, 2, 3}},
               {Quad{{0, 0, 1}, {2, 0, 0}, {1, 3, 0}}, 6, {1.5, 1.5, 1}},
               {mesh, 3.5, (V3d(1, 1, 0) / 3 * 0.5 + V3d(11, 0, 9) / 3 * 3) / 3.5}};
  for (const auto& [shape, expected_area, centroid] : cases) {
    EXPECT_NEAR(area(shape), expected_area, 1e-12);
    const std::vector<float> cdf = triangle_cdf(shape);
    V3d mean(0);
    constexpr int kSide = 200;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const SurfacePoint at = sample_area(
            shape, cdf, {(static_cast<float>(i) + 0.5F) / kSide, (static_cast<float>(j) + 0.5F) / kSide});
        mean += V3d(at.point);
        EXPECT_NEAR(at.normal.length(), 1, 1e-6);
        const V3d above = V3d(at.point) + V3d(at.normal) * 0.01;
        const auto hit = intersect<double>(shape, {above, -V3d(at.normal)}, 0);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->t, 0.01, 1e-5);
      }
    expect_near(mean / (kSide * kSide), centroid, 1.2e-2);
  }
  EXPECT_NEAR(triangle_cdf(mesh)[0], 0.5 / 3.5, 1e-7);
  EXPECT_EQ(triangle_cdf(mesh)[1], 1.0F);
}

// The direction rotated almost into the surface.
V3f grazing(const V3f& direction, const V3f& normal) {
  return (direction - normal * (direction.dot(normal) * 0.9999F)).normalized();
}

TEST(SceneIntersection, AgreesWithTheExactOne) {
  const Mesh mesh = globe(0.7, 8, 12);
  const Scene scene =
      scene_of({mesh, Sphere{{2, 0.3, 0}, 0.9}, Disc{{-1.5, 0, 0.5}, V3d(1, 2, 3).normalized(), 0.8},
                Quad{{-2, -2, -1.5}, {4, 0.2, 0}, {0, 4, 1}}});
  Random random(3);
  int hits = 0;
  for (int i = 0; i < 100000; ++i) {
    const Ray ray{V3f(random.in_cube(3)), V3f(random.direction())};
    const auto fast = scene.intersect(ray);
    const auto exact = intersect_exact(scene, {V3d(ray.origin), V3d(ray.direction)}, 0);
    if (fast.has_value() != exact.has_value() || (fast && fast->shape != exact->shape))
      continue;  // grazes an edge
    if (!fast) continue;
    ++hits;
    EXPECT_NEAR(fast->t, exact->hit.t, 1e-5);
    expect_near(V3d(fast->point), exact->hit.point, 1e-5);
    expect_near(V3d(fast->normal), exact->hit.normal, 1e-6);
    EXPECT_TRUE(scene.occluded(ray));
    EXPECT_FALSE(scene.occluded(Ray{ray.origin, ray.direction, fast->t * (1 - 1e-5F)}));
    EXPECT_FALSE(scene.intersect({ray.origin, ray.direction, fast->t * (1 - 1e-5F)}));
    if (fast->t < 0.05F || std::abs(fast->normal.dot(ray.direction)) < 0.01F) continue;  // within rounding
    EXPECT_FALSE(scene.occluded(ray.origin, ray.origin + ray.direction * (fast->t * (1 - 1e-3F))));
    EXPECT_TRUE(scene.occluded(ray.origin, ray.origin + ray.direction * (fast->t * (1 + 1e-3F))));
  }
  EXPECT_GT(hits, 15000);
}

// Meshes of small and of large triangles, alone and as an instance, with centers at up to 1e5 along any axis.
TEST(SceneIntersection, MeshesFarFromTheOriginAreMetWhereTheyAre) {
  Random random(10);
  for (const double far : {500.0, 1500.0, 2e4, 1e5})
    for (const double size : {1.0, 0.2 * far})
      for (const V3d& along :
           {V3d(1, 0, 0), V3d(-1, 0, 0), V3d(0, 1, 0), V3d(0, 0, -1), V3d(-0.6, 0.48, 0.64)}) {
        const V3d center = along * far;
        Mesh moved = globe(size, 12, 24);
        for (V3d& vertex : moved.vertices) vertex += center;
        const Shape placed =
            PlacedShape{make_prototype(globe(size, 12, 24)),
                        std::make_shared<Placement>(placement(Imath::M44d().setTranslation(center)))};
        for (const Shape& shape : {Shape(moved), placed}) {
          const Scene scene = scene_of({shape});
          for (int i = 0; i < 100; ++i) {
            const V3f origin(center + random.direction() * (3 * size));
            const V3f direction = (V3f(center + random.direction() * (0.9 * size)) - origin).normalized();
            const auto exact = intersect_exact(scene, {V3d(origin), V3d(direction)}, 0);
            ASSERT_TRUE(exact) << far << ' ' << size;
            const Ray ray{origin, direction};
            const auto hit = scene.intersect(ray);
            ASSERT_TRUE(hit) << far << ' ' << size;
            const double rounding = 4e-7 * (far + 3 * size);  // of single-precision coordinates
            EXPECT_NEAR(hit->t, exact->hit.t, 20 * rounding) << far << ' ' << size;
            expect_near(V3d(hit->point), exact->hit.point, 20 * rounding);
            EXPECT_TRUE(scene.occluded(ray)) << far << ' ' << size;
            EXPECT_TRUE(scene.occluded(origin, V3f(center))) << far << ' ' << size;
          }
        }
      }
}

TEST(SceneIntersection, RaysLeavingASphereNeverMeetItAgain) {
  Random random(4);
  int acne = 0;
  int lost = 0;
  int rays = 0;
  for (double radius = 1e-4; radius < 2e6; radius *= 10)
    for (const double offset : {0.0, 1.0, 30.0}) {
      const V3d center = random.direction() * (offset * radius);
      const Scene scene = scene_of({Sphere{center, radius}});
      for (int i = 0; i < 17000; ++i) {
        const V3d origin = center + random.direction() * (radius * random.between(1.5, 10));
        const V3d target = center + random.direction() * (radius * random.between(0, 0.999));
        const auto hit = scene.intersect({V3f(origin), V3f((target - origin).normalized())});
        if (!hit) continue;
        V3f out(random.direction());
        if (i % 2 == 0) out = grazing(out, hit->normal);
        if (out.dot(hit->normal) < 0) out = -out;
        if (out.dot(hit->normal) < 1e-7F) continue;  // rounding decides the side
        rays += 2;
        acne += scene.intersect(spawn(hit->point, hit->normal, out, 0)).has_value();
        acne += scene.occluded(spawn(hit->point, hit->normal, out, 0));
        const Ray inward = spawn(hit->point, hit->normal, -out, 0);
        lost += !scene.intersect(inward).has_value();
      }
    }
  EXPECT_GT(rays, 1000000);
  EXPECT_EQ(acne, 0);
  EXPECT_EQ(lost, 0);
}

TEST(SceneIntersection, RaysLeavingATriangleNeverMeetItAgain) {
  Random random(5);
  int acne = 0;
  int rays = 0;
  for (int k = 0; k < 2000; ++k) {
    const double size = std::pow(10.0, random.between(-4, 4));
    const V3d center = random.direction() * (size * (k % 3 == 0 ? 0.0 : random.between(0, 100)));
    const Mesh mesh{
        {center + random.in_cube(size), center + random.in_cube(size), center + random.in_cube(size)},
        {{0, 1, 2}}};
    const Scene scene = scene_of({mesh});
    for (int i = 0; i < 250; ++i) {
      const std::vector<float> whole{1.0F};
      const V3d target(sample_area(mesh, whole, random.pair()).point);
      const V3d origin = target + random.direction() * size;
      const auto hit = scene.intersect({V3f(origin), V3f((target - origin).normalized())});
      if (!hit) continue;
      V3f out(random.direction());
      if (i % 2 == 0) out = grazing(out, hit->normal);
      const Ray ray = spawn(hit->point, hit->normal, out, 0);
      rays += 2;
      acne += scene.intersect(ray).has_value();
      acne += scene.occluded(ray);
      EXPECT_LE((ray.origin - hit->point).length(), 1e-6F * std::max(hit->point.length(), 2e-4F));
    }
  }
  EXPECT_GT(rays, 900000);
  EXPECT_EQ(acne, 0);
}

// Scenes of micrometres and of kilometres, scaled by powers of two without rounding, so that rays start in
// the same medium.
TEST(SceneIntersection, RaysStartAsFarOffAsTheSizeOfTheSceneSays) {
  Random random(9);
  for (const float scale : {0x1p-20F, 0x1p-10F, 0x1p10F, 0x1p20F})
    for (int i = 0; i < 1000; ++i) {
      const V3f point(random.direction());
      const V3f normal(random.direction());
      const V3f out(random.direction());
      EXPECT_EQ(offset_point(point * scale, normal, out), offset_point(point, normal, out) * scale);
    }
}

TEST(SceneIntersection, ShadowRaysSeeWhatTheyEndOn) {
  // A light at the far end of a large room: points on it are far more precise than the path to it.
  Random random(6);
  const Quad floor{{-40, -40, -3}, {80, 1, 0}, {0, 80, 2}};
  const std::vector<Shape> lamps = {Quad{{-0.5, -0.6, -0.1}, {1.2, 0, 0.2}, {0, 1.1, 0.1}},
                                    Disc{{0.01, 0.02, 0}, V3d(0.1, 0.2, -1).normalized(), 0.5},
                                    Sphere{{0, 0, 0.1}, 0.1}, globe(0.3, 6, 8)};
  for (const Shape& lamp : lamps) {
    const bool convex = std::holds_alternative<Sphere>(lamp) || std::holds_alternative<Mesh>(lamp);
    const Scene scene = scene_of({floor, lamp});
    const Scene screened = scene_of({floor, lamp, Quad{{-90, -90, -0.45}, {180, 0, 0}, {0, 180, 0}}});
    const std::vector<float> cdf = triangle_cdf(lamp);
    int shadowed = 0;
    int pairs = 0;
    for (int i = 0; i < 50000; ++i) {
      const SurfacePoint below = sample_area(floor, {}, random.pair());
      const SurfacePoint above = sample_area(lamp, cdf, random.pair());
      const V3f wi = (above.point - below.point).normalized();
      // the far side, or the crease between two triangles
      if (convex && wi.dot(above.normal) > -1e-5F) continue;
      const V3f from = offset_point(below.point, below.normal, wi);
      const V3f to = offset_point(above.point, above.normal, -wi);
      ++pairs;
      shadowed += scene.occluded(from, to);
      EXPECT_TRUE(screened.occluded(from, to));
    }
    EXPECT_GT(pairs, 10000);
    EXPECT_EQ(shadowed, 0) << lamp.index();
  }
}

TEST(SceneIntersection, NothingEscapesFromAClosedMesh) {
  Random random(7);
  for (const Mesh& mesh : {globe(1.0, 40, 80), make_prism(60, 1.5, 2)}) {
    const Scene scene = scene_of({mesh});
    int escaped = 0;
    for (int i = 0; i < 500000; ++i)
      escaped += !scene.intersect({V3f(random.in_cube(0.2)), V3f(random.direction())}).has_value();
    EXPECT_EQ(escaped, 0);
  }
}

TEST(SceneIntersection, NothingEscapesWhileBouncing) {
  Random random(8);
  const Scene scene = scene_of({make_prism(60, 1.5, 2), Sphere{{0, 0, 0}, 50}});
  int escaped = 0;
  for (int k = 0; k < 1000; ++k) {
    Ray ray{V3f(random.in_cube(0.2)), V3f(random.direction())};
    for (int i = 0; i < 200; ++i) {
      const auto hit = scene.intersect(ray);
      ASSERT_TRUE(hit);
      if (hit->shape != 0) {
        ++escaped;
        break;
      }
      V3f in(random.direction());
      if (in.dot(hit->normal) > 0) in = -in;
      ray = spawn(hit->point, hit->normal, in, 0);
    }
  }
  EXPECT_LE(escaped, 1);
}

TEST(Scene, CommitSurvivesBrokenTriangles) {
  const Mesh broken{{{0, 0, 0}, {1, 0, 0}, {NAN, 1, 0}, {2, 0, 0}, {0, 1, 0}},
                    {{0, 1, 2}, {0, 1, 3}, {0, 0, 0}, {0, 1, 4}}};
  const Scene scene = scene_of({broken});
  const auto hit = scene.intersect({{0.25F, 0.25F, 1}, {0, 0, -1}});
  ASSERT_TRUE(hit) << "the sound triangle is there";
  EXPECT_EQ(hit->normal, V3f(0, 0, 1));
  EXPECT_FALSE(scene_of({}).intersect({{0, 0, 0}, {0, 0, 1}}));
}

TEST(Scene, CommitFillsWhatItPromises) {
  Scene scene = test::lit_by(Quad{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}});
  EXPECT_EQ(scene.background().size(), 0U);
  EXPECT_EQ(scene.shapes[0].light, 0);
  EXPECT_NEAR(std::get<AreaLight>(scene.lights[0].kind).area, 6, 1e-12);
  EXPECT_EQ(scene.triangle_count(), 2U);
  EXPECT_EQ(scene.bounds.max, V3d(2, 3, 0));
  EXPECT_GT(scene.memory_bytes(), 500U);
  scene.lights.push_back({"sky", EnvironmentLight{}, Curve(1.0)});
  scene.commit();
  ASSERT_EQ(scene.background().size(), 1U);
  EXPECT_EQ(scene.background()[0], 1U);
  const Scene large = scene_of({globe(1, 100, 100)});
  EXPECT_EQ(large.triangle_count(), 2U * 99 * 100);
  EXPECT_GT(large.memory_bytes(), large.triangle_count() * 50);
}

}  // namespace
}  // namespace abbe
