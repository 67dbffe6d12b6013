#include "scene/shapes/quadric.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "scene/shapes/shape.h"
#include "scenes.h"
#include "tests/scene/expect_near.h"

namespace abbe {
namespace {

using Imath::V3d;
using test::expect_near;
using test::Random;

constexpr double kPi = std::numbers::pi;

std::vector<Quadric> all_quadrics() {
  const V3d from(0.3, -0.2, 0.5);
  const V3d to(1.1, 0.9, -0.4);
  return {cylinder(from, to, 0.7, false), cylinder(from, to, 0.7, true), cone(from, to, 0.8, false),
          cone(from, to, 0.8, true), paraboloid(from, to, 0.3, 0.9)};
}

double height_at(const Quadric& quadric, const V3d& point) {
  return (point - quadric.origin).dot(quadric.axis);
}
double distance_at(const Quadric& quadric, const V3d& point) {
  return (point - quadric.origin).cross(quadric.axis).length();
}
// Negative inside, positive outside the infinite quadric.
double level(const Quadric& quadric, const V3d& point) {
  const double z = height_at(quadric, point);
  const double distance = distance_at(quadric, point);
  return distance * distance - (quadric.constant + z * (quadric.linear + z * quadric.quadratic));
}
V3d center_of(const Quadric& quadric) {
  return quadric.origin + quadric.axis * ((quadric.low + quadric.high) / 2);
}
std::vector<double> cap_heights(const Quadric& quadric) {
  std::vector<double> heights;
  for (const double end : {quadric.low, quadric.high})
    if (quadric.caps && quadric.radius(end) > 0) heights.push_back(end);
  return heights;
}
bool is_on_cap(const Quadric& quadric, const V3d& point) {
  return std::ranges::any_of(cap_heights(quadric),
                             [&](double end) { return std::abs(height_at(quadric, point) - end) < 1e-9; });
}

template <typename Function>
double root_between(const Function& function, double low, double high) {
  const bool rising = function(high) > 0;
  for (int i = 0; i < 60; ++i) {
    const double at = (low + high) / 2;
    ((function(at) > 0) == rising ? high : low) = at;
  }
  return (low + high) / 2;
}

// The nearest crossing by small steps along the ray. Two crossings within a step are missed.
std::optional<double> crossing_by_search(const Quadric& quadric, const BasicRay<double>& ray, double t_max) {
  constexpr int kSteps = 3000;
  const auto side = [&](double t) { return level(quadric, ray.origin + ray.direction * t); };
  for (int i = 0; i < kSteps; ++i) {
    const double low = t_max * i / kSteps;
    const double high = t_max * (i + 1) / kSteps;
    std::optional<double> found;
    const auto add = [&](double t) { found = std::min(found.value_or(t), t); };
    if ((side(low) > 0) != (side(high) > 0)) {
      const double t = root_between(side, low, high);
      const double z = height_at(quadric, ray.origin + ray.direction * t);
      if (z >= quadric.low && z <= quadric.high) add(t);
    }
    for (const double end : cap_heights(quadric)) {
      const auto above = [&](double t) { return height_at(quadric, ray.origin + ray.direction * t) - end; };
      if ((above(low) > 0) == (above(high) > 0)) continue;
      const double t = root_between(above, low, high);
      if (distance_at(quadric, ray.origin + ray.direction * t) <= quadric.radius(end)) add(t);
    }
    if (found) return found;
  }
  return std::nullopt;
}

BasicRay<double> random_ray(const Quadric& quadric, Random& random) {
  const V3d origin = center_of(quadric) + random.in_cube(2);
  const V3d target = center_of(quadric) + random.in_cube(0.8);
  return {origin, (target - origin).normalized()};
}

TEST(Quadric, IsHitWhereASearchFindsIt) {
  Random random(11);
  for (const Quadric& quadric : all_quadrics()) {
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
      const BasicRay<double> ray = random_ray(quadric, random);
      const auto hit = intersect(quadric, ray, 0.0);
      const auto expected = crossing_by_search(quadric, ray, 9);
      if (expected) {
        ASSERT_TRUE(hit);
        EXPECT_LT(hit->t, *expected + 1e-9);
      }
      if (!hit) continue;
      ++hits;
      if (!expected || hit->t < *expected - 1e-9) {
        EXPECT_TRUE(std::abs(hit->normal.dot(ray.direction)) < 0.2 || distance_at(quadric, hit->point) < 0.02)
            << "two crossings within a step";
      }
      expect_near(hit->point, ray.origin + ray.direction * hit->t, 1e-12);
    }
    EXPECT_GT(hits, 50);
  }
}

TEST(Quadric, NormalsAreThoseOfTheGradient) {
  constexpr double kStep = 1e-5;
  Random random(12);
  for (const Quadric& quadric : all_quadrics())
    for (int i = 0; i < 200; ++i) {
      const auto hit = intersect(quadric, random_ray(quadric, random), 0.0);
      if (!hit) continue;
      if (is_on_cap(quadric, hit->point)) {
        const bool at_low = std::abs(height_at(quadric, hit->point) - quadric.low) < 1e-9;
        expect_near(hit->normal, at_low ? -quadric.axis : quadric.axis, 1e-12);
        continue;
      }
      V3d gradient;
      for (int k = 0; k < 3; ++k) {
        V3d step(0);
        step[k] = kStep;
        gradient[k] = level(quadric, hit->point + step) - level(quadric, hit->point - step);
      }
      if (distance_at(quadric, hit->point) > 0.01) expect_near(hit->normal, gradient.normalized(), 1e-7);
    }
}

// Isotropic random lines through a ball of radius r cross a surface of area A on average A/(2 pi r^2) times.
TEST(Quadric, AreaIsThatOfRandomLines) {
  constexpr int kLines = 40'000;
  constexpr double kRadius = 2;
  Random random(13);
  for (const Quadric& quadric : all_quadrics()) {
    int crossings = 0;
    for (int i = 0; i < kLines; ++i) {
      const V3d direction = random.direction();
      const Basis<double> frame(direction);
      const double distance = kRadius * std::sqrt(random.between(0, 1));
      const double azimuth = random.between(0, 2 * kPi);
      const V3d origin = center_of(quadric) - direction * 3 +
                         (frame.x * std::cos(azimuth) + frame.y * std::sin(azimuth)) * distance;
      double t = 0;
      while (const auto hit = intersect(quadric, BasicRay<double>{origin, direction}, t)) {
        ++crossings;
        t = hit->t + 1e-9;
      }
    }
    EXPECT_NEAR(2 * kPi * kRadius * kRadius * crossings / kLines / area(quadric), 1, 0.06);
  }
}

TEST(Quadric, PointsAreSampledByAreaWithinTheBounds) {
  constexpr int kPoints = 20'000;
  Random random(14);
  for (const Quadric& quadric : all_quadrics()) {
    Quadric lower = quadric;  // the part below a height
    lower.high = quadric.low + 0.6 * (quadric.high - quadric.low);
    lower.caps = false;
    Quadric whole = quadric;
    whole.caps = false;
    double expected = area(lower);
    if (quadric.quadratic > 0) expected = area(whole) * (1 - 0.4 * 0.4);
    for (const double end : cap_heights(quadric))
      if (end == quadric.low) expected += kPi * quadric.radius(end) * quadric.radius(end);
    int below = 0;
    Imath::Box3d box;
    for (int i = 0; i < kPoints; ++i) {
      const SurfacePoint at = sample_area(quadric, random.pair());
      const V3d point(at.point);
      box.extendBy(point);
      below += height_at(quadric, point) < lower.high;
      const V3d above = point + V3d(at.normal) * 1e-3;
      const auto hit = intersect(quadric, BasicRay<double>{above, -V3d(at.normal)}, 0.0);
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->t, 1e-3, 1e-5);
      EXPECT_GT(hit->normal.dot(V3d(at.normal)), 1 - 1e-5);
    }
    EXPECT_NEAR(static_cast<double>(below) / kPoints, expected / area(quadric), 0.02);
    const Imath::Box3d around = bounds(quadric);
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(box.min[k], around.min[k] - 1e-6);
      EXPECT_LT(box.max[k], around.max[k] + 1e-6);
      EXPECT_NEAR(box.size()[k], around.size()[k], 0.08) << "tight";
    }
  }
}

