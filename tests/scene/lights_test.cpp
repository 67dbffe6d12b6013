#include <gtest/gtest.h>

#include "scene/lights/area_light.h"
#include "scene/shapes/ray.h"
#include "scenes.h"
#include "tests/angles.h"
#include "tests/scene/solid_angle.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;
using test::lit_by;
using test::Random;
using test::solid_angle;

// Irradiance [W/m^2] of a surface element divided by pi, by light sampling on a grid of strata. For radiance
// 1 it is the configuration factor.
double configuration_factor(const Scene& scene, const V3f& point, const V3f& normal, int side = 256,
                            std::uint32_t seed = 1) {
  Random random(seed);
  double sum = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const Imath::V2f u((static_cast<float>(i) + random.uniform()) / static_cast<float>(side),
                         (static_cast<float>(j) + random.uniform()) / static_cast<float>(side));
      const auto sample = sample_light(scene.lights[0], scene.shapes, {point}, u, 0);
      if (!sample) continue;
      EXPECT_NEAR(sample->wi.length(), 1, 1e-6);
      sum += std::max(0.0, static_cast<double>(sample->wi.dot(normal))) *
             static_cast<double>(sample->factor / sample->pdf);
    }
  return sum / (side * side) / kPi;
}

double solid_angle(const Quad& q, const V3d& from) {
  const V3d a = q.corner - from;
  return solid_angle(a, a + q.edge_u, a + q.edge_v) +
         solid_angle(a + q.edge_u + q.edge_v, a + q.edge_v, a + q.edge_u);
}

// The unit square at z = 1, facing down, as a quad, as a mesh, and as parts of a parallelogram.
Shape square_mesh() {
  return Mesh{{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{0, 3, 2}, {0, 2, 1}}};
}
Shape square_quad() {
  return Quad{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
}

TEST(AreaLights, RectangleOverItsCornerAndCentre) {
  for (const Shape& square : {square_quad(), square_mesh()}) {
    const Scene scene = lit_by(square);
    EXPECT_NEAR(configuration_factor(scene, {0, 0, 0}, {0, 0, 1}), 0.13853161, 1e-3 * 0.1385);
    EXPECT_NEAR(configuration_factor(scene, {0.5F, 0.5F, 0}, {0, 0, 1}), 0.23945647, 1e-3 * 0.2394);
  }
}

TEST(AreaLights, PerpendicularRectangle) {
  const Scene scene = lit_by(Quad{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}});
  EXPECT_NEAR(configuration_factor(scene, {0, 0, 0}, {0, 0, 1}), 0.05573420, 1e-3 * 0.0557);
}

TEST(AreaLights, ParallelogramByArea) {
  // A parallelogram near the unit square and the mesh of the same triangles must agree.
  const Quad skew{{0, 0, 1}, {0.5, 1, 0}, {1, 0, 0}};
  const Scene quad = lit_by(skew);
  const Scene mesh = lit_by(Mesh{{{0, 0, 1}, {0.5, 1, 1}, {1, 0, 1}, {1.5, 1, 1}}, {{0, 1, 2}, {3, 2, 1}}});
  EXPECT_NEAR(configuration_factor(quad, {0.3F, 0, 0}, {0, 0, 1}),
              configuration_factor(mesh, {0.3F, 0, 0}, {0, 0, 1}), 2e-4);
}

TEST(AreaLights, DiscOnAndOffItsAxis) {
  const Scene wide = lit_by(Disc{{0, 0, 1}, {0, 0, -1}, 1});
  EXPECT_NEAR(configuration_factor(wide, {0, 0, 0}, {0, 0, 1}), 0.5, 5e-4);
  const Scene aside = lit_by(Disc{{1, 0, 1}, {0, 0, -1}, 0.5});
  EXPECT_NEAR(configuration_factor(aside, {0, 0, 0}, {0, 0, 1}), 0.06587843, 6.5e-5);
}

