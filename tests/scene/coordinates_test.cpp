#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "scene/scene.h"
#include "scene/shapes/shape.h"
#include "scenes.h"
#include "tests/scene/expect_near.h"

namespace abbe {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using test::expect_near;
using test::Random;

constexpr double kTight = 1e-12;

// The tangents are the derivatives of the position that `point_at` assigns to (u, v).
template <typename PointAt>
void expect_coordinates(const Shape& shape, const V2d& uv, const PointAt& point_at,
                        std::size_t triangle = 0) {
  constexpr double kStep = 1e-6;
  const SurfaceCoordinates at = coordinates(shape, point_at(uv.x, uv.y), triangle, 0);
  expect_near(at.uv, uv, kTight);
  const V3d du = (point_at(uv.x + kStep, uv.y) - point_at(uv.x - kStep, uv.y)) / (2 * kStep);
  const V3d dv = (point_at(uv.x, uv.y + kStep) - point_at(uv.x, uv.y - kStep)) / (2 * kStep);
  expect_near(at.dp_du, du, 1e-7 * du.length());
  expect_near(at.dp_dv, dv, 1e-7 * dv.length());
}

TEST(Coordinates, OfAQuadRunAlongItsEdges) {
  const Quad quad{{1, 2, 3}, {2, 0, 1}, {0.5, 3, 0}};
  for (const V2d& uv : {V2d(0, 0), V2d(1, 0), V2d(0.25, 0.75), V2d(0.9, 0.1)})
    expect_coordinates(quad, uv,
                       [&](double u, double v) { return quad.corner + quad.edge_u * u + quad.edge_v * v; });
}

// All orientations, with what is to the right and above as seen from the front.
TEST(Coordinates, OfADiscFillTheSquareAroundIt) {
  struct Facing {
    V3d normal, right, up;
  };
  for (const auto& [normal, right, up] :
       {Facing{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, Facing{{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}},
        Facing{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}, Facing{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}) {
    const Disc disc{{1, -2, 0.5}, normal, 3};
    expect_coordinates(disc, {0.7, 0.4}, [&, r = right, t = up](double u, double v) {
      return disc.center + r * (6 * (u - 0.5)) + t * (6 * (v - 0.5));
    });
  }
}

TEST(Coordinates, OfASphereAreLongitudeAndLatitude) {
  const Sphere sphere{{1, 2, 3}, 2};
  for (const V2d& uv : {V2d(0.1, 0.5), V2d(0.4, 0.9), V2d(0.6, 0.2), V2d(0.99, 0.01)})
    expect_coordinates(sphere, uv, [&](double u, double v) {
      const double longitude = 2 * std::numbers::pi * u;
      const double latitude = std::numbers::pi * (v - 0.5);
      return sphere.center + V3d(std::cos(longitude) * std::cos(latitude),
                                 std::sin(longitude) * std::cos(latitude), std::sin(latitude)) *
                                 2;
    });
  const SurfaceCoordinates pole = coordinates(sphere, {1, 2, 5}, 0, 0);
  EXPECT_EQ(pole.uv.y, 1);
  EXPECT_EQ(pole.dp_du, V3d(0));
}

// An affine map of the plane to the triangles, which meet at a seam.
TEST(Coordinates, OfAMeshAreInterpolatedOnEachTriangle) {
  const Mesh mesh{{{0, 0, 0}, {2, 0, 0}, {0, 1, 1}, {2, 1, 1}},
                  {{0, 1, 2}, {3, 2, 1}},
                  {{{{0.1F, 0.2F}, {0.6F, 0.2F}, {0.1F, 0.7F}}}, {{{0, 0}, {-1, 0}, {0, -1}}}}};
  const V2d corner(0.1F, 0.2F);
  const V2d size(static_cast<double>(0.6F) - corner.x, static_cast<double>(0.7F) - corner.y);
  expect_coordinates(mesh, {0.3, 0.4}, [&](double u, double v) {
    return V3d(2, 0, 0) * ((u - corner.x) / size.x) + V3d(0, 1, 1) * ((v - corner.y) / size.y);
  });
  expect_coordinates(
      mesh, {-0.25, -0.5}, [](double u, double v) { return V3d(2 + 2 * u, 1 + v, 1 + v); }, 1);
}

// Nowhere mirrored as seen from outside, and each face is filled.
TEST(Coordinates, OfAPrismStandOnItsFaces) {
  const Mesh prism = make_prism(50, 2, 3);
  ASSERT_EQ(prism.coordinates.size(), prism.triangles.size());
  for (std::size_t i = 0; i < prism.triangles.size(); ++i) {
    const auto& [a, b, c] = prism.triangles[i];
    const V3d middle = (prism.vertices[a] + prism.vertices[b] + prism.vertices[c]) / 3;
    const SurfaceCoordinates at = coordinates(prism, middle, i, 0);
    EXPECT_GT(at.dp_du.cross(at.dp_dv).dot(middle), 0) << i;
    if (i >= 2) {
      EXPECT_NEAR(at.dp_du.length(), 3, 1e-6) << i;
      EXPECT_NEAR(at.dp_dv.length(), i < 4 ? 4 * std::sin(25 * std::numbers::pi / 180) : 2, 1e-6) << i;
      EXPECT_NEAR(at.dp_du.dot(at.dp_dv), 0, 1e-6) << i;
    }
  }
}

TEST(Coordinates, WithoutDirectionAreNoTrouble) {
  Mesh mesh{{{0, 0, 0}, {2, 0, 0}, {0, 1, 1}}, {{0, 1, 2}}};
  EXPECT_EQ(coordinates(mesh, {0, 0, 0}, 0, 0).dp_du, V3d(0));
  mesh.coordinates = {{{{0.5F, 0.5F}, {0.5F, 0.5F}, {0.5F, 0.5F}}}};
  const SurfaceCoordinates at = coordinates(mesh, {0.1, 0.1, 0.1}, 0, 0);
  expect_near(at.uv, V2d(0.5, 0.5), kTight);
  EXPECT_EQ(at.dp_du, V3d(0));
}

TEST(Coordinates, OfAnInstanceAreItsPrototypes) {
  const Quad quad{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  const Imath::M44d map = Imath::M44d().setScale(V3d(2, 3, -1)) * Imath::M44d().setTranslation(V3d(5, 6, 7));
  const Shape placed = PlacedShape{make_prototype(quad), std::make_shared<Placement>(placement(map))};
  expect_coordinates(placed, {0.3, 0.8}, [](double u, double v) { return V3d(5 + 2 * u, 6 + 6 * v, 7); });
}

// A quad of two triangles as a mesh, alone and as an instance. The hit of a ray states the triangle and the
// position.
TEST(Coordinates, AreFoundWhereARayMeetsASurface) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                  {{0, 1, 2}, {3, 2, 1}},
                  {{{{0, 0}, {1, 0}, {0, 1}}}, {{{2, 2}, {1, 2}, {2, 1}}}}};
  const SpectralTexture paint(TextureImage(1, 1, 1, {0.5F}, {}), {Curve(1.0)});
  Scene scene{};
  scene.materials = {{"paint", DiffuseMaterial{paint}}, {"plain", DiffuseMaterial{Curve(0.5)}}};
  const auto at = std::make_shared<Placement>(placement(Imath::M44d().setTranslation(V3d(0, 0, 5))));
  scene.shapes.push_back({"mesh", mesh, 0});
  scene.shapes.push_back({"instance", PlacedShape{make_prototype(mesh), at}, 0});
  scene.shapes.push_back({"plain", Quad{{0, 0, 10}, {1, 0, 0}, {0, 1, 0}}, 1});
  scene.commit();
  EXPECT_TRUE(scene.features.textures);
  EXPECT_EQ(scene.features.reasons.at("textures"), "shape \"mesh\"");
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const V2f p = random.pair();
    for (const float z : {0.0F, 5.0F, 10.0F}) {
      const auto hit = scene.intersect({{p.x, p.y, z + 1}, {0, 0, -1}});
      ASSERT_TRUE(hit);
      const ShadingPoint place = textured_shading_point(scene, *hit, 0);
      const V2f expected = z == 10 ? V2f(0, 0) : p.x + p.y <= 1 ? p : p + V2f(1, 1);
      EXPECT_LE((place.uv - expected).length(), 1e-5F) << p << " " << place.uv;
      EXPECT_LE((place.frame.x - Imath::V3f(1, 0, 0)).length(), 1e-6F);
      EXPECT_LE((place.frame.y - Imath::V3f(0, 1, 0)).length(), 1e-6F);
    }
  }
}

TEST(Basis, TurnsItsXAlongADirection) {
  using Imath::V3f;
  const V3f normal = V3f(1, 2, 3).normalized();
  const V3f along(0.5F, -1, 4);
  const Basis<float> basis(normal, along);
  EXPECT_NEAR(basis.x.dot(normal), 0, 1e-6);
  EXPECT_NEAR(basis.x.cross(basis.y).dot(normal), 1, 1e-6);
  EXPECT_NEAR(along.dot(basis.y), 0, 1e-5);
  EXPECT_GT(along.dot(basis.x), 0);
  for (const V3f& none : {V3f(0, 0, 0), normal * 2.0F}) {
    EXPECT_EQ(Basis<float>(normal, none).x, Basis<float>(normal).x);
    EXPECT_EQ(Basis<float>(normal, none).y, Basis<float>(normal).y);
  }
}

}  // namespace
}  // namespace abbe