TEST(Quadric, DistanceCostsNoPrecision) {
  Random random(15);
  const V3d away(1e5, -1e5, 1e5);
  for (const Quadric& quadric : all_quadrics()) {
    Quadric moved = quadric;
    shift(moved, away);
    for (int i = 0; i < 200; ++i) {
      BasicRay<double> ray = random_ray(quadric, random);
      const auto hit = intersect(quadric, ray, 0.0);
      if (!hit || std::abs(hit->normal.dot(ray.direction)) < 0.05) continue;
      const auto beside = intersect(moved, BasicRay<double>{ray.origin + away, ray.direction}, 0.0);
      ASSERT_TRUE(beside);
      EXPECT_NEAR(beside->t, hit->t, 1e-8);
      const bool on_cap = std::abs(level(quadric, hit->point)) > 1e-9;
      EXPECT_NEAR(on_cap ? 0 : level(quadric, beside->point - away), 0, 1e-9);
      if (crossing_by_search(quadric, {ray.origin - ray.direction * 9, ray.direction}, 9)) continue;
      const auto from_afar =
          intersect(quadric, BasicRay<double>{ray.origin - ray.direction * 1e5, ray.direction}, 0.0);
      ASSERT_TRUE(from_afar);
      EXPECT_NEAR(from_afar->t - 1e5, hit->t, 1e-8);
      EXPECT_NEAR(on_cap ? 0 : level(quadric, from_afar->point), 0, 1e-12);
    }
  }
}