TEST(AreaLights, FormFactorsBetweenSurfaces) {
  // Mean configuration factor over a receiver: opposite and adjacent faces of a cube, and coaxial discs.
  const auto mean = [](const Scene& scene, const V3f& normal, auto&& receiver) {
    double sum = 0;
    std::uint32_t seed = 0;
    constexpr int kSide = 48;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j)
        sum += configuration_factor(
            scene, receiver((static_cast<float>(i) + 0.5F) / kSide, (static_cast<float>(j) + 0.5F) / kSide),
            normal, 16, ++seed);
    return sum / (kSide * kSide);
  };
  const Scene lid = lit_by(square_quad());
  EXPECT_NEAR(mean(lid, {0, 0, 1}, [](float x, float y) { return V3f(x, y, 0); }), 0.19982490, 2e-4);
  EXPECT_NEAR(mean(lid, {1, 0, 0}, [](float y, float z) { return V3f(0, y, z); }), 0.20004378, 4e-4);
  const Scene disc = lit_by(Disc{{0, 0, 1}, {0, 0, -1}, 1});
  const auto on_disc = [](float x, float y) {
    return sample_area(Disc{{0, 0, 0}, {0, 0, 1}, 1}, {}, {x, y}).point;
  };
  EXPECT_NEAR(mean(disc, {0, 0, 1}, on_disc), 0.38196601, 4e-4);
}

TEST(AreaLights, SpheresOfAnySizeAndDistance) {
  for (const double radius : {1e-6, 1e-3, 1.0, 1e3, 1e6})
    for (const double ratio : {1.001, 1.5, 10.0, 1e3}) {
      const double distance = radius * ratio;
      const Scene scene = lit_by(Sphere{{0, 0, distance}, radius});
      EXPECT_NEAR(configuration_factor(scene, {0, 0, 0}, {0, 0, 1}, 64) * ratio * ratio, 1, 1e-3)
          << radius << " at " << distance;
    }
}

TEST(AreaLights, SphereFromInside) {
  const V3f inside(0.2F, 0.3F, -0.4F);
  EXPECT_EQ(configuration_factor(lit_by(Sphere{{0, 0, 0}, 1}), inside, {0, 0, 1}), 0);
  EXPECT_NEAR(configuration_factor(lit_by(Sphere{{0, 0, 0}, 1}, true), inside, {0, 0, 1}), 1, 2e-3);
  // On the sphere itself, rounded to either side.
  const Scene sphere = lit_by(Sphere{{0, 0, 0}, 1}, true);
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const V3f wall(random.direction());
    EXPECT_NEAR(configuration_factor(sphere, wall, -wall, 32), 1, 1e-2);
  }
}

TEST(AreaLights, OneSidedOnesAreDarkFromBehind) {
  for (const Shape& shape : {square_quad(), square_mesh(), Shape(Disc{{0.5, 0.5, 1}, {0, 0, -1}, 0.5})}) {
    const V3f above(0.5F, 0.4F, 1.5F);
    EXPECT_EQ(configuration_factor(lit_by(shape), above, {0, 0, -1}, 16), 0);
    EXPECT_GT(configuration_factor(lit_by(shape, true), above, {0, 0, -1}, 16), 0.2);
    const Scene scene = lit_by(shape);
    const V3f wi(0, 0, -1);
    EXPECT_EQ(light_pdf(scene.lights[0], scene.shapes, {above}, wi, above + wi * 0.5F, wi, 0), 0);
    EXPECT_FALSE(emits_towards(scene.lights[0], {0, 0, -1}, {0, 0, 1}));
    EXPECT_TRUE(emits_towards(scene.lights[0], {0, 0, -1}, {0, 0, -1}));
  }
}

// Lights, and near and far points around them.
struct View {
  Shape shape;
  V3f point;
};
std::vector<View> views() {
  return {{Sphere{{0, 0, 3}, 1}, {0, 0, 0}},
          {Sphere{{0, 0, 3}, 1}, {0.2F, 0, 1.9F}},
          {Sphere{{0, 0, 3}, 1}, {0.5F, 0, 3.2F}},
          {square_quad(), {0.1F, 0.2F, 0.4F}},
          {square_quad(), {1.5F, 0.2F, 0.9F}},
          {square_quad(), {0.1F, 0.2F, -20}},
          {Quad{{0, 0, 1}, {0.5, 1, 0}, {1, 0, 0}}, {0.1F, 0.2F, 0.5F}},
          {square_mesh(), {0.1F, 0.7F, 0.5F}},
          {Disc{{0, 0, 1}, V3d(0.3, 0, -1).normalized(), 0.8}, {0.1F, 0.7F, 0.3F}}};
}

