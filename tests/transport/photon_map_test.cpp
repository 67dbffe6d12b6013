#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "sampling/sampler.h"
#include "tests/scenes/scene_fixture.h"
#include "transport/technique/photon_map.h"
#include "transport/technique/photon_mapping.h"

namespace abbe {
namespace {

using Imath::V3f;

std::vector<V3f> points(std::uint32_t count) {
  std::vector<V3f> all;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto u = Sampler(3, Purpose::pilot, 0, 0, i).group(0);
    all.emplace_back(u[0], u[1], u[2] * u[2]);
  }
  all.insert(all.end(), 40, V3f(0.5F, 0.5F, 0.5F));  // at one point
  return all;
}

// Results equal those of a search over all points.
TEST(PhotonMap, FindsThoseWithinARadius) {
  const std::vector<V3f> all = points(3000);
  const PhotonMap map(all);
  ASSERT_EQ(map.size(), all.size());
  std::vector<std::uint32_t> found;
  for (std::uint32_t k = 0; k < 50; ++k) {
    const auto u = Sampler(4, Purpose::pilot, 0, 0, k).group(0);
    const V3f at = k == 0 ? V3f(0.5F, 0.5F, 0.5F) : V3f(u[0], u[1], u[2]);
    for (const float radius : {0.01F, 0.1F, 5.0F}) {
      std::vector<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < all.size(); ++i)
        if ((all[i] - at).length2() < radius * radius) expected.push_back(i);
      map.within(at, radius, found);
      EXPECT_EQ(found, expected) << radius;
    }
  }
}

TEST(PhotonMap, FindsTheNearest) {
  const std::vector<V3f> all = points(3000);
  const PhotonMap map(all);
  std::vector<std::uint32_t> found;
  for (std::uint32_t k = 0; k < 50; ++k) {
    const auto u = Sampler(5, Purpose::pilot, 0, 0, k).group(0);
    const V3f at(u[0], u[1], u[2]);
    std::vector<float> expected;
    for (const V3f& point : all) expected.push_back((point - at).length2());
    std::sort(expected.begin(), expected.end());
    map.nearest(at, 33, found);
    ASSERT_EQ(found.size(), 33U);
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_FLOAT_EQ((all[found[i]] - at).length2(), expected[i]);
  }
  map.nearest({0, 0, 0}, 10000, found);
  EXPECT_EQ(found.size(), all.size());
}

TEST(PhotonMap, OfNothingFindsNothing) {
  const PhotonMap map({});
  std::vector<std::uint32_t> found{1};
  map.within({0, 0, 0}, 1, found);
  EXPECT_TRUE(found.empty());
  found = {1};
  map.nearest({0, 0, 0}, 5, found);
  EXPECT_TRUE(found.empty());
}

// Image from above of a plate with the reflectance 0.5, without light on the visible side.
Film seen_from_above(const std::string& plate, std::uint64_t paths,
                     const std::function<void(const Plan&, const Deposit&)>& trace) {
  const Scene scene = test::load_text(R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 1}, "from": [0, 0, 3], "to": [0, 0, 0], "up": [0, 1, 0]},
    "sensor": {"resolution": [1, 1], "observer": "1931"},
    "materials": {"white": {"diffuse": {"reflectance": 0.5}}},
    "lights": [{"quad": {"corner": [0, 0, -1], "edge_u": [0, 1, 0], "edge_v": [1, 0, 0]}, "emission": {"spectrum": 1}}],
    "shapes": [{"quad": {"corner": [-5, -5, 0], "edge_u": [10, 0, 0], "edge_v": [0, 10, 0]}, )" +
                                      plate + "}]}");
  const Plan plan = make_plan(scene);
  Film film(1, 1, 3, 1, plan.nominal_value);
  trace(plan,
        [&film](std::uint32_t, const FilmPoint&, std::span<const double> values) { film.add(0, 0, values); });
  film.set_samples({paths});
  return film;
}