TEST(Quadric, RaysLeaveASolidOnce) {
  Random random(16);
  for (const Quadric& quadric : all_quadrics()) {
    if (!quadric.caps) {
      EXPECT_EQ(enclosed_volume(quadric), 0);
      continue;
    }
    const auto exits = [&](const V3d& from, const V3d& direction) {
      int count = 0;
      double t = 0;
      while (const auto hit = intersect(quadric, BasicRay<double>{from, direction}, t)) {
        EXPECT_GT(hit->normal.dot(direction), 0);
        ++count;
        t = hit->t + 1e-9;
      }
      return count;
    };
    const Basis<double> frame(quadric.axis);
    for (int i = 0; i < 2000; ++i) {
      const double z = quadric.low + random.between(0.1, 0.9) * (quadric.high - quadric.low);
      const double azimuth = random.between(0, 2 * kPi);
      const V3d radial = frame.x * std::cos(azimuth) + frame.y * std::sin(azimuth);
      const V3d from =
          quadric.origin + quadric.axis * z + radial * (random.between(0, 0.9) * quadric.radius(z));
      EXPECT_EQ(exits(from, random.direction()), 1);
      const double end = cap_heights(quadric)[static_cast<std::size_t>(i) % cap_heights(quadric).size()];
      const V3d rim = quadric.origin + quadric.axis * end + radial * quadric.radius(end);
      EXPECT_EQ(exits(from, (rim - from).normalized()), 1) << "through the rim";
    }
  }
}

TEST(Quadric, CoordinatesChangeByTheirDerivatives) {
  constexpr double kStep = 1e-5;
  Random random(17);
  for (const Quadric& quadric : all_quadrics())
    for (int i = 0; i < 200; ++i) {
      const auto hit = intersect(quadric, random_ray(quadric, random), 0.0);
      if (!hit || distance_at(quadric, hit->point) < 0.05) continue;
      const SurfaceCoordinates at = coordinates_on(quadric, hit->point, 0);
      if (at.uv.x < 0.01 || at.uv.x > 0.99 || at.uv.y < 0.01 || at.uv.y > 0.99) continue;
      EXPECT_NEAR(at.dp_du.dot(hit->normal), 0, 1e-9);
      EXPECT_NEAR(at.dp_dv.dot(hit->normal), 0, 1e-9);
      const Imath::V2d along_u = coordinates_on(quadric, hit->point + at.dp_du * kStep, 0).uv - at.uv;
      const Imath::V2d along_v = coordinates_on(quadric, hit->point + at.dp_dv * kStep, 0).uv - at.uv;
      EXPECT_NEAR(along_u.x / kStep, 1, 1e-3);
      EXPECT_NEAR(along_u.y / kStep, 0, 1e-3);
      EXPECT_NEAR(along_v.x / kStep, 0, 1e-3);
      EXPECT_NEAR(along_v.y / kStep, 1, 1e-3);
    }
}