TEST(AreaLights, DensityIsThatOfTheSamples) {
  Random random(3);
  for (const auto& [shape, point] : views()) {
    const Scene scene = lit_by(shape, true);
    for (int i = 0; i < 5000; ++i) {
      const auto sample = sample_light(scene.lights[0], scene.shapes, {point}, random.pair(), 0);
      ASSERT_TRUE(sample);
      const auto hit = scene.intersect({point, sample->wi});
      if (!hit || std::abs(hit->t - sample->distance) > 1e-3F * sample->distance)
        continue;  // at a rim, or through the light
      const float grazing = std::abs(hit->normal.dot(sample->wi));
      if (grazing < 1e-3F) continue;
      EXPECT_NEAR(light_pdf(scene.lights[0], scene.shapes, {point}, sample->wi, hit->point, hit->normal, 0) /
                      sample->pdf,
                  1, 1e-5 / grazing);
      EXPECT_FALSE(scene.occluded(point, sample->end));
    }
  }
}

TEST(AreaLights, DensityIntegratesToOne) {
  for (const auto& [shape, point] : views()) {
    const Scene scene = lit_by(shape, true);
    Random random(4);
    double sum = 0;
    int hits = 0;
    constexpr int kSide = 700;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        // Directions on a grid in the cosine with z and the azimuth.
        const double z = 2 * (i + static_cast<double>(random.uniform())) / kSide - 1;
        const double phi = 2 * kPi * (j + static_cast<double>(random.uniform())) / kSide;
        const double ring = std::sqrt((1 - z) * (1 + z));
        const V3f wi(V3d(ring * std::cos(phi), ring * std::sin(phi), z));
        const auto hit = scene.intersect({point, wi});
        if (!hit) continue;
        ++hits;
        sum += static_cast<double>(
            light_pdf(scene.lights[0], scene.shapes, {point}, wi, hit->point, hit->normal, 0));
      }
    EXPECT_NEAR(sum / (kSide * kSide) * 4 * kPi, 1, hits < 1000 ? 4 / std::sqrt(hits) : 5e-3)
        << shape.index() << " from " << point;
  }
}

// From three heights, and from the side.
TEST(SphericalRectangle, IsUniformInSolidAngle) {
  const Quad quad{{-1, -0.5, 0.3}, {3, 0, 0}, {0, 2, 0}};
  for (const V3d& from : {V3d(0.4, 0.1, 0), V3d(0.4, 0.1, 0.29), V3d(0.4, 0.1, 1.9), V3d(-1.3, 0.7, 0.5)}) {
    const auto rectangle = SphericalRectangle::project(Rectangle::of(quad).value(), from);
    ASSERT_TRUE(rectangle);
    EXPECT_NEAR(rectangle->solid_angle(), solid_angle(quad, from), 1e-12);
    const Quad part{quad.corner, quad.edge_u * 0.3, quad.edge_v * 0.6};
    int inside = 0;
    constexpr int kSide = 1000;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const Imath::V2d uv = rectangle->sample(
            {(static_cast<float>(i) + 0.5F) / kSide, (static_cast<float>(j) + 0.5F) / kSide});
        inside += uv.x < 0.3 && uv.y < 0.6;
      }
    EXPECT_NEAR(inside / double(kSide * kSide), solid_angle(part, from) / solid_angle(quad, from), 3e-4);
  }
}

TEST(SphericalRectangle, LeavesTheRestToArea) {
  const Rectangle square = Rectangle::of({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}).value();
  EXPECT_TRUE(SphericalRectangle::project(square, {0, 0, 0}));
  EXPECT_FALSE(SphericalRectangle::project(square, {0, 0, -30})) << "small";
  EXPECT_FALSE(SphericalRectangle::project(square, {0.5, 0.5, 1})) << "inside its plane";
  EXPECT_FALSE(Rectangle::of({{0, 0, 1}, {1, 0.1, 0}, {0, 1, 0}})) << "no rectangle";
}

