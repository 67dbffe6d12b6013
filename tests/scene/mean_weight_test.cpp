#include "scene/camera/camera.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "tests/angles.h"
#include "tests/scene/cameras.h"

namespace abbe {
namespace {

using Imath::V2f;
using test::bladed_lens;
using test::frame;
using test::lens;
using test::meter;
using test::ray_of;
using test::turned_lens;
using test::wide_lens;
using test::wide_pinhole;

// Life size at f/1, an extreme close-up.
Camera macro_lens(std::optional<lens::Iris> iris = {}) {
  return {ThinLens{frame(), 0.2, 0.2, 0.05, 0.7, iris}, 6, 4, 0.02};
}

double mean_weight_at(const Camera& camera, V2f film) {
  return mean_weight(camera, opening_tangent(camera), film);
}

// On the axis pi a^2 tau / (v^2 (1 + a^2/s^2)), as for all lenses that fulfil Abbe's sine condition. A
// pinhole has one ray, and the rays of a lens in focus at infinity have one direction.
TEST(MeanWeight, IsThatOfTheSineConditionOnTheAxis) {
  EXPECT_NEAR(mean_weight_at(macro_lens(), {3, 2}), kPi * 0.0025 * 0.7 / 0.04 / 1.0625, 1e-7);
  EXPECT_NEAR(mean_weight_at(lens(), {3, 2}), kPi * 0.25 * 0.25 * 0.81 / (1 + 0.025 * 0.025), 1e-7);
  const Camera far{ThinLens{frame(), 0.2, std::numeric_limits<double>::infinity(), 0.05}, 6, 4, 0.02};
  for (const Camera& camera : {far, wide_pinhole(), meter()})
    for (const V2f& film : {V2f(1, 1), V2f(0.1F, 3.9F)})
      EXPECT_EQ(mean_weight_at(camera, film), central_weight(camera, film));
}

TEST(MeanWeight, IsTheMeanOfTheRaysThroughTheOpening) {
  constexpr int kSide = 300;
  for (const Camera& camera : {lens(), bladed_lens(), turned_lens(), wide_lens(), macro_lens(),
                               macro_lens(lens::Iris(5, 10)), macro_lens(lens::Iris(9, 0))})
    for (const V2f& film : {V2f(3, 2), V2f(1, 3), V2f(0, 0)}) {
      double sum = 0;
      for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
          const V2f u((static_cast<float>(i) + 0.5F) / kSide, (static_cast<float>(j) + 0.5F) / kSide);
          sum += static_cast<double>(ray_of(camera, film, u).weight[0]);
        }
      EXPECT_NEAR(mean_weight_at(camera, film) * kSide * kSide / sum, 1, 5e-5) << film;
    }
}

}  // namespace
}  // namespace abbe
