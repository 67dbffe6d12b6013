#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lens/beam.h"
#include "lens/spectral_system.h"
#include "lenses.h"

// The lanes of a packet go through a lens together as each of them goes alone.

namespace abbe::lens {
namespace {

using Imath::V2d;
using Imath::V3d;

struct Case {
  std::string name;
  System lens;
};

System with_tilt() {
  System lens = abbe::testing::lens_named("cooke_triplet");
  lens.surfaces[0].tilt_deg = {1.5, -0.7};
  lens.surfaces[3].decenter_mm = {0.3, 0.4};
  return lens;
}

System with_asphere() {
  System lens = abbe::testing::lens_named("achromat");
  lens.surfaces[0].profile.conic = -0.8;
  lens.surfaces[0].profile.even = {0, 2e-7, -1e-10};
  lens.surfaces[2].profile.even = {1e-4, 0, 3e-11};
  return lens;
}

System with_coating() {
  System lens = abbe::testing::lens_named("double_gauss");
  lens.surfaces[0].coating = {{{"film", RefractiveIndex(1.38)}}, {{0, 99.6}}};
  lens.surfaces[1].coating = lens.surfaces[0].coating;
  return lens;
}

TEST(Lanes, GoThroughALensAsEachDoesAlone) {
  const std::vector<Case> cases{{"fisheye", abbe::testing::lens_named("fisheye")},
                                {"tilted", with_tilt()},
                                {"aspheric", with_asphere()},
                                {"coated", with_coating()}};
  const SampledSpectrum nm(SampledSpectrum::Values{382, 431.5F, 478, 520, 561.25F, 610, 668, 779});
  int parted = 0;  // rays of which some lanes arrive and others do not
  for (const Case& of : cases) {
    const SpectralSystem system(of.lens, stop_radius(of.lens));
    std::mt19937 numbers(11);
    const auto uniform = [&](double reach) { return std::uniform_real_distribution(-reach, reach)(numbers); };
    int arrived = 0;
    const double reach = 2 * system.stop_radius_mm();
    for (int i = 0; i < 6000; ++i) {
      const Ray ray{{uniform(reach), uniform(reach), -5}, V3d(uniform(0.3), uniform(0.3), 1).normalized()};
      const auto lanes = system.to_image(ray, nm, system.direct());
      int lanes_arrived = 0;
      for (int j = 0; j < kLanes; ++j) {
        const auto alone = system.to_image(ray, static_cast<double>(nm[j]));
        ASSERT_EQ(lanes.arrived[j], alone.has_value()) << of.name << ", lane " << j;
        if (!alone) continue;
        ++lanes_arrived;
        EXPECT_LT((V2d(lanes.point.x[j], lanes.point.y[j]) - alone->point).length(), 1e-10) << of.name;
        EXPECT_NEAR(lanes.direction.z[j], alone->direction.z, 1e-13) << of.name;
        EXPECT_NEAR(lanes.transmittance[j] / alone->transmittance, 1, 1e-12) << of.name;
      }
      arrived += lanes_arrived;
      parted += lanes_arrived > 0 && lanes_arrived < kLanes;
    }
    EXPECT_GT(arrived, 500) << of.name;
  }
  EXPECT_GT(parted, 20);
}

}  // namespace
}  // namespace abbe::lens