TEST(Quadric, ATransformMovesIt) {
  Random random(18);
  const double scale = 2.5;
  const Imath::M44d by = Imath::M44d().setScale(scale) *
                         Imath::M44d().setAxisAngle(V3d(1, 2, 3).normalized(), 0.8) *
                         Imath::M44d().setTranslation(V3d(3, -1, 2));
  for (const Quadric& quadric : all_quadrics()) {
    Quadric moved = quadric;
    transform(moved, by, scale);
    EXPECT_NEAR(area(moved), area(quadric) * scale * scale, 1e-9);
    EXPECT_NEAR(enclosed_volume(moved), enclosed_volume(quadric) * scale * scale * scale, 1e-9);
    for (int i = 0; i < 100; ++i) {
      const BasicRay<double> ray = random_ray(quadric, random);
      const auto hit = intersect(quadric, ray, 0.0);
      const auto of_moved =
          intersect(moved, BasicRay<double>{ray.origin * by, moved_direction(ray.direction, by)}, 0.0);
      ASSERT_EQ(hit.has_value(), of_moved.has_value());
      if (hit) expect_near(of_moved->point, hit->point * by, 1e-9);
    }
  }
}

// Embree's queries agree with the formula, for plain, distorted and moving shapes.
TEST(Quadric, IsFoundInAScene) {
  Random random(19);
  const Imath::M44d distorted =
      Imath::M44d().setScale(V3d(1, 0.7, 1.3)) * Imath::M44d().setAxisAngle(V3d(1, 2, 3).normalized(), 0.8);
  auto moving = std::make_shared<Placement>(placement(Imath::M44d()));
  moving->motion = std::make_shared<Motion>(
      std::vector<Motion::Keyframe>{{0, {0, 0, 0}, 0, {0, 0, 0}}, {1, {0, 0, 1}, 1, {0.3, 0, -0.2}}});
  for (const Quadric& quadric : all_quadrics())
    for (const Shape& shape :
         {Shape(quadric),
          Shape(PlacedShape{make_prototype(quadric), std::make_shared<Placement>(placement(distorted))}),
          Shape(PlacedShape{make_prototype(quadric), moving})}) {
      const Scene scene = test::scene_of({shape});
      for (int i = 0; i < 200; ++i) {
        const BasicRay<double> aimed = random_ray(quadric, random);
        const Ray ray{Imath::V3f(aimed.origin), Imath::V3f(aimed.direction),
                      std::numeric_limits<float>::infinity(), random.uniform()};
        const auto expected = intersect(shape,
                                        BasicRay<double>{V3d(ray.origin), V3d(ray.direction),
                                                         std::numeric_limits<double>::infinity(), ray.time},
                                        0.0);
        if (expected && std::abs(expected->normal.dot(V3d(ray.direction))) < 0.01) continue;
        const auto hit = scene.intersect(ray);
        ASSERT_EQ(hit.has_value(), expected.has_value());
        if (!hit) continue;
        EXPECT_NEAR(static_cast<double>(hit->t), expected->t, 1e-5);
        expect_near(V3d(hit->normal), expected->normal, 1e-5);
      }
    }
}

// Light parallel to the axis of a paraboloid is reflected through its focus.
TEST(Quadric, AParaboloidFocuses) {
  Random random(20);
  const V3d vertex(0.3, -0.2, 0.5);
  const V3d axis = V3d(1, 2, 3).normalized();
  const double focal_length = 0.8;
  const Quadric mirror = paraboloid(vertex, axis, focal_length, 1.5);
  const Basis<double> frame(axis);
  const V3d focus = vertex + axis * focal_length;
  for (int i = 0; i < 500; ++i) {
    const V3d from = vertex + axis * 5 + frame.x * random.between(-1, 1) + frame.y * random.between(-1, 1);
    const auto hit = intersect(mirror, BasicRay<double>{from, -axis}, 0.0);
    ASSERT_TRUE(hit);
    const V3d reflected = -axis + hit->normal * (2 * axis.dot(hit->normal));
    EXPECT_NEAR((focus - hit->point).cross(reflected).length(), 0, 1e-12);
  }
}

}  // namespace
}  // namespace abbe