TEST(DeltaLights, FallOffWithTheSquareOfDistance) {
  const Light bulb{"bulb", PointLight{{0, 0, 2}}, Curve(1.0)};
  const auto sample = sample_light(bulb, {}, {{0, 0, 0}}, {0, 0}, 0);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->wi, V3f(0, 0, 1));
  EXPECT_FLOAT_EQ(sample->distance, 2);
  EXPECT_FLOAT_EQ(sample->factor, 0.25F);
  EXPECT_EQ(sample->pdf, 1);
  EXPECT_EQ(sample->end, V3f(0, 0, 2));
  EXPECT_FLOAT_EQ(sample_light(bulb, {}, {{0, 0, 1.99999F}}, {0, 0}, 0)->factor,
                  1 / std::pow(2 - 1.99999F, 2.0F))
      << "very near";
  EXPECT_EQ(light_pdf(bulb, {}, {{0, 0, 0}}, {0, 0, 1}, {0, 0, 2}, {0, 0, -1}, 0), 0);
  EXPECT_FALSE(sample_light(bulb, {}, {{0, 0, 2}}, {0, 0}, 0));

  const Light spot{"spot", SpotLight{{0, 0, 2}, {0, 0, -1}, 1 - std::cos(0.5F)}, Curve(1.0)};
  const auto at_angle = [&](float angle) {
    return sample_light(spot, {}, {{2 * std::tan(angle), 0, 0}}, {0, 0}, 0);
  };
  EXPECT_TRUE(at_angle(0.49F));
  EXPECT_FALSE(at_angle(0.51F));
  EXPECT_FLOAT_EQ(at_angle(0.0F)->factor, 0.25F);
}

TEST(EnvironmentLights, ComeFromEverywhere) {
  const Light sky{"sky", EnvironmentLight{}, Curve(1.0)};
  Random random(5);
  V3d mean(0);
  double irradiance = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const auto sample = sample_light(sky, {}, {{1, 2, 3}}, random.pair(), 0);
    ASSERT_TRUE(sample);
    EXPECT_TRUE(std::isinf(sample->distance));
    mean += V3d(sample->wi);
    irradiance += std::max(0.0, static_cast<double>(sample->wi.y)) / static_cast<double>(sample->pdf);
    EXPECT_EQ(sample->pdf, light_pdf(sky, {}, {{1, 2, 3}}, sample->wi, V3f(0), V3f(0), 0));
  }
  EXPECT_LT(mean.length() / kCount, 0.01);
  EXPECT_NEAR(irradiance / kCount, kPi, 0.03);
}

// Each direction gives the irradiance of a surface that sees the whole sky.
TEST(EnvironmentLights, ComeToASideByTheCosine) {
  const Light sky{"sky", EnvironmentLight{}, Curve(1.0)};
  const V3f normal(0.48F, -0.6F, 0.64F);
  const LightSampleContext place{{1, 2, 3}, normal};
  Random random(6);
  double cosines = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const auto sample = sample_light(sky, {}, place, random.pair(), 0);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->pdf, light_pdf(sky, {}, place, sample->wi, V3f(0), V3f(0), 0));
    const double cosine = static_cast<double>(sample->wi.dot(normal));
    ASSERT_NEAR(static_cast<double>(sample->pdf) * kPi, cosine, 1e-6);
    cosines += cosine;
  }
  EXPECT_NEAR(cosines / kCount, 2.0 / 3, 0.003);
  EXPECT_EQ(light_pdf(sky, {}, place, -normal, V3f(0), V3f(0), 0), 0);
}

TEST(DeltaLights, ABeamComesFromOneDirection) {
  const Light beam{"beam", DirectionalLight{{0, 0.6F, 0.8F}}, Curve(1.0)};
  const auto sample = sample_light(beam, {}, {{1, 2, 3}}, {0.3F, 0.7F}, 0);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->wi, V3f(0, 0.6F, 0.8F));
  EXPECT_TRUE(std::isinf(sample->distance));
  EXPECT_EQ(sample->factor, 1);
  EXPECT_EQ(sample->pdf, 1);
  EXPECT_EQ(light_pdf(beam, {}, {{1, 2, 3}}, sample->wi, V3f(0), V3f(0), 0), 0);
  EXPECT_TRUE(beam.is_delta());
}

