#include "transport/render/pass.h"

#include <cstdint>

#include <gtest/gtest.h>

// Interruptions of a pass between any two of its work items.

namespace abbe {
namespace {

// A ball of glass over a card under a small light, on a film of 20 tiles, whose photons are two batches.
Scene glass_on_card(Integrator integrator) {
  Scene scene{};
  scene.camera = {Pinhole{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.05, 0.001}, 80, 64, 0.01};
  scene.materials = {{"card", DiffuseMaterial{Curve(0.5)}},
                     {"glass", DielectricMaterial{"glass", RefractiveIndex(1.5)}}};
  scene.channels = {energy_channel("all", Curve(1.0))};
  scene.shapes.push_back({"card", Quad{{-5, -5, 5}, {0, 10, 0}, {10, 0, 0}}, 0});
  scene.shapes.push_back({"ball", Sphere{{0, 0, 4}, 0.6}, 1});
  scene.shapes.push_back({"lamp", Sphere{{1, 1, 2}, 0.1}, 0});
  scene.lights.push_back({"lamp", AreaLight{2, false}, Curve(1.0)});
  scene.render.integrator = integrator;
  scene.render.photons.per_sample = 5000;
  scene.commit();
  return scene;
}

constexpr SampleRange kPassSamples{0, 2};

Film film_of(const Plan& plan) {
  const Camera& camera = plan.scene.camera;
  return {camera.width, camera.height, 1, 2, plan.nominal_value, plan.photons, plan.path_interval};
}

// Runs the pass until that many more items are done, or one more where they end with a sample.
std::uint32_t run_items(const Plan& plan, Film& film, std::uint32_t done, std::uint32_t more) {
  Pass pass(plan, film, {}, kPassSamples, done, 7);
  std::uint32_t count = 0;
  (void)pass.run(1, [&] { return ++count >= more; });
  return pass.done();
}

TEST(Pass, ResumedAfterAnyItemIsThePassThatWasLeftAlone) {
  for (const Integrator integrator :
       {Integrator::path, Integrator::automatic, Integrator::light, Integrator::bdpt, Integrator::sppm}) {
    const Scene scene = glass_on_card(integrator);
    const Plan plan = make_plan(scene);
    Film whole = film_of(plan);
    Pass pass(plan, whole, {}, kPassSamples, 0, 7);
    (void)pass.run(1, [] { return false; });
    ASSERT_TRUE(pass.finished());
    const std::uint32_t items = pass.done();
    ASSERT_GE(items, 2U) << integrator_name(integrator);
    Film one_by_one = film_of(plan);
    for (std::uint32_t done = 0; done < items;) {
      const std::uint32_t after = run_items(plan, one_by_one, done, 1);
      ASSERT_TRUE(after == done + 1 || after == done + 2) << integrator_name(integrator);
      done = after;
    }
    EXPECT_TRUE(one_by_one.bytes() == whole.bytes()) << integrator_name(integrator);
    Film in_two = film_of(plan);
    run_items(plan, in_two, run_items(plan, in_two, 0, items / 2), items);
    EXPECT_TRUE(in_two.bytes() == whole.bytes()) << integrator_name(integrator);
  }
}

}  // namespace
}  // namespace abbe
