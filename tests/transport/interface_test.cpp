#include "transport/path/vertex.h"

#include <gtest/gtest.h>

#include <vector>

namespace abbe {
namespace {

// Shapes by material: 0 air, 1 water, 2 glass of a higher priority, 3 another glass without priority, 4 a
// card, 5 another pane of the first glass.
class BoundaryTest : public testing::Test {
 protected:
  BoundaryTest() {
    const auto matter = [](double n) { return DielectricMaterial{"", RefractiveIndex(n)}; };
    scene_.materials = {{"air", matter(1)},
                        {"water", matter(1.33)},
                        {.name = "glass", .model = matter(1.5), .priority = 2},
                        {"flint", matter(1.7)},
                        {"card", DiffuseMaterial{Curve(0.5)}},
                        {"metal", ConductorMaterial{"", RefractiveIndex(0.2, 3)}}};
    for (std::uint32_t i = 0; i < 5; ++i) scene_.shapes.push_back({"", Sphere{{0, 0, 0}, 1}, i});
    scene_.shapes.push_back({"", Sphere{{0, 0, 0}, 1}, 2});
    scene_.shapes.push_back({"", Sphere{{0, 0, 0}, 1}, 5});
  }
  MediumStack in(const std::vector<std::uint32_t>& shapes) const {
    MediumStack inside;
    for (const std::uint32_t shape : shapes) inside.cross(scene_, shape, true);
    return inside;
  }
  static std::vector<std::uint32_t> listed(const MediumStack& inside) {
    return {inside.shapes().begin(), inside.shapes().end()};
  }
  // Number of the acting shape, or -1.
  static int acting(const ActingSurface& boundary, const std::vector<CrossedSurface>& met) {
    return boundary.acting ? static_cast<int>(met[*boundary.acting].shape) : -1;
  }
  double outside(const ActingSurface& boundary) const {
    return boundary.outside ? boundary.outside->n(550) : 0;
  }

  struct Expected {
    std::vector<std::uint32_t> inside;
    std::vector<CrossedSurface> met;
    int acting;
    double outside;  ///< Index outside; 0 for air that fills no shape.
    std::vector<std::uint32_t> beyond;
  };
  void check(const std::vector<Expected>& all) const {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Expected& one = all[i];
      const ActingSurface found = acting_surface(scene_, one.met, in(one.inside));
      EXPECT_EQ(acting(found, one.met), one.acting) << i;
      if (found.acting) {
        EXPECT_EQ(outside(found), one.outside) << i;
      }
      EXPECT_EQ(listed(found.media_behind), one.beyond) << i;
    }
  }

  Scene scene_{};
};

TEST_F(BoundaryTest, OfNestedShapesIsBetweenNeighbours) {
  check({{{}, {{1, true}}, 1, 0, {1}},
         {{1}, {{3, true}}, 3, 1.33, {1, 3}},
         {{1, 3}, {{3, false}}, 3, 1.33, {1}},
         {{3}, {{0, true}}, 0, 1.7, {3, 0}},  // a bubble
         {{3, 0}, {{0, false}}, 0, 1.7, {3}},
         {{1}, {{1, false}}, 1, 0, {}}});
}

TEST_F(BoundaryTest, IsNoneWithinMatterOfAHigherPriority) {
  check({{{2}, {{1, true}}, -1, 0, {1, 2}},
         {{1, 2}, {{1, false}}, -1, 0, {2}},
         {{1, 2}, {{2, false}}, 2, 1.33, {1}},
         {{1}, {{2, true}}, 2, 1.33, {1, 2}},
         // Of equal media, that of the shape entered last counts.
         {{1, 3}, {{1, false}}, -1, 0, {3}}});
}

TEST_F(BoundaryTest, OfTouchingSurfacesIsOneBetweenBothMatters) {
  check({{{1}, {{1, false}, {2, true}}, 2, 1.33, {2}},
         {{2}, {{2, false}, {1, true}}, 2, 1.33, {1}},
         // The result does not depend on which of both rounding puts first, and is the same from either side.
         {{1}, {{2, true}, {1, false}}, 2, 1.33, {2}},
         {{1}, {{3, true}, {1, false}}, 3, 1.33, {3}},
         {{3}, {{1, true}, {3, false}}, 3, 1.33, {1}},
         // Both are entered in the same plane: the later shape of the scene counts.
         {{}, {{3, true}, {1, true}}, 3, 0, {1, 3}},
         // A pane cemented to another pane of the same glass.
         {{2}, {{2, false}, {5, true}}, 5, 1.5, {5}}});
}

TEST_F(BoundaryTest, IsOpaqueWhereAnythingIs) {
  check({{{2}, {{2, false}, {4, true}}, 4, 1.5, {2}}, {{1}, {{6, true}}, 6, 1.33, {1}}});
}

TEST_F(BoundaryTest, OfBodiesMadeOfFacesAndOfSurfacesNeverEntered) {
  check({{{2}, {{5, false}}, 5, 0, {}},  // leaves by another face
         {{}, {{3, false}}, 3, 0, {}},
         {{1}, {{3, false}}, 3, 1.33, {1}},
         {{3}, {{3, true}}, -1, 0, {3}}});
}

}  // namespace
}  // namespace abbe
