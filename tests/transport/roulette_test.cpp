#include <cmath>

#include <gtest/gtest.h>

#include "transport/render/render.h"

// Russian roulette does not change the mean of paths.

namespace abbe {
namespace {

// A camera at the center of a ball that emits and reflects diffusely inside: the radiance is uniform.
Scene furnace(double reflectance, Integrator integrator, int roulette_depth) {
  Scene scene{};
  scene.camera = {Pinhole{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.05, 0.005}, 16, 16, 0.01};
  scene.materials = {{"wall", DiffuseMaterial{Curve(reflectance)}}};
  scene.channels = {energy_channel("all", Curve(1.0))};
  scene.shapes.push_back({"wall", Sphere{{0, 0, 0}, 2}, 0});
  scene.lights.push_back({"glow", AreaLight{0, true}, Curve(1.0)});
  scene.render.integrator = integrator;
  scene.render.roulette_depth = roulette_depth;
  scene.render.samples = 64;
  scene.commit();
  return scene;
}

Film::Average mean_of(const Scene& scene) {
  return render(scene, {.threads = 1}).film.average(0);
}

// L = Le/(1 - rho). The fraction rho^9 of it has had more than eight scattering events. Light tracing alone
// excludes Le itself, which the camera receives from the emitter.
TEST(NightlyRoulette, LeavesTheMeanOfAFurnaceWhateverTheDepthItBeginsAt) {
  const Film::Average emitted = mean_of(furnace(0, Integrator::path, 4));
  for (const Integrator integrator : {Integrator::path, Integrator::bdpt, Integrator::light})
    for (const double reflectance : {0.5, 0.9})
      for (const int depth : {0, 4, 9}) {
        const Film::Average found = mean_of(furnace(reflectance, integrator, depth));
        const double left_out = integrator == Integrator::light ? 1 : 0;
        const double ratio = 1 / (1 - reflectance) - left_out;
        const double error = std::hypot(found.standard_error, emitted.standard_error * ratio);
        EXPECT_LT(error, 0.02 * found.mean);
        EXPECT_NEAR(found.mean, emitted.mean * ratio, 5 * error)
            << integrator_name(integrator) << ", reflectance " << reflectance << ", roulette from event "
            << depth << ": " << found.mean / (emitted.mean * ratio);
      }
}

}  // namespace
}  // namespace abbe
