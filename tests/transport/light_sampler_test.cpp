#include <array>
#include <cmath>
#include <ctime>
#include <memory>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "sampling/sampler.h"
#include "scene/shapes/ray.h"
#include "tests/tier.h"
#include "transport/plan/light_sampler.h"

namespace abbe {
namespace {

using Imath::V3f;

// Four random numbers in [0, 1), number `i` of the given kind.
std::array<float, 4> numbers(std::uint32_t i, std::uint32_t kind = 0) {
  return Sampler(11, Purpose::pilot, 0, kind, i).group(0);
}

V3f direction(float u, float v) {
  return direction_about({0, 0, 1}, 2 * u, 2 * std::numbers::pi_v<float> * v);
}

struct Hall {
  Scene scene{};
  std::vector<double> seen;

  void add(Light light, double as_seen) {
    scene.lights.push_back(std::move(light));
    seen.push_back(as_seen);
  }
  void add_shape(const char* name, Shape shape, bool two_sided, double as_seen) {
    const auto index = static_cast<std::uint32_t>(scene.shapes.size());
    scene.shapes.push_back({name, std::move(shape), 0, static_cast<std::int32_t>(scene.lights.size())});
    add({name, AreaLight{index, two_sided}, Curve(1.0)}, as_seen);
  }
  LightSampler sampler(bool scattering_finds = true) {
    scene.commit();
    return {scene, seen, scattering_finds};
  }
};

Hall empty_hall() {
  Hall hall;
  hall.scene.camera = {Pinhole{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.05, 0.005}, 4, 4, 0.01};
  hall.scene.materials = {{"card", DiffuseMaterial{Curve(0.5)}}};
  hall.scene.channels = {energy_channel("all", Curve(1.0))};
  hall.scene.shapes.push_back({"floor", Quad{{-20, -20, 0}, {40, 0, 0}, {0, 40, 0}}, 0});
  return hall;
}

// One light of each kind, and `lamps` more of several kinds and strengths, distributed over the hall.
Hall mixed_hall(std::uint32_t lamps) {
  Hall hall = empty_hall();
  hall.add_shape("panel", Quad{{-1, -1, 3}, {0, 2, 0}, {2, 0, 0}}, false, 2);
  hall.add_shape("sheet", Disc{{3, 0, 2}, {1, 0, 0}, 0.5}, true, 1);
  hall.add_shape("ball", Sphere{{-3, 2, 1}, 0.3}, false, 5);
  hall.add_shape("roof", Mesh{{{0, 0, 5}, {1, 0, 5}, {0, 1, 5}, {0, 0, 5.5}}, {{{0, 2, 1}}, {{0, 1, 3}}}},
                 false, 3);
  hall.add({"point", PointLight{{1, 1, 1}}, Curve(1.0)}, 4);
  hall.add({"spot", SpotLight{{0, -2, 4}, V3f(0, 0, -1), 0.1F}, Curve(1.0)}, 10);
  hall.add({"dark", PointLight{{0, 0, 2}}, Curve(1.0)}, 0);
  hall.add({"sky", EnvironmentLight{}, Curve(1.0)}, 0.1);
  hall.add({"beam", DirectionalLight{V3f(0, 0.6F, 0.8F)}, Curve(1.0)}, 0.3);
  hall.add({"sun", SunLight{V3f(0.6F, 0, 0.8F), 1e-3F}, Curve(1.0)}, 100);
  for (std::uint32_t i = 0; i < lamps; ++i) {
    const auto u = numbers(i, 1);
    const V3f at(40 * u[0] - 20, 40 * u[1] - 20, 6 * u[2]);
    const double strength = std::exp(4 * static_cast<double>(u[3]));
    if (i % 3 == 0)
      hall.add({"lamp", PointLight{at}, Curve(1.0)}, strength);
    else if (i % 3 == 1)
      hall.add({"lamp", SpotLight{at, direction(u[3], u[0]), 0.3F}, Curve(1.0)}, strength);
    else
      hall.add_shape("lamp", Quad{Imath::V3d(at), {0, 0.1, 0}, {0.1, 0, 0}}, false, 100 * strength);
  }
  return hall;
}

// Vertex among the lights; every third one is without orientation, every second one is glossy.
LightSampleContext place_among_lamps(std::uint32_t i) {
  const auto u = numbers(i, 2);
  const V3f point(24 * u[0] - 12, 24 * u[1] - 12, 6 * u[2]);
  return {point, i % 3 == 0 ? std::nullopt : std::optional(direction(u[3], u[1])), i % 2 == 0};
}

TEST(LightSampler, ProbabilitiesSumToOne) {
  for (const std::uint32_t lamps : {0U, 7U, 300U, 3000U}) {
    Hall hall = mixed_hall(lamps);
    const LightSampler sampler = hall.sampler();
    for (std::uint32_t i = 0; i < 200; ++i) {
      const LightSampleContext at = place_among_lamps(i);
      double sum = 0;
      for (std::uint32_t light = 0; light < hall.scene.lights.size(); ++light) {
        const float p = sampler.probability(light, at);
        EXPECT_EQ(p > 0, hall.seen[light] > 0);
        sum += static_cast<double>(p);
      }
      ASSERT_NEAR(sum, 1, 1e-5) << lamps << " lamps, place " << i;
    }
  }
}

// On a grid of random numbers each light is picked in proportion to its probability, up to one grid step at
// each end of its interval and float rounding.
TEST(LightSampler, PicksAsOftenAsItSays) {
  for (const std::uint32_t lamps : {5U, 300U}) {
    Hall hall = mixed_hall(lamps);
    const LightSampler sampler = hall.sampler();
    for (std::uint32_t i = 0; i < 12; ++i) {
      const LightSampleContext at = place_among_lamps(i);
      constexpr int kPicks = 1 << 16;
      std::vector<int> counts(hall.scene.lights.size());
      for (int k = 0; k < kPicks; ++k) {
        const auto pick = sampler.pick(at, (static_cast<float>(k) + 0.5F) / static_cast<float>(kPicks));
        ASSERT_EQ(pick.probability, sampler.probability(pick.light, at));
        ++counts[pick.light];
      }
      for (std::uint32_t light = 0; light < counts.size(); ++light) {
        const float p = sampler.probability(light, at);
        ASSERT_NEAR(counts[light], static_cast<double>(p) * kPicks, 2.1) << hall.scene.lights[light].name;
      }
    }
  }
}

TEST(LightSampler, WeighsWhatComesToThePlace) {
  Hall hall = empty_hall();
  hall.add({"near", PointLight{{0, 0, 1}}, Curve(1.0)}, 1);
  hall.add({"twice as far", PointLight{{0, 0, 2}}, Curve(1.0)}, 1);
  hall.add({"beam", DirectionalLight{V3f(0, 0.6F, 0.8F)}, Curve(1.0)}, 1);
  hall.add({"sky", EnvironmentLight{}, Curve(1.0)}, 1);
  const LightSampler sampler = hall.sampler();
  const V3f point(0);
  const V3f up(0, 0, 1);
  const auto expect = [&](const LightSampleContext& place, const std::array<double, 4>& irradiance) {
    const double all = std::accumulate(irradiance.begin(), irradiance.end(), 0.0);
    for (std::uint32_t i = 0; i < 4; ++i)
      EXPECT_NEAR(sampler.probability(i, place), 0.9 * irradiance[i] / all + 0.1 / 4, 1e-6) << i;
  };
  expect({point, up}, {1, 0.25, 0.8, std::numbers::pi});
  expect({point}, {1, 0.25, 1, 4 * std::numbers::pi});
  const V3f down(0, 0, -1);
  expect({point, down}, {0, 0, 0, std::numbers::pi});
  // Glossy vertices leave the sky to scattering.
  expect({point, up, true}, {1, 0.25, 0.8, 0});
  expect({point, std::nullopt, true}, {1, 0.25, 1, 0});
}

// Without scattering, connections must find it. The light of an image depends on direction.
TEST(LightSampler, LeavesAmbientLightToLobesWhereBothAreBalanced) {
  const V3f up(0, 0, 1);
  const auto sky_of = [&up](EnvironmentLight sky, bool scattering_finds) {
    Hall hall = empty_hall();
    hall.add({"lamp", PointLight{{0, 0, 1}}, Curve(1.0)}, std::numbers::pi);
    hall.add({"sky", std::move(sky), Curve(1.0)}, 1);
    return hall.sampler(scattering_finds).probability(1, {V3f(0), up, true});
  };
  const auto image = std::make_shared<const EnvironmentImage>(
      2, 1, std::vector<std::array<float, 3>>{{1, 1, 1}, {2, 2, 2}}, environment_frame({0, 0, 1}, 0),
      Curve(1.0), std::vector{energy_channel("all", Curve(1.0))});
  EXPECT_FLOAT_EQ(sky_of({}, true), 0.05F);
  EXPECT_FLOAT_EQ(sky_of({}, false), 0.5F);
  EXPECT_FLOAT_EQ(sky_of({image}, true), 0.5F);
}

// A light behind the receiver, or facing away from it, has only its part of the defensive tenth.
TEST(LightSampler, LeavesWhatCannotShineItsFloor) {
  for (const std::uint32_t lamps : {2U, 400U}) {
    Hall hall = empty_hall();
    for (std::uint32_t i = 0; i < lamps; ++i) {
      const auto u = numbers(i, 3);
      hall.add({"lamp", PointLight{{10 * u[0], 10 * u[1], 1 + u[2]}}, Curve(1.0)}, 1);
    }
    hall.add({"below", PointLight{{1, 1, -1}}, Curve(1.0)}, 1000);
    hall.add({"beside", SpotLight{{5, 5, 30}, V3f(1, 0, 0), 0.1F}, Curve(1.0)}, 1000);
    hall.add_shape("averted", Quad{{0, 0, 3}, {1, 0, 0}, {0, 1, 0}}, false, 1000);
    const LightSampler sampler = hall.sampler();
    const V3f up(0, 0, 1);
    const float floor = 0.1F / static_cast<float>(lamps + 3);
    for (std::uint32_t i = 0; i < 100; ++i) {
      const auto u = numbers(i, 4);
      const V3f point(10 * u[0], 10 * u[1], 0.5F * u[2]);
      EXPECT_NEAR(sampler.probability(lamps, {point, up}), floor, 1e-8F);
      EXPECT_NEAR(sampler.probability(lamps + 1, {point, up}), floor, 1e-8F);
      EXPECT_NEAR(sampler.probability(lamps + 2, {point, up}), floor, 1e-8F);
      EXPECT_NEAR(sampler.probability(lamps + 2, {point}), floor, 1e-8F);
    }
  }
}

TEST(LightSampler, OneLightIsCertainAndNoneIsNoChoice) {
  Hall one = empty_hall();
  one.add({"dark", PointLight{{0, 0, 2}}, Curve(1.0)}, 0);
  one.add({"lamp", PointLight{{0, 0, 2}}, Curve(1.0)}, 3);
  const LightSampler sampler = one.sampler();
  const V3f down(0, 0, -1);
  EXPECT_EQ(sampler.pick({V3f(0), down}, 0.7F).light, 1U);
  EXPECT_EQ(sampler.pick({V3f(0), down}, 0.7F).probability, 1);
  EXPECT_EQ(sampler.probability(1, {V3f(0), down}), 1);
  EXPECT_EQ(sampler.probability(0, {V3f(0), down}), 0);
  Hall none = empty_hall();
  none.add({"dark", PointLight{{0, 0, 2}}, Curve(1.0)}, 0);
  EXPECT_TRUE(none.sampler().empty());
}

// Vertices on a light, within one, among lights at one point, and in chains of lights, each half as far from
// the previous one.
TEST(LightSampler, IsFiniteAnywhere) {
  Hall hall = empty_hall();
  hall.add_shape("ball", Sphere{{0, 0, 1}, 0.5}, false, 1);
  hall.add_shape("speck", Sphere{{0, 0, 3}, 1e-9}, false, 1);
  for (int i = 0; i < 100; ++i) hall.add({"same", PointLight{{1, 1, 1}}, Curve(1.0)}, 1);
  for (int i = 0; i < 120; ++i) hall.add({"chain", PointLight{{std::ldexp(1.0F, -i), 0, 0}}, Curve(1.0)}, 1);
  for (int i = 0; i < 40; ++i) hall.add({"beam", DirectionalLight{V3f(0, 0, 1)}, Curve(1.0)}, 1e-30);
  hall.add({"far", PointLight{{0, 0, 1e11F}}, Curve(1.0)}, 1e20);
  const LightSampler sampler = hall.sampler();
  const V3f side(1, 0, 0);
  for (const V3f& point :
       {V3f(1, 1, 1), V3f(0, 0, 1), V3f(0, 0, 1.5F), V3f(0, 0, 3), V3f(0), V3f(1e-30F, 0, 0)}) {
    double sum = 0;
    for (std::uint32_t i = 0; i < hall.scene.lights.size(); ++i)
      sum += static_cast<double>(sampler.probability(i, {point, side}));
    EXPECT_NEAR(sum, 1, 1e-5) << point;
    for (std::uint32_t i = 0; i < 64; ++i) {
      const auto pick = sampler.pick({point, side}, numbers(i)[0]);
      EXPECT_EQ(pick.probability, sampler.probability(pick.light, {point, side}));
    }
  }
}

// Ten thousand small panels below a ceiling. The second moment of E_i/p_i, over the square of the sum of all
// E_i, is 1 for the ideal p_i in proportion to E_i. The uniform tenth alone makes it 1/0.9.
TEST(LightSampler, ManyLampsCostLittleMoreThanTheIdealChoice) {
  Hall hall = empty_hall();
  constexpr std::uint32_t kLamps = 10000;
  std::vector<V3f> at;
  for (std::uint32_t i = 0; i < kLamps; ++i) {
    const auto u = numbers(i, 5);
    at.emplace_back(40 * u[0] - 20, 40 * u[1] - 20, 4 + u[2]);
    hall.add_shape("lamp", Quad{Imath::V3d(at.back()), {0, 0.02, 0}, {0.02, 0, 0}}, false,
                   std::exp(2 * static_cast<double>(u[3])));
  }
  const LightSampler sampler = hall.sampler();
  double ours = 0;
  double by_power = 0;
  constexpr std::uint32_t kPlaces = 64;
  const double power = std::accumulate(hall.seen.begin(), hall.seen.end(), 0.0);
  for (std::uint32_t k = 0; k < kPlaces; ++k) {
    const auto u = numbers(k, 6);
    const V3f point(30 * u[0] - 15, 30 * u[1] - 15, 3.5F * u[2]);
    const V3f up(0, 0, 1);
    double sum = 0;
    double moment = 0;
    double moment_by_power = 0;
    for (std::uint32_t i = 0; i < kLamps; ++i) {
      const V3f way = at[i] - point;
      const double e = hall.seen[i] * std::pow(static_cast<double>(way.z), 2) /
                       std::pow(static_cast<double>(way.length2()), 2);
      sum += e;
      moment += e * e / static_cast<double>(sampler.probability(i, {point, up}));
      moment_by_power += e * e * power / hall.seen[i];
    }
    ours += moment / (sum * sum) / kPlaces;
    by_power += moment_by_power / (sum * sum) / kPlaces;
  }
  RecordProperty("second_moment", std::to_string(ours));
  RecordProperty("second_moment_by_power", std::to_string(by_power));
  EXPECT_LT(ours, 1.5);
  EXPECT_GT(by_power, 8);
}

// Ten times as many lights take hardly more than ten times as long, since they are sorted.
TEST(LightSampler, IsBuiltInTheTimeThatSortingTakes) {
  const auto seconds = [](std::uint32_t lamps) {
    Hall hall = mixed_hall(lamps);
    hall.scene.commit();
    const std::clock_t start = std::clock();  // CPU time of this process: others may use the machine
    const LightSampler sampler(hall.scene, hall.seen, true);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  const std::uint32_t few = test::nightly() ? 10000 : 3000;
  EXPECT_LT(seconds(10 * few), 30 * seconds(few));
}

}  // namespace
}  // namespace abbe
