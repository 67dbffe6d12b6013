// Directions that a caustic guide samples.
#include <gtest/gtest.h>

#include <cfenv>
#include <numbers>
#include <random>
#include <typeinfo>

#include "tests/materials/bsdf_examples.h"
#include "tests/scene/scenes.h"
#include "tests/tier.h"
#include "transport/plan/caustic_guide.h"
#include "transport/technique/path.h"
#include "validation/goniometer/lobes.h"

namespace abbe {
namespace {

using Imath::V2f;
using Imath::V3f;

const Imath::Box3d kRoom({-1, 0, -1}, {1, 3, 1});
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Photons on a floor of 2 m x 2 m, reflected half way from a light whose mirror image is at `lamp` and has
// this radius.
std::vector<CausticPhoton> photons_from(const V3f& lamp, float radius, int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> across(-1, 1);
  std::vector<CausticPhoton> photons;
  for (int i = 0; i < count; ++i) {
    const V3f at(across(random), 0, across(random));
    const V3f way = lamp + V3f(across(random), across(random), across(random)) * radius - at;
    photons.push_back({at, way.normalized(), way.length() / 2, way.length(), 1 + across(random) / 2, 1});
  }
  return photons;
}

TEST(CausticLobes, AreDrawnAsTheySay) {
  for (const float radius : {0.01F, 0.5F}) {
    const CausticGuide guide(photons_from({0.5F, 3, -1}, radius, 500), kRoom);
    const V3f point(0.3F, 0, 0.1F);
    const CausticLobes lobes = guide.at(point);
    ASSERT_FALSE(lobes.empty());
    const DensityCheck check = check_density(
        [&](const BsdfRandom& u, int) {
          BsdfSample event;
          event.wi = lobes.sample(point, u.lobe, u.direction);
          return event;
        },
        [&](const V3f& w) { return static_cast<double>(lobes.pdf(point, w)); }, 0);
    EXPECT_NEAR(check.integral, 1, 1e-3) << radius;
    EXPECT_GT(check.p, 1e-4) << radius;
  }
}

// Nine lobes need two packets of eight; most entries of the second are unused.
TEST(CausticLobes, AskNothingInvalidOfThoseThatAreNotThere) {
  constexpr int kWatched = FE_INVALID | FE_DIVBYZERO;
  std::feclearexcept(kWatched);
  const CausticGuide guide(photons_from({0.5F, 3, -1}, 0.01F, 9), kRoom);
  const V3f point(0.3F, 0, 0.1F);
  EXPECT_GT(guide.at(point).pdf(point, V3f(0, 1, 0)), 0);
  EXPECT_EQ(std::fetestexcept(kWatched), 0);
}

// A guided path scatters as without the guide. In addition, with the guide's probability, a further direction
// is sampled from the lobes. Its pdf is that of both techniques where the BSDF is positive.
template <typename Model>
void expect_guided(const PathTracer& tracer, const CausticGuide& guide) {
  constexpr std::uint32_t kCount = 2000;
  const V3f point(0.3F, 0, 0.1F);
  const V3f normal(0, 1, 0);
  const CausticLobes lobes = guide.at(point);
  ASSERT_FALSE(lobes.empty());
  int added_paths = 0;
  int models = 0;
  for (const Model& model : examples<Model>()) {
    const SurfaceVertex vertex({point, normal, 0, 0}, Basis<float>(normal), V3f(0.6F, 0, 0.8F), Bsdf(model));
    ++models;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      CameraPath path(Sampler(1, Purpose::camera, 0, 0, i), 0);
      path.caustics = lobes;
      const auto u = path.sampler.group(0);
      const auto plain = vertex.scatter({u[2], {u[0], u[1]}}, path.packet.hero, TransportMode::radiance);
      const auto event = tracer.scatter(path, vertex, {u[2], {u[0], u[1]}});
      ASSERT_EQ(event.has_value(), plain.has_value());
      if (event) {
        ASSERT_EQ(event->pdf, plain->pdf);
      }
      added_paths += tracer.adds_path(path) ? 1 : 0;
      const auto added = tracer.scatter_added(path, vertex);
      if (!added) continue;
      const V3f world = vertex.frame.to_world(added->wi);
      const SampledSpectrum scattered = pdf(vertex.bsdf, vertex.wo, added->wi);
      const SampledSpectrum f = vertex.f(world, added->wi, TransportMode::radiance);
      for (int lane = 0; lane < kLanes; ++lane) {
        const float both =
            scattered[lane] > 0 ? scattered[lane] + lobes.probability() * lobes.pdf(point, world) : 0;
        EXPECT_NEAR(added->lane_pdf[lane] * added->pdf, both, 2e-3F * both);
        const float sent = f[lane] * std::abs(added->wi.z);
        EXPECT_NEAR(added->weight[lane] * added->pdf, sent, 2e-3F * sent + 1e-6F * added->pdf);
      }
    }
  }
  const double expected = static_cast<double>(lobes.probability());
  EXPECT_NEAR(added_paths / static_cast<double>(kCount) / models, expected, 0.02) << typeid(Model).name();
}

TEST(CausticLobes, AddTheirShareOfPathsToThoseThatScatter) {
  const CausticGuide guide(photons_from({0.5F, 3, -1}, 0.3F, 500), kRoom);
  const Scene scene = test::scene_of({Sphere{{0, 0, 5}, 1}});
  const Plan plan = make_plan(scene);
  RayCaster caster(scene);
  const PathTracer tracer(plan, caster);
  expect_guided<DiffuseBsdf>(tracer, guide);
  expect_guided<CoatedDiffuseBsdf>(tracer, guide);
  expect_guided<RoughDielectricBsdf>(tracer, guide);
  expect_guided<PrincipledBsdf>(tracer, guide);
  expect_guided<MixtureBsdf>(tracer, guide);
}

// A few photons at other positions suffice to direct samples to the light from every position.
TEST(CausticGuide, PointsToTheLampFromWhereNoPhotonWas) {
  const V3f lamp(0.5F, 3, -1);
  const CausticGuide guide(photons_from(lamp, 0.001F, 2000), kRoom);
  for (const V3f& point : {V3f(-0.9F, 0, 0.9F), V3f(0, 0, 0), V3f(0.7F, 0, 0.31F)}) {
    const CausticLobes lobes = guide.at(point);
    ASSERT_FALSE(lobes.empty());
    // Approximately 1/(3e-7 sr), the solid angle of the light.
    EXPECT_GT(lobes.pdf(point, (lamp - point).normalized()), 1e5F);
  }
  EXPECT_TRUE(guide.at({0, 2, 0}).empty()) << "far above the floor";
  EXPECT_TRUE(guide.at({5, 0, 0}).empty());
}

TEST(CausticGuide, KnowsLightFromInfinity) {
  std::vector<CausticPhoton> photons = photons_from({0, 1e6F, 0}, 4600, 500);
  for (CausticPhoton& photon : photons) photon.path_distance = kInfinity;
  const CausticGuide guide(std::move(photons), kRoom);
  const CausticLobes lobes = guide.at({0.2F, 0, 0.2F});
  ASSERT_FALSE(lobes.empty());
  EXPECT_GT(lobes.pdf({0.2F, 0, 0.2F}, {0, 1, 0}), 2e3F);
  EXPECT_LT(lobes.pdf({0.2F, 0, 0.2F}, V3f(0.1F, 1, 0).normalized()), 30.0F);
}

// Many photons on a floor and a few on a stone above it. Those of the floor, all at one height, are divided
// among regions that cover all of it.
TEST(CausticGuide, LeavesNoGapsOnAFloor) {
  std::vector<CausticPhoton> photons = photons_from({0, 4, 0}, 0.02F, 3000);
  for (const CausticPhoton& photon : photons_from({0, 4, 0}, 0.02F, 9))
    photons.push_back({photon.point * 0.1F + V3f(0, 2.5F, 0), photon.from, 1, 1, 1, 1});
  const CausticGuide guide(std::move(photons), kRoom);
  int gaps = 0;
  for (int i = 0; i < 100 * 100; ++i) {
    const V3f point(static_cast<float>(i % 100) / 50 - 0.99F, 0, static_cast<float>(i / 100) / 50 - 0.99F);
    gaps += guide.at(point).empty() ? 1 : 0;
  }
  EXPECT_EQ(gaps, 0);
}

TEST(CausticGuide, KeepsOutOfWhatScatteringFinds) {
  EXPECT_TRUE(CausticGuide(photons_from({0, 1, 0}, 1, 2000), kRoom).empty()) << "light from all around";
  EXPECT_TRUE(CausticGuide(photons_from({0, 3, 0}, 0.01F, 7), kRoom).empty()) << "too few to tell";
  EXPECT_TRUE(CausticGuide({}, kRoom).empty());
  EXPECT_TRUE(CausticGuide().at({0, 0, 0}).empty());
}

// The guide's fraction is that of the caustics in the sum of themselves and a sixteenth of the direct light.
// It is rounded to 64ths and limited to three quarters.
TEST(CausticGuide, LooksAsOftenAsItPays) {
  const auto share = [](float unhindered) {
    std::vector<CausticPhoton> photons = photons_from({0, 3, 0}, 0.01F, 2000);
    for (CausticPhoton& photon : photons) {
      photon.power = 4.0F / 2000;  // an irradiance of 1 on the floor
      photon.unoccluded_irradiance = unhindered;
    }
    float sum = 0;
    const CausticGuide guide(std::move(photons), kRoom);
    for (int i = 0; i < 64; ++i)
      sum += guide.at({static_cast<float>(i % 8) / 5 - 0.7F, 0, static_cast<float>(i / 8) / 5 - 0.7F})
                 .probability();
    return sum / 64;
  };
  EXPECT_EQ(share(0), 0.75F);
  EXPECT_NEAR(share(16), 0.5F, 0.05F);
  EXPECT_NEAR(share(48), 0.25F, 0.04F);
  EXPECT_NEAR(share(304), 0.05F, 0.015F);
  EXPECT_EQ(share(1e9F), 1 / 64.0F);
}

// Many photons at exactly one position form one region.
TEST(CausticGuide, HoldsPhotonsOfASinglePoint) {
  std::vector<CausticPhoton> photons = photons_from({0, 300, 0}, 0.01F, 1000);
  for (CausticPhoton& photon : photons) photon = {{1, 2, 3}, photon.from, 1, 2, 1, 1};
  const CausticGuide guide(std::move(photons), kRoom);
  EXPECT_FALSE(guide.at({1, 2, 3}).empty());
  EXPECT_EQ(guide.at({1, 2, 3}).probability(), 0.75F);
}

}  // namespace
}  // namespace abbe
