#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "tests/scenes/film_of_plan.h"
#include "tests/scenes/scene_fixture.h"
#include "transport/render/technique_balance.h"
#include "transport/render/trained_plan.h"

namespace abbe {
namespace {

constexpr int kStrips = 6;  // of a film, across
constexpr int kSeeds = 16;

// Means of each channel over the strips of films of some seeds.
using Strips = std::array<std::array<double, kSeeds>, kStrips>;
std::array<Strips, 3> strips_of(const Scene& scene, const Plan& plan, std::uint64_t samples) {
  std::array<Strips, 3> strips;
  for (std::size_t seed = 0; seed < kSeeds; ++seed) {
    const Film film = test::film_of(scene, plan, samples, seed + (plan.photons_split_wavelengths ? 100 : 0));
    for (int channel = 0; channel < 3; ++channel)
      for (int i = 0; i < kStrips; ++i)
        strips[static_cast<std::size_t>(channel)][static_cast<std::size_t>(i)][seed] =
            test::region(film, channel, i * film.width() / kStrips, 0, (i + 1) * film.width() / kStrips,
                         film.height())
                .mean;
  }
  return strips;
}

struct Estimate {
  double mean = 0;
  double variance = 0;  // of the mean
};
Estimate estimate(const std::array<double, kSeeds>& values) {
  Estimate of;
  for (const double value : values) of.mean += value / kSeeds;
  for (const double value : values) of.variance += std::pow(value - of.mean, 2) / (kSeeds * (kSeeds - 1.0));
  return of;
}

// Whether photons that part bring the same light, strip by strip and in all, which the films tell to
// `within`: by the scatter over seeds, as the lanes of a photon come to several pixels.
void expect_the_same_light(const Scene& scene, std::uint64_t samples, double within) {
  constexpr double kLargestZ = 6.5;  // of 30 degrees of freedom, for a family of 36 at 1e-5
  Plan whole = make_trained_plan(scene, 2);
  Plan parting = whole;
  parting.photons_split_wavelengths = true;
  parting.photons = whole.photons / 8;
  std::array<double, kSeeds> all{};
  std::array<double, kSeeds> all_parted{};
  const std::array<Strips, 3> a = strips_of(scene, whole, samples);
  const std::array<Strips, 3> b = strips_of(scene, parting, samples);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t i = 0; i < kStrips; ++i) {
      const Estimate x = estimate(a[channel][i]);
      const Estimate y = estimate(b[channel][i]);
      EXPECT_LE(std::abs(x.mean - y.mean), kLargestZ * std::sqrt(x.variance + y.variance))
          << "channel " << channel << ", strip " << i << ": " << x.mean << " and " << y.mean;
      for (std::size_t seed = 0; seed < kSeeds; ++seed) {
        all[seed] += a[channel][i][seed];
        all_parted[seed] += b[channel][i][seed];
      }
    }
  }
  const Estimate x = estimate(all);
  const Estimate y = estimate(all_parted);
  const double error = std::sqrt(x.variance + y.variance) / x.mean;
  EXPECT_LT(error, within);
  EXPECT_LE(std::abs(y.mean / x.mean - 1), kLargestZ * error) << x.mean << " and " << y.mean;
}

const std::vector<Override> kSmallFilm{{"/sensor/resolution", "[48, 30]"}, {"/sensor/pixel_pitch_um", "100"}};

TEST(PartedPhotons, BringTheLightOfWholeOnes) {
  std::vector<Override> settings = kSmallFilm;
  settings.push_back({"/render/polarisation", "\"off\""});
  expect_the_same_light(test::load("prism_spot.json", settings), 8, 0.01);
}

// Polarised light is reflected more, or less, and goes on as often as that leaves.
TEST(PartedPhotons, BringPolarisedLight) {
  for (const char* axis : {"[1, 0, 0]", "[0, 0, 1]"}) {
    std::vector<Override> settings = kSmallFilm;
    settings.push_back({"/lights/0/emission/polarised", fmt::format(R"({{"axis": {}}})", axis)});
    expect_the_same_light(test::load("prism_spot.json", settings), 8, 0.01);
  }
}

// A spot's light that one ball of glass reflects and another refracts to a card: lanes have densities of
// their own by then, as each would have been reflected with its own reflectance.
constexpr const char* kReflectedFirst = R"({
  "abbe": 1,
  "camera": {"pinhole": {"fov_deg": 40}, "from": [4, -8, 3], "to": [1, 0, 6], "up": [0, 0, 1]},
  "sensor": {"resolution": [24, 16], "observer": "1931"},
  "materials": {"glass": {"dielectric": {"ior": "N-SF11"}}, "card": {"diffuse": {"reflectance": 0.8}}},
  "lights": [{"spot": {"at": [-5, 0, 0.8], "direction": [1, 0, 0], "half_angle_deg": 2}, "emission": {"spectrum": 100}}],
  "shapes": [
    {"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "glass"},
    {"sphere": {"center": [0.24, 0, 3.68], "radius": 0.8}, "material": "glass"},
    {"quad": {"corner": [-4, -4, 6], "edge_u": [8, 0, 0], "edge_v": [0, 8, 0]}, "material": "card"}
  ],
  "render": {"samples": 16}
})";

TEST(PartedPhotons, BringLightThatGlassHasReflectedFirst) {
  for (const char* polarisation : {"\"off\"", "\"auto\""})
    expect_the_same_light(test::load_text(kReflectedFirst, {{"/render/polarisation", polarisation}}), 96,
                          0.025);
}

TEST(PartedPhotons, ArePreferredWhereLanesComeToOtherPixels) {
  Scene prism = test::load("prism_spot.json");
  Plan plan = make_trained_plan(prism, 2);
  const std::uint64_t photons = plan.photons;
  balance_techniques(plan, 2);
  EXPECT_TRUE(plan.photons_split_wavelengths);
  EXPECT_EQ(plan.photons, photons / 8) << "so many lanes take the rest of the way";
  const Scene ball = test::load("glass_sphere.json");
  Plan of_ball = make_trained_plan(ball, 2);
  balance_techniques(of_ball, 2);
  EXPECT_FALSE(of_ball.photons_split_wavelengths) << "its caustic is white";
}

}  // namespace
}  // namespace abbe
