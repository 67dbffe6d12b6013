#include <gtest/gtest.h>

#include <vector>

#include "transport/path/dimensions.h"
#include "transport/technique/light.h"
#include "transport/technique/path.h"

namespace abbe {
namespace {

constexpr int kFilmEdge = 4;

// Corner of a room of white cards with a point light and an area light, viewed by a pinhole camera; fog on
// request.
Scene corner(bool fog) {
  Scene scene{};
  scene.camera = {Pinhole{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.05, 0.005}, kFilmEdge, kFilmEdge,
                  0.01};
  scene.materials = {{"card", DiffuseMaterial{Curve(0.9)}}};
  scene.channels = {energy_channel("all", Curve(1.0))};
  scene.shapes.push_back({"back", Quad{{-5, -5, 5}, {0, 10, 0}, {10, 0, 0}}, 0});
  scene.shapes.push_back({"floor", Quad{{-5, -3, 0}, {0, 0, 5}, {10, 0, 0}}, 0});
  scene.shapes.push_back({"panel", Quad{{-1, 3, 2}, {1, 0, 0}, {0, 0, 1}}, 0, 1});
  scene.lights.push_back({"lamp", PointLight{{0, 0, 2}}, Curve(1.0)});
  scene.lights.push_back({"panel", AreaLight{2, true}, Curve(1.0)});
  if (fog) {
    MediumMaterial thin;
    thin.interior_medium.scattering_per_m = Curve(0.1);
    scene.materials.push_back({"fog", thin});
    scene.shapes.push_back({"fog", Sphere{{0, 0, 0}, 20}, 1});
  }
  scene.render.integrator = Integrator::light;
  scene.commit();
  return scene;
}

// Traces one path with all its rays and deposits; all must have the same time.
template <typename Trace>
void expect_time(float time, const Scene& scene, Trace trace) {
  std::vector<LoggedRay> log;
  RayCaster caster(scene, &log);
  int deposits = 0;
  trace(caster, [&](std::uint32_t, const FilmPoint& at, std::span<const double>) {
    EXPECT_EQ(at.time, time);
    ++deposits;
  });
  EXPECT_FALSE(log.empty());
  for (const LoggedRay& one : log) EXPECT_EQ(one.ray.time, time);
}

TEST(Time, IsOneFromTheFirstRayToTheDeposit) {
  for (const bool fog : {false, true}) {
    const Scene scene = corner(fog);
    const Plan plan = make_plan(scene);
    for (std::uint32_t i = 0; i < 200; ++i) {
      const Sampler camera(3, Purpose::camera, 0, 5, i);
      expect_time(camera.group(kFilmGroup)[kTimeIndex], scene,
                  [&](RayCaster& caster, const Deposit& deposit) {
                    PathTracer(plan, caster).trace(std::vector<PixelSample>{{1, 1, camera}}, deposit);
                  });
      const Sampler photon(3, Purpose::light, 0, 5, i);
      expect_time(photon.group(kPhotonGuideGroup)[kTimeIndex], scene,
                  [&](RayCaster& caster, const Deposit& deposit) {
                    LightTracer(plan, caster, 1).trace(std::vector<Sampler>{photon}, deposit);
                  });
    }
  }
}

// Uniform independent numbers have no covariance, and a variance of 1/12.
TEST(Time, IsUniformAndIndependentOfTheFilmPosition) {
  constexpr std::uint32_t kCount = 1 << 14;
  for (const auto& [purpose, group] :
       {std::pair(Purpose::camera, kFilmGroup), std::pair(Purpose::light, kPhotonGuideGroup)}) {
    std::array<double, 4> covariance{};
    double mean = 0;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const std::array<float, 4> u = Sampler(9, purpose, 0, i % 16, i / 16).group(group);
      const double time = static_cast<double>(u[kTimeIndex]);
      mean += time / kCount;
      for (std::size_t k = 0; k < 4; ++k)
        covariance[k] += (time - 0.5) * (static_cast<double>(u[k]) - 0.5) / kCount;
    }
    EXPECT_NEAR(mean, 0.5, 2e-3);
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(covariance[k], k == kTimeIndex ? 1.0 / 12 : 0, 2e-3) << "number " << k;
  }
}

}  // namespace
}  // namespace abbe
