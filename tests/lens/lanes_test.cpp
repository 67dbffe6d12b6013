#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "lens/beam.h"
#include "lens/spectral_system.h"
#include "lenses.h"
#include "materials/interface/fresnel.h"

// Lanes of a packet pass a lens together exactly like single rays.

namespace abbe::lens {
namespace {

using Imath::V2d;
using Imath::V3d;

struct Case {
  std::string name;
  System lens;
};

System with_tilt() {
  System lens = abbe::test::lens_named("cooke_triplet");
  lens.surfaces[0].tilt_deg = {1.5, -0.7};
  lens.surfaces[3].decenter_mm = {0.3, 0.4};
  return lens;
}

System with_asphere() {
  System lens = abbe::test::lens_named("achromat");
  lens.surfaces[0].profile.conic = -0.8;
  lens.surfaces[0].profile.even = {0, 2e-7, -1e-10};
  lens.surfaces[2].profile.even = {1e-4, 0, 3e-11};
  return lens;
}

System with_coating() {
  System lens = abbe::test::lens_named("double_gauss");
  lens.surfaces[0].coating = {{{"film", RefractiveIndex(1.38)}}, {{0, 99.6}}};
  lens.surfaces[1].coating = lens.surfaces[0].coating;
  return lens;
}

std::vector<Case> cases() {
  return {{"fisheye", abbe::test::lens_named("fisheye")},
          {"tilted", with_tilt()},
          {"aspheric", with_asphere()},
          {"coated", with_coating()}};
}

// Also if other lanes of the packet are near grazing incidence or totally reflected. Cemented surfaces
// reflect less than a millionth, which 1 - T does not resolve in floats, and no p at Brewster's angle.
TEST(Lanes, ReflectAsEachDoesAlone) {
  constexpr std::array<double, 4> kCosines{0.98, 0.76025933, 0.061, 0.5};
  constexpr std::array<double, 4> kIndices{1.00080872, 1.011, 1.6, 0.612};
  Floats cosine;
  Floats eta;
  for (int j = 0; j < Floats::kCount; ++j) {
    cosine.set(j, static_cast<float>(kCosines[static_cast<std::size_t>(j % 4)]));
    eta.set(j, static_cast<float>(kIndices[static_cast<std::size_t>(j / 4)]));
  }
  const FresnelPower<Floats> lanes = fresnel_dielectric(cosine, eta);
  for (int j = 0; j < Floats::kCount; ++j) {
    const auto alone = fresnel_dielectric(static_cast<double>(cosine[j]), static_cast<double>(eta[j]));
    EXPECT_GE(lanes.Rp[j], 0) << j;
    EXPECT_NEAR(lanes.Rs[j], alone.Rs, 1e-5 * alone.Rs) << j;
    EXPECT_NEAR(lanes.Rp[j], alone.Rp, 1e-5 * alone.Rp + 1e-13) << j;
    EXPECT_NEAR(lanes.Ts[j], alone.Ts, 1e-5 * alone.Ts) << j;
    EXPECT_NEAR(lanes.Tp[j], alone.Tp, 1e-5 * alone.Tp) << j;
  }
}

// In floats, along the direct route and along that of a ghost.
TEST(Lanes, GoThroughALensAsEachDoesAlone) {
  const SampledSpectrum nm(SampledSpectrum::Values{382, 431.5F, 478, 520, 561.25F, 610, 668, 779});
  int parted = 0;  // rays with some arriving and some missing lanes
  for (const Case& of : cases()) {
    const SpectralSystem system(of.lens, stop_radius(of.lens));
    const std::size_t surfaces = of.lens.surfaces.size();
    const std::vector<Route> routes{system.direct(), route_of(ghosts(of.lens, 400, 700).back(), surfaces)};
    int apart = 0;
    std::array<double, 2> furthest{};
    std::mt19937 numbers(11);
    const auto uniform = [&](double reach) { return std::uniform_real_distribution(-reach, reach)(numbers); };
    int arrived = 0;
    const double reach = 2 * system.stop_radius_mm();
    for (int i = 0; i < 6000; ++i) {
      const Ray ray{{uniform(reach), uniform(reach), -5}, V3d(uniform(0.3), uniform(0.3), 1).normalized()};
      const Route& route = routes[static_cast<std::size_t>(i % 2)];
      const Ray other{ray.origin, V3d(-ray.direction.x, ray.direction.y, ray.direction.z)};
      const auto lanes = system.to_image({{{ray, nm}, {other, nm}}}, route);
      const auto in_own_company = system.to_image({{{ray, nm}, {ray, nm}}}, system.direct());
      int lanes_arrived = 0;
      for (int j = 0; j < 2 * kLanes; ++j) {
        const auto alone =
            system.to_image(j < kLanes ? ray : other, static_cast<double>(nm[j % kLanes]), route);
        apart += lanes.reached_image[j] != alone.has_value();
        if (i % 2 == 0 && j < kLanes && lanes.reached_image[j]) {
          EXPECT_EQ(lanes.point.x[j], in_own_company.point.x[j]) << "to the bit, whatever goes with it";
          EXPECT_EQ(lanes.transmittance[j], in_own_company.transmittance[j]);
        }
        if (!alone || !lanes.reached_image[j]) continue;
        ++lanes_arrived;
        if (alone->direction.z < 0.7) continue;  // only for ghosts, which magnify rounding errors
        const V2d point(Imath::V2f(lanes.point.x[j], lanes.point.y[j]));
        double& distance = furthest[static_cast<std::size_t>(i % 2)];
        distance = std::max(distance, (point - alone->point).length());
        EXPECT_LT((V3d(lane_of(lanes.direction, j)) - alone->direction).length(), 3e-6) << of.name;
        EXPECT_NEAR(static_cast<double>(lanes.transmittance[j]) / alone->transmittance, 1, 5e-6) << of.name;
      }
      arrived += lanes_arrived;
      parted += lanes_arrived % kLanes != 0;
    }
    EXPECT_GT(arrived, 500) << of.name;
    EXPECT_LT(furthest[0], 5e-5) << of.name << " [mm]";
    EXPECT_LT(furthest[1], 3e-4) << of.name << " [mm], by way of a ghost";
    EXPECT_LE(apart, arrived / 1000) << of.name << ": at rims";
  }
  EXPECT_GT(parted, 20);
}

TEST(RaysTogether, LeaveALensAsEachDoesAlone) {
  for (const Case& of : cases()) {
    const SpectralSystem system(of.lens, stop_radius(of.lens));
    std::mt19937 numbers(12);
    const auto uniform = [&](double reach) { return std::uniform_real_distribution(-reach, reach)(numbers); };
    const double reach = 2 * system.stop_radius_mm();
    std::vector<ColouredRay> rays;
    for (int i = 0; i < 1001; ++i) {
      const V3d from(uniform(5), uniform(5), system.image_z());
      const V3d to(uniform(reach), uniform(reach), system.last_z());
      rays.push_back({{from, (to - from).normalized()}, 550 + uniform(160)});
    }
    const auto together = system.to_object(rays);
    ASSERT_EQ(together.size(), rays.size());
    int left = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto alone = system.to_object(rays[i].ray, rays[i].wavelength_nm);
      ASSERT_EQ(together[i].has_value(), alone.has_value()) << of.name << ", ray " << i;
      if (!alone) continue;
      ++left;
      EXPECT_LT((together[i]->origin - alone->origin).length(), 1e-10) << of.name;
      EXPECT_LT((together[i]->direction - alone->direction).length(), 1e-12) << of.name;
    }
    EXPECT_GT(left, 50) << of.name;
  }
}

}  // namespace
}  // namespace abbe::lens
