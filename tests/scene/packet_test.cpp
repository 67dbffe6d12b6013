#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"
#include "scenes.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;
using test::Random;
using test::scene_of;

// A block with duplicate faces, and a quad on one of them: every ray to it has ties.
Mesh doubled_block() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  const std::vector<std::array<std::uint32_t, 4>> faces{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (int twice = 0; twice < 2; ++twice)
    for (const auto& [a, b, c, d] : faces) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

Scene crowded(bool instances) {
  Imath::M44d map;
  map.translate(V3d(0, 3, 0));
  const auto at = std::make_shared<const Placement>(placement(map));
  std::vector<Shape> shapes{doubled_block(), Quad{{-1, -1, 1}, {2, 0, 0}, {0, 2, 0}}, Sphere{{3, 0, 0}, 1},
                            Disc{{3, 0, 1}, {0, 0, 1}, 1}};
  if (instances) {
    shapes.emplace_back(PlacedShape{make_prototype(doubled_block()), at});
    shapes.emplace_back(PlacedShape{make_prototype(Sphere{{3, 0, 0}, 1}), at});
  }
  return scene_of(std::move(shapes));
}

// Rays at corners, along edges, at coincident faces, and at random.
std::vector<Ray> rays_at(int count) {
  Random random(1);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const auto whole = [&] { return static_cast<float>(static_cast<int>(random.uniform() * 3) - 1); };
    const auto any = [&] { return static_cast<float>(random.uniform() * 4 - 2); };
    V3f target(any(), any(), any());
    for (int axis = 0; axis < i % 4; ++axis) target[axis] = whole();
    const V3f offset = i % 3 == 0 ? V3f(3, 0, 0) : i % 3 == 1 ? V3f(0, 3, 0) : V3f(0);
    const V3f from = V3f(any(), any(), any()) * (i % 5 == 0 ? 0.4F : 4.0F);
    rays.push_back({from, (target + offset - from).normalized()});
  }
  return rays;
}

bool same(const std::optional<SurfaceHit>& a, const std::optional<SurfaceHit>& b) {
  if (!a || !b) return !a && !b;
  return a->point == b->point && a->normal == b->normal && a->t == b->t && a->shape == b->shape &&
         a->primitive == b->primitive;
}

struct Answers {
  std::vector<std::optional<SurfaceHit>> hits;
  std::vector<std::uint8_t> blocked;
};

// Traces packets of consecutive rays in the given `order`, `together` at a time.
Answers ask(const Scene& scene, const std::vector<Ray>& rays, const std::vector<std::size_t>& order,
            std::size_t together) {
  Answers answers{std::vector<std::optional<SurfaceHit>>(rays.size()),
                  std::vector<std::uint8_t>(rays.size())};
  for (std::size_t first = 0; first < rays.size(); first += together) {
    const std::size_t count = std::min(together, rays.size() - first);
    std::vector<Ray> some;
    std::vector<BasicRay<double>> ways;
    for (std::size_t i = 0; i < count; ++i) {
      const Ray& ray = rays[order[first + i]];
      some.push_back(ray);
      ways.push_back({V3d(ray.origin), V3d(ray.direction), order[first + i] % 2 == 0 ? 2.0 : 1e9});
    }
    std::vector<std::optional<SurfaceHit>> hits(count);
    std::vector<std::uint8_t> blocked(count);
    scene.intersect(some, hits);
    scene.occluded(ways, blocked);
    for (std::size_t i = 0; i < count; ++i) {
      answers.hits[order[first + i]] = hits[i];
      answers.blocked[order[first + i]] = blocked[i];
    }
  }
  return answers;
}

int differences(const Answers& a, const Answers& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.hits.size(); ++i)
    count += same(a.hits[i], b.hits[i]) && a.blocked[i] == b.blocked[i] ? 0 : 1;
  return count;
}

// A hit does not depend on the other rays of a packet, ties included. Therefore the bits of a render do not
// depend on how paths are batched or on when they end.
class Packets : public ::testing::TestWithParam<bool> {};

TEST_P(Packets, AnswerEachRayAsIfItWereAlone) {
  constexpr std::size_t kRays = 50001;
  const Scene scene = crowded(GetParam());
  const std::vector<Ray> rays = rays_at(kRays);
  std::vector<std::size_t> order(rays.size());
  std::iota(order.begin(), order.end(), 0);
  const Answers alone = ask(scene, rays, order, 1);
  EXPECT_EQ(differences(alone, ask(scene, rays, order, kRays)), 0);
  EXPECT_EQ(differences(alone, ask(scene, rays, order, 5)), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  EXPECT_EQ(differences(alone, ask(scene, rays, order, kRays)), 0);
  const auto met = std::count_if(alone.hits.begin(), alone.hits.end(), [](const auto& hit) { return hit; });
  const auto dark = std::count(alone.blocked.begin(), alone.blocked.end(), 1);
  EXPECT_GT(met, kRays / 3);
  EXPECT_LT(met, kRays);
  EXPECT_GT(dark, kRays / 6);
}

TEST_P(Packets, MayBeEmpty) {
  const Scene scene = crowded(GetParam());
  scene.intersect(std::span<const Ray>(), {});
  scene.occluded(std::span<const BasicRay<double>>(), {});
}

INSTANTIATE_TEST_SUITE_P(AmongInstances, Packets, ::testing::Bool());

}  // namespace
}  // namespace abbe
