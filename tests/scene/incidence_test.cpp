#include "scene/camera/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "tests/scene/cameras.h"

namespace abbe {
namespace {

using Imath::V2f;

double sine2(double cosine) {
  return 1 - cosine * cosine;
}

// First and second moments of the squared sine.
struct Moments {
  double mean = 0;
  double square = 0;
};

Moments moments(const std::vector<Incidence>& angles) {
  Moments sum;
  for (const Incidence& angle : angles) {
    sum.mean += angle.fraction * sine2(angle.cos_film);
    sum.square += angle.fraction * sine2(angle.cos_film) * sine2(angle.cos_film);
  }
  return sum;
}

// The moments of randomly sampled rays, as in renders.
Moments drawn_moments(const Camera& camera, V2f film) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(0, 1);
  Moments sum;
  double weights = 0;
  for (int i = 0; i < 200000; ++i) {
    const CameraRay ray = test::ray_of(camera, film, {u(random), u(random)});
    const auto weight = static_cast<double>(ray.weight[0]);
    const double s = sine2(static_cast<double>(ray.cos_film));
    weights += weight;
    sum.mean += weight * s;
    sum.square += weight * s * s;
  }
  return {sum.mean / weights, sum.square / weights};
}

TEST(Incidence, HasTheAnglesOfTheRaysThatRendersDraw) {
  for (const Camera& camera : {test::lens(), test::bladed_lens(), test::turned_lens(), test::wide_lens()})
    for (const V2f& film : {V2f(3, 2), V2f(5, 3), V2f(6, 4)}) {
      const std::vector<Incidence> angles = incidence_angles(camera, film);
      const double all = std::accumulate(angles.begin(), angles.end(), 0.0,
                                         [](double sum, const Incidence& a) { return sum + a.fraction; });
      EXPECT_NEAR(all, 1, 1e-12);
      const Moments expected = drawn_moments(camera, film);
      EXPECT_NEAR(moments(angles).mean, expected.mean, 0.006 * expected.mean) << film;
      EXPECT_NEAR(moments(angles).square, expected.square, 0.01 * expected.square) << film;
    }
}

// A whole hemisphere of uniform radiance: sin^2 is uniform in [0, 1].
TEST(Incidence, OfAMeterIsThatOfAFullCone) {
  const std::vector<Incidence> angles = incidence_angles(test::meter(), {1, 1});
  double below = 0;
  for (const Incidence& angle : angles) {
    EXPECT_NEAR(sine2(angle.cos_film), below + angle.fraction / 2, 5e-3);
    below += angle.fraction;
  }
  EXPECT_GE(angles.size(), 16U);
}

TEST(Incidence, OfAPinholeIsOneAngle) {
  const std::vector<Incidence> angles = incidence_angles(test::narrow_pinhole(), {0, 0});
  ASSERT_EQ(angles.size(), 1U);
  EXPECT_EQ(angles.front().fraction, 1);
  EXPECT_NEAR(std::tan(std::acos(angles.front().cos_film)), std::hypot(3, 2) * 0.005 / 0.05, 1e-5);
}

}  // namespace
}  // namespace abbe
