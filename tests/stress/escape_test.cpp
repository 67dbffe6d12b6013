// Rays within closed meshes, at what is hardest for them: edges, corners, and their own starting points.
#include <gtest/gtest.h>

#include "tests/scene/scenes.h"
#include "tests/tier.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;
using test::Random;
using test::scene_of;

// How many times as much the night does.
const int kEffort = test::nightly() ? 100 : 1;

// A box with corners of its own for no face, and outward triangles.
Mesh box(const V3d& half) {
  Mesh mesh;
  for (const double x : {-half.x, half.x})
    for (const double y : {-half.y, half.y})
      for (const double z : {-half.z, half.z}) mesh.vertices.emplace_back(x, y, z);
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

std::vector<Mesh> boxes() {
  return {box({1, 1, 1}), box({390.184, 390.184, 390.184}), box({0.39, 0.517, 3.07})};
}

std::vector<Mesh> closed_meshes() {
  std::vector<Mesh> meshes = boxes();
  meshes.push_back(make_prism(60, 1.5, 2));
  return meshes;
}

V3f vertex_of(const Mesh& mesh, std::uint32_t index) {
  return V3f(mesh.vertices[index]);
}

// Stress 18: from within, in any direction, at edges, and at corners, where a second try may be askew.
TEST(Stress, NoRayLeavesAClosedMesh) {
  Random random(18);
  for (const Mesh& mesh : closed_meshes()) {
    const Scene scene = scene_of({mesh});
    int escaped = 0;
    const auto leaves = [&](const V3f& from, const V3f& to) {
      return !scene.intersect({from, (to - from).normalized()}).has_value();
    };
    for (int i = 0; i < 100'000 * kEffort; ++i) {
      const V3f from(random.in_cube(0.2));
      const auto& triangle = mesh.triangles[static_cast<std::size_t>(i) % mesh.triangles.size()];
      const V3f a = vertex_of(mesh, triangle[0]);
      const V3f b = vertex_of(mesh, triangle[1]);
      escaped += leaves(from, from + V3f(random.direction()));
      escaped += leaves(from, a + (b - a) * random.uniform());
      escaped += leaves(from, a) && leaves(from, a + V3f(random.direction()) * 1e-5F);
    }
    EXPECT_EQ(escaped, 0);
  }
}

// A path within, scattered by the walls as a diffuse one. Of sharper edges than a box has it may come out:
// one start in some ten million lies so close to one that it is beyond the other face.
TEST(Stress, NoPathLeavesABox) {
  Random random(19);
  for (const Mesh& mesh : boxes()) {
    const Scene scene = scene_of({mesh});
    int escaped = 0;
    for (int k = 0; k < 2'500 * kEffort; ++k) {
      Ray ray{V3f(random.in_cube(0.2)), V3f(random.direction())};
      for (int i = 0; i < 200; ++i) {
        const auto hit = scene.intersect(ray);
        // Seen from within, the outward normal of a wall runs along the ray.
        if (!hit || hit->normal.dot(ray.direction) < 0) {
          ++escaped;
          break;
        }
        V3f in(random.direction());
        if (in.dot(hit->normal) > 0) in = -in;
        if (in.dot(hit->normal) > -1e-6F) in -= hit->normal;  // along the wall there is no side to be on
        ray = spawn(*hit, in.normalized(), 0);
      }
    }
    EXPECT_EQ(escaped, 0);
  }
}

// Walls that go on beyond one another, of a room of that half size.
Scene hall(const V3d& half) {
  std::vector<Shape> walls;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      V3d corner = half * -1.5;
      corner[axis] = side * half[axis];
      V3d u(0), v(0);
      u[(axis + 1) % 3] = 3 * half[(axis + 1) % 3];
      v[(axis + 2) % 3] = 3 * half[(axis + 2) % 3];
      walls.emplace_back(Quad{corner, u, v});
    }
  return scene_of(walls);
}

// Rays to where two walls meet are scattered by one of them, in front of the other.
TEST(Stress, NoPathLeavesBetweenWallsThatCross) {
  Random random(20);
  for (const V3d& half : {V3d(1), V3d(390.184), V3d(0.39, 0.517, 3.07), V3d(1.4e-7)}) {
    const Scene scene = hall(half);
    int escaped = 0;
    for (int i = 0; i < 100'000 * kEffort; ++i) {
      const V3f from(random.in_cube(0.5) * half);
      V3f edge = V3f(half);
      for (int axis = 0; axis < 3; ++axis)
        if (random.uniform() < 0.5F) edge[axis] = -edge[axis];
      edge[i % 3] *= 0.9F * random.uniform();
      const V3f along = (edge - from).normalized();
      const auto hit = scene.intersect({from, along});
      ASSERT_TRUE(hit);
      V3f in(random.direction());
      const V3f inwards = hit->normal * (hit->normal.dot(hit->point) > 0 ? -1.0F : 1.0F);
      if (in.dot(inwards) < 0) in = -in;
      if (in.dot(inwards) < 1e-6F) in += inwards;  // as above
      escaped += !scene.intersect(spawn(*hit, -along, in.normalized(), 0));
    }
    EXPECT_EQ(escaped, 0) << half.x;
  }
}

}  // namespace
}  // namespace abbe
