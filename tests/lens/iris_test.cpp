#include "lens/iris.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include <gtest/gtest.h>

#include "lens/beam.h"
#include "lens/field.h"
#include "lenses.h"
#include "tests/angles.h"

namespace abbe::lens {
namespace {

using Imath::V2d;

// Corners by definition: one is up, or rotated clockwise by the angle, the others are evenly spaced.
std::vector<V2d> corners_of(int blades, double rotation_deg) {
  std::vector<V2d> corners;
  for (int k = 0; k < blades; ++k) {
    const double clockwise = rotation_deg * kPi / 180 + 2 * kPi * k / blades;
    corners.emplace_back(std::sin(clockwise), std::cos(clockwise));
  }
  return corners;
}

double cross_product(const V2d& a, const V2d& b) {
  return a.x * b.y - a.y * b.x;
}

// Smallest distance from an edge, positive inside.
double depth(const std::vector<V2d>& corners, const V2d& point) {
  double least = 1;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const V2d edge = corners[(k + 1) % corners.size()] - corners[k];
    least = std::min(least, cross_product(point - corners[k], edge.normalized()));
  }
  return least;
}

struct Blades {
  int count;
  double rotation_deg;
};
const Blades kExamples[]{{3, 0}, {4, 45}, {5, 0}, {5, 17}, {8, -100}, {9, 400}, {32, 3}};

TEST(Iris, LetsLightThroughBetweenItsBlades) {
  for (const auto& [count, rotation] : kExamples) {
    const Iris iris(count, rotation);
    const auto corners = corners_of(count, rotation);
    for (int j = -50; j <= 50; ++j)
      for (int i = -50; i <= 50; ++i) {
        const V2d point(i / 49.7, j / 49.7);
        const double inwards = depth(corners, point);
        if (std::abs(inwards) > 1e-12) {
          EXPECT_EQ(iris.contains(point), inwards > 0) << count << ": " << point;
        }
      }
  }
}

TEST(Iris, HasTheShareOfAPolygonInACircle) {
  for (const auto& [count, rotation] : kExamples) {
    const auto corners = corners_of(count, rotation);
    double area = 0;
    for (std::size_t k = 0; k < corners.size(); ++k)
      area += cross_product(corners[(k + 1) % corners.size()], corners[k]) / 2;
    EXPECT_NEAR(Iris(count, rotation).area_fraction(), area / kPi, 1e-14);
    EXPECT_NEAR(area / kPi, count / (2 * kPi) * std::sin(2 * kPi / count), 1e-14);
  }
}

// The map covers the polygon including its rim, and maps every small square to the same fraction of area.
TEST(Iris, SpreadsTheDiscEvenlyOverThePolygon) {
  constexpr double kStep = 1e-6;
  for (const auto& [count, rotation] : kExamples) {
    const Iris iris(count, rotation);
    const auto corners = corners_of(count, rotation);
    EXPECT_EQ(iris.point({0, 0}), V2d(0, 0));
    for (const V2d& corner : corners) EXPECT_LT((iris.point(corner) - corner).length(), 1e-12);
    for (int i = 0; i < 1000; ++i) {
      const double radius = std::sqrt((i + 0.5) / 1000);
      const double angle = 2.399963 * i;
      const V2d disc(radius * std::cos(angle), radius * std::sin(angle));
      const double inwards = depth(corners, iris.point(disc));
      EXPECT_NEAR(inwards, (1 - radius) * std::cos(kPi / count), 1e-12);
      const V2d x = (iris.point(disc + V2d(kStep, 0)) - iris.point(disc - V2d(kStep, 0))) / (2 * kStep);
      const V2d y = (iris.point(disc + V2d(0, kStep)) - iris.point(disc - V2d(0, kStep))) / (2 * kStep);
      EXPECT_NEAR(cross_product(x, y), iris.area_fraction(), 1e-4) << count << " at " << disc;
    }
  }
}

// The rays of a beam that pass are those of the polygon. The T-stop gives their power at the image.
TEST(Iris, StopsRaysOfALensAtItsCorners) {
  System system = test::lens_named("double_gauss");
  const double radius = stop_radius(system);
  constexpr int kSide = 400;
  const auto seen = [&] {
    const SystemAt at(system, 550);
    return std::pair(spot(*Beam::of(at, 0, radius), 0, kSide), *speed(at, radius, 64));
  };
  system.surfaces[system.stop].semi_aperture_mm = radius;
  const auto [round, round_speed] = seen();
  for (const int blades : {5, 8}) {
    system.surfaces[system.stop].iris = Iris(blades, 10);
    const auto [spot, speed] = seen();
    const double share = Iris(blades, 10).area_fraction();
    EXPECT_EQ(spot.filled, round.filled);
    EXPECT_NEAR(spot.passed / round.passed, share, 0.01);  // the pupil is not perfectly uniform over the beam
    EXPECT_EQ(speed.f_number, round_speed.f_number);
    EXPECT_NEAR(std::pow(round_speed.t_stop / speed.t_stop, 2), share, 0.001);
  }
}

}  // namespace
}  // namespace abbe::lens