// A uniform photon flux makes the plate as bright as one that emits f E.
TEST(PhotonGathering, TellsTheFluxForEachAreaWhateverTheKernel) {
  constexpr std::uint32_t kPaths = 16;
  std::vector<PixelSample> samples;
  constexpr std::uint32_t kMany = 4096;  // wavelengths
  for (std::uint32_t i = 0; i < kMany; ++i) samples.push_back({0, 0, Sampler(1, Purpose::camera, 0, 0, i)});
  const Film emitting = seen_from_above(R"("material": "white", "emission": {"spectrum": 1})", kMany,
                                        [&](const Plan& plan, const Deposit& deposit) {
                                          RayCaster caster(plan.scene);
                                          PathTracer(plan, caster).trace(samples, deposit);
                                        });
  constexpr std::uint32_t kPhotons = 1U << 17;  // on four square metres
  constexpr std::uint64_t kTraced = 1000;
  const double radiance = 0.5 / std::numbers::pi * kPhotons / 4 / kTraced;
  for (const GatherKernel& kernel : {GatherKernel{0.3F}, GatherKernel{0.0F, 9000}}) {
    const Film gathered =
        seen_from_above(R"("material": "white")", kPaths, [&](const Plan& plan, const Deposit& deposit) {
          PathPacket packet = draw_packet(plan.wavelengths, 0.3F);
          const auto height = static_cast<float>(-plan.scene.origin_m.z);
          std::vector<Photon> photons;
          for (std::uint32_t i = 0; i < kPhotons; ++i) {
            const std::array<float, 4> u = Sampler(2, Purpose::light, 0, 0, i).group(0);
            photons.push_back({{2 * u[0] - 1, 2 * u[1] - 1, height},
                               {0, 0, 1},
                               {0, 0, 1},
                               SampledSpectrum(1.0F),
                               SampledSpectrum(1.0F),
                               0,
                               0,
                               false});
          }
          RayCaster caster(plan.scene);
          for (std::uint32_t i = 0; i < kPaths; ++i) {
            packet = draw_packet(plan.wavelengths, (static_cast<float>(i) + 0.5F) / (kPaths * kLanes));
            PhotonGatherer(plan, caster)
                .trace(std::span(samples).subspan(i, 1), PhotonCloud(photons, kTraced, packet, 0), kernel,
                       deposit);
          }
        });
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(gathered.mean(0, channel) / emitting.mean(0, channel), radiance, 0.005 * radiance)
          << kernel.radius << " " << channel;
  }
}

// The radius equals the defining product for each sample; r_n^2 decreases as n^(a - 1).
TEST(GatherRadius, ShrinksAsItsProduct) {
  EXPECT_FLOAT_EQ(gather_radius(0.25F, 0), 0.25F);
  double squared = 1;
  for (int i = 1; i < 1000; ++i) {
    squared *= (i + 2.0 / 3) / (i + 1.0);
    EXPECT_NEAR(gather_radius(1, static_cast<std::uint64_t>(i)), std::sqrt(squared), 1e-6) << i;
  }
  EXPECT_NEAR(gather_radius(1, 8'000'000) / gather_radius(1, 1'000'000), std::pow(8, -1.0 / 6), 1e-5);
}

// Techniques that merge paths report a bias; no other technique does.
TEST(Techniques, TellTheirBias) {
  for (const Technique technique : {Technique::path, Technique::light, Technique::bdpt,
                                    Technique::photon_brute, Technique::adjoint_brute})
    EXPECT_EQ(bias_of(technique), "") << integrator_name(technique);
  for (const Technique technique : {Technique::ppm, Technique::sppm, Technique::vcm})
    EXPECT_NE(bias_of(technique).find("consistent"), std::string_view::npos) << integrator_name(technique);
  EXPECT_EQ(bias_of(Technique::photon_map).find("consistent"), std::string_view::npos);
}

}  // namespace
}  // namespace abbe
