#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "transport/render/render.h"

// Probes so close to a light, or so far from one on their horizon, that rounding to single precision could
// matter.

namespace abbe {
namespace {

constexpr std::array kIntegrators{Integrator::path, Integrator::automatic, Integrator::bdpt,
                                  Integrator::vcm,  Integrator::sppm,      Integrator::photon_map};

// A probe and a unit sphere of constant radiance.
Scene meter_of_sphere(const ProbePoint& meter, const Imath::V3d& center, double radiance,
                      Integrator integrator) {
  Scene scene{};
  scene.camera = {IrradianceProbe{meter}, 8, 8, 1};
  scene.materials = {{"black", DiffuseMaterial{Curve(0.0)}}};
  scene.channels = {energy_channel("all", Curve(1.0))};
  scene.shapes.push_back({"light", Sphere{center, 1}, 0});
  scene.lights.push_back({"light", AreaLight{0, false}, Curve(radiance)});
  scene.render.integrator = integrator;
  scene.render.samples = 128;
  scene.render.photons.per_sample = 64;
  scene.commit();
  return scene;
}

// Expects the film value of an irradiance [W m^-2 nm^-1] over 800 nm and one second.
void expect_irradiance(const Scene& scene, double irradiance, const std::string& what) {
  const Film::Average found = render(scene, {.threads = 1}).film.average(0);
  const double expected = irradiance * (kMaxWavelengthNm - kMinWavelengthNm);
  EXPECT_LT(found.standard_error, 6e-3 * expected) << what;
  EXPECT_NEAR(found.mean / expected, 1, 4 * found.standard_error / expected + 1e-3) << what;
}

// E = pi L/d^2 at the distance d [m] from the center, for a probe that faces it.
TEST(NearContact, MetersBesideASphereLightReadItsIrradiance) {
  for (const double gap : {1e-2, 1e-5, 3e-6, 1e-6})
    for (const Integrator integrator : kIntegrators) {
      const double d = static_cast<double>(static_cast<float>(1 + gap));
      expect_irradiance(meter_of_sphere({{d, 0, 0}, {-1, 0, 0}}, {0, 0, 0}, 1, integrator), M_PI / (d * d),
                        fmt::format("gap {} {}", gap, integrator_name(integrator)));
    }
}

// A sphere half below the horizon at d radii: E = L int cos over the upper half of its disc = 2/3 L/d^3. At
// the distances used here sin^3 of its angular radius equals 1/d^3.
TEST(NearContact, MetersReadAFarSphereLightHalfBelowTheirHorizon) {
  for (const double d : {1e2, 1e5, 1e6})
    for (const Integrator integrator : kIntegrators)
      expect_irradiance(meter_of_sphere({{0, 0, 0}, {0, 0, 1}}, {-d, 0, 0}, std::pow(d, 3), integrator),
                        2.0 / 3, fmt::format("distance {} {}", d, integrator_name(integrator)));
}

}  // namespace
}  // namespace abbe
