#include <algorithm>

#include <gtest/gtest.h>

#include "sampling/sampler.h"
#include "transport/render/trained_plan.h"

namespace abbe {
namespace {

Scene lamps_over_glass(std::size_t count) {
  Scene scene{};
  scene.camera = {Pinhole{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.05, 0.005}, 4, 4, 0.01};
  scene.materials = {{"card", DiffuseMaterial{Curve(0.5)}},
                     {"glass", DielectricMaterial{"glass", RefractiveIndex(1.5)}}};
  scene.channels = {energy_channel("all", Curve(1.0))};
  scene.shapes.push_back({"floor", Quad{{-5, -5, 5}, {0, 10, 0}, {10, 0, 0}}, 0});
  scene.shapes.push_back({"ball", Sphere{{0, 0, 4}, 0.2}, 1});
  for (std::size_t i = 0; i < count; ++i)
    scene.lights.push_back(
        {"lamp", PointLight{{static_cast<float>(i) * 1e-3F, 0, 2}}, Curve(1.0 + static_cast<double>(i))});
  scene.commit();
  return scene;
}

TEST(Plan, ChoosesTechniquesByIntegratorAndNeed) {
  const auto techniques = [](Integrator integrator, std::size_t lamps, double power) {
    Scene scene = lamps_over_glass(lamps);
    scene.render.integrator = integrator;
    for (Light& light : scene.lights) light.emission = Curve(power);
    scene.commit();
    return make_plan(scene).techniques;
  };
  using List = std::vector<Technique>;
  EXPECT_EQ(techniques(Integrator::automatic, 1, 1), (List{Technique::path, Technique::light}));
  EXPECT_EQ(techniques(Integrator::automatic, 0, 1), List{Technique::path});
  EXPECT_EQ(techniques(Integrator::automatic, 1, 0), List{Technique::path});
  EXPECT_EQ(techniques(Integrator::path, 1, 1), List{Technique::path});
  EXPECT_EQ(techniques(Integrator::light, 1, 1), List{Technique::light});
  EXPECT_EQ(techniques(Integrator::light, 1, 0), List{}) << "a lamp without power";
}

// Glossy vertices leave the sky to scattering if scattering counts in addition to connections.
TEST(Plan, ConnectsGlossyPlacesToTheSkyWhereNothingElseFindsIt) {
  const auto sky = [](Integrator integrator, LightStrategy lights) {
    Scene scene = lamps_over_glass(1);
    scene.lights.push_back({"sky", EnvironmentLight{}, Curve(1.0)});
    scene.render.integrator = integrator;
    scene.render.sampling.lights = lights;
    scene.commit();
    return make_plan(scene).path_lights.probability(1, {{0, 0, 5}, Imath::V3f(0, 0, -1), true});
  };
  for (const Integrator balanced :
       {Integrator::automatic, Integrator::path, Integrator::bdpt, Integrator::vcm})
    EXPECT_FLOAT_EQ(sky(balanced, LightStrategy::mis), 0.05F);
  EXPECT_GT(sky(Integrator::path, LightStrategy::light), 0.5F);
  EXPECT_GT(sky(Integrator::photon_map, LightStrategy::mis), 0.5F);
  EXPECT_GT(sky(Integrator::sppm, LightStrategy::mis), 0.5F);
}

TEST(Plan, RefusesWhatFloatsCannotTellFromNothing) {
  const auto refused = [](double power, double exposure_s) {
    Scene scene = lamps_over_glass(1);
    scene.lights[0].emission = Curve(power);
    scene.exposure_s = exposure_s;
    scene.commit();
    return refusal(scene).has_value();
  };
  EXPECT_FALSE(refused(1e-10, 1e-15));
  EXPECT_FALSE(refused(0, 1));
  EXPECT_TRUE(refused(1, 1e-36));
  EXPECT_TRUE(refused(1e-36, 1));
}

TEST(Plan, AimsTheStrongestOfManyLamps) {
  const Scene scene = lamps_over_glass(300);
  const Plan plan = make_plan(scene);
  ASSERT_EQ(plan.guides.photon_guides.size(), 300U);
  for (std::size_t i = 0; i < 300; ++i) EXPECT_EQ(plan.guides.photon_guides[i].is_guided(), i >= 172) << i;
  const Scene few_scene = lamps_over_glass(3);
  const Plan few = make_plan(few_scene);
  EXPECT_TRUE(std::all_of(few.guides.photon_guides.begin(), few.guides.photon_guides.end(),
                          [](const PhotonGuide& aim) { return aim.is_guided(); }));
  const Scene dark_scene = lamps_over_glass(0);
  EXPECT_TRUE(make_plan(dark_scene).guides.photon_guides.empty());
}

// Thousands of lights of one kind leave as many wavelengths to a light of another kind as one would.
TEST(Plan, EqualEmissionsCountOnce) {
  const auto red_share = [](std::size_t blue_lamps) {
    Scene scene = lamps_over_glass(blue_lamps);
    for (Light& light : scene.lights) light.emission = Curve({{400, 0}, {450, 1}, {500, 0}});
    scene.lights.push_back({"red", PointLight{{1, 0, 2}}, Curve({{600, 0}, {650, 1}, {700, 0}})});
    scene.commit();
    return make_plan(scene).wavelengths.pdf(650);
  };
  EXPECT_DOUBLE_EQ(red_share(1000), red_share(1));
  EXPECT_GT(red_share(1), 0.003);
}

// Lights that differ in strength alone have their own strengths.
TEST(Plan, ProportionalEmissionsCountOnce) {
  const auto plan_of = [](bool shared) {
    Scene scene = lamps_over_glass(3);
    const auto blue = std::make_shared<const Curve>(std::vector<Knot>{{400, 0}, {450, 1}, {500, 0}});
    for (std::size_t i = 0; i < 3; ++i) {
      const ScaledCurve emission(blue, static_cast<double>(1U << i));
      scene.lights[i].emission = shared ? emission : ScaledCurve(emission.curve());
    }
    scene.commit();
    return std::pair(make_plan(scene).traced_lights.probability(2), make_plan(scene).wavelengths.pdf(430));
  };
  EXPECT_EQ(plan_of(true), plan_of(false));
  EXPECT_NEAR(plan_of(true).first, 0.9F * 4 / 7 + 0.1F / 3, 1e-6F);
}

TEST(Plan, IsTheSameOfAnySeedOnAnyNumberOfThreads) {
  Scene scene = lamps_over_glass(2);
  const Plan one = make_trained_plan(scene, 1);
  scene.render.seed = 7;
  const Plan four = make_trained_plan(scene, 4);
  const Plan unlearned = [&] {
    Plan plan = one;
    for (PhotonGuide& aim : plan.guides.photon_guides) aim = PhotonGuide({0, 0, 2}, 0, {0, 0, 4}, 0.35F);
    return plan;
  }();
  int learned = 0;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const auto u = Sampler(2, Purpose::pilot, 0, 0, i).group(0);
    for (std::size_t light = 0; light < 2; ++light) {
      const EmissionPoint from = sample_emission_point(scene.lights[light], scene.shapes, {0, 0}, 0);
      const auto aimed = [&](const Plan& plan) {
        return plan.guides.photon_guides[light].sample(scene.lights[light], from, u[2], {u[0], u[1]}, 0);
      };
      ASSERT_EQ(aimed(one).wi, aimed(four).wi) << i;
      ASSERT_EQ(aimed(one).pdf, aimed(four).pdf) << i;
      learned += aimed(one).wi != aimed(unlearned).wi ? 1 : 0;
    }
  }
  EXPECT_GT(learned, 4096) << "the aims have learned nothing that could differ";
}

TEST(PowerLightSampler, PicksAsOftenAsItSays) {
  std::vector<double> weights;
  for (int i = 0; i < 10000; ++i) weights.push_back(i % 3 == 0 ? 0 : 1 + i % 7);
  const PowerLightSampler picker(weights);
  std::vector<int> counts(weights.size());
  constexpr int kPicks = 1 << 21;
  for (int i = 0; i < kPicks; ++i) {
    const PowerLightSampler::SampledLight pick = picker.pick((static_cast<float>(i) + 0.5F) / kPicks);
    ASSERT_EQ(pick.probability, picker.probability(pick.light));
    ++counts[pick.light];
  }
  for (std::size_t i = 0; i < weights.size(); ++i)
    ASSERT_NEAR(counts[i], static_cast<double>(picker.probability(static_cast<std::uint32_t>(i))) * kPicks,
                2.1)
        << i;
}

}  // namespace
}  // namespace abbe