// Directions are uniform in the disc of a sun of any size. Tilted surfaces have the irradiance pi sin^2 cos.
TEST(Suns, AreDiscsAtInfinity) {
  for (const double half_angle_deg : {0.005, 0.2665, 5.0, 30.0}) {
    const double sine = std::sin(half_angle_deg * kPi / 360);
    const SunLight kind{V3f(V3d(0.48, 0.6, 0.64)), static_cast<float>(2 * sine * sine)};
    const Light sun{"sun", kind, Curve(1.0)};
    const V3d axis(0.48, 0.6, 0.64);
    const V3d normal = V3d(0, 0, 1);
    double irradiance = 0;
    int inner = 0;
    constexpr int kSide = 256;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const auto s =
            sample_light(sun, {}, {{1, 2, 3}},
                         {(static_cast<float>(i) + 0.5F) / kSide, (static_cast<float>(j) + 0.5F) / kSide}, 0);
        ASSERT_TRUE(s && std::isinf(s->distance));
        irradiance += V3d(s->wi).dot(normal) / static_cast<double>(s->pdf);
        inner += SunLight{kind.towards, kind.cap / 4}.contains(s->wi);
        // A direction on the rim may fall off it by rounding.
        if (i < kSide - 8) {
          ASSERT_EQ(light_pdf(sun, {}, {{1, 2, 3}}, s->wi, V3f(0), V3f(0), 0), s->pdf);
        }
      }
    const double all = kPi * std::pow(std::sin(half_angle_deg * kPi / 180), 2);
    EXPECT_NEAR(irradiance / (kSide * kSide) / (all * axis.dot(normal)), 1, 1e-5) << half_angle_deg;
    EXPECT_NEAR(kind.projected_solid_angle() / all, 1, 1e-6);
    EXPECT_NEAR(inner / double(kSide * kSide), 0.25, 2e-3) << half_angle_deg;
    // The fraction of directions in a cone of twice its height that hit it.
    Random random(7);
    int shown = 0;
    constexpr int kCount = 400000;
    for (int i = 0; i < kCount; ++i)
      shown += light_pdf(sun, {}, {{0, 0, 0}},
                         direction_about(kind.towards, random.uniform() * 2 * kind.cap,
                                         random.uniform() * 2 * std::numbers::pi_v<float>),
                         V3f(0), V3f(0), 0) > 0;
    EXPECT_NEAR(shown / double(kCount), 0.5, 4e-3) << half_angle_deg;
  }
}

TEST(Lights, EmitTheirPower) {
  const auto watts = [](const Light& light) { return power(light, 3)(555); };
  EXPECT_NEAR(watts(lit_by(Quad{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}).lights[0]), 6 * kPi, 1e-12);
  EXPECT_NEAR(watts(lit_by(Sphere{{0, 0, 0}, 2}, true).lights[0]), 32 * kPi * kPi, 1e-10);
  EXPECT_NEAR(watts({"", PointLight{{0, 0, 0}}, Curve(2.0)}), 8 * kPi, 1e-12);
  EXPECT_NEAR(watts({"", SpotLight{{0, 0, 0}, {0, 0, 1}, 0.5F}, Curve(2.0)}), 2 * kPi, 1e-12);
  EXPECT_NEAR(watts({"", EnvironmentLight{}, Curve(1.0)}), 36 * kPi * kPi, 1e-10);
  EXPECT_NEAR(watts({"", DirectionalLight{}, Curve(2.0)}), 18 * kPi, 1e-12);
  EXPECT_NEAR(watts({"", SunLight{{0, 0, 1}, 0.5F}, Curve(1.0)}), 9 * kPi * 0.75 * kPi, 1e-10);
}

TEST(Lights, EmitFromWhereTheyAre) {
  Random random(6);
  const Scene scene = lit_by(Quad{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}, true);
  for (int i = 0; i < 100; ++i) {
    const EmissionPoint from = sample_emission_point(scene.lights[0], scene.shapes, random.pair(), 0);
    EXPECT_FLOAT_EQ(from.pdf_area, 1.0F / 6);
    EXPECT_EQ(from.normal, V3f(0, 0, 1));
    EXPECT_TRUE(from.point.x >= 0 && from.point.x <= 2 && from.point.y >= 0 && from.point.y <= 3 &&
                from.point.z == 0);
  }
  const EmissionPoint bulb = sample_emission_point({"", PointLight{{1, 2, 3}}, Curve(1.0)}, {}, {0, 0}, 0);
  EXPECT_EQ(bulb.point, V3f(1, 2, 3));
  EXPECT_EQ(bulb.normal, V3f(0, 0, 0));
  EXPECT_EQ(bulb.pdf_area, 1);
}

}  // namespace
}  // namespace abbe
