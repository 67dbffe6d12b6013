#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "materials/index/library.h"
#include "materials/interface/snell.h"
#include "scene/shapes/sphere.h"
#include "tests/reference/reference_table.h"

namespace abbe {
namespace {

using V3d = Imath::V3d;
constexpr double kDegree = std::numbers::pi / 180;

// Turns of a ray that enters a ball of index n at incidence i and leaves after k internal reflections
// [degrees].
double deviation(double n, double incidence_deg, int k) {
  const Sphere ball{V3d(0), 1};
  const double i = incidence_deg * kDegree;
  BasicRay<double> ray{V3d(std::sin(i), 0, 5), V3d(0, 0, -1)};
  double turned = 0;
  for (int event = 0; event <= k + 1; ++event) {
    const auto hit = intersect(ball, ray, 1e-9);
    if (!hit) return std::nan("");
    const bool last = event == k + 1;
    V3d next = event == 0 ? *refract(-ray.direction, hit->normal, n)
                          : reflect(V3d(-ray.direction), V3d(-hit->normal));
    if (last) next = *refract(-ray.direction, V3d(-hit->normal), 1 / n);
    turned += std::acos(std::clamp(ray.direction.dot(next), -1.0, 1.0));
    ray = {hit->point, next};
  }
  return turned / kDegree;
}

TEST(Rainbow, ADropletTurnsTheDescartesRayByTheKnownAngle) {
  Diagnostics diagnostics;
  const auto water = load_index("water_20.0C", {}, diagnostics);
  ASSERT_TRUE(water) << diagnostics.text();
  const test::ReferenceTable bows("rainbow_water_20C");
  for (std::size_t row = 0; row < bows.rows(); ++row) {
    const double nm = bows.number(row, "wavelength_nm");
    const bool absolute = bows.text(row, "index_used") == "absolute";
    const double n = absolute ? water->index.catalogued_n(nm) : water->index.n(nm);
    EXPECT_NEAR(n, bows.number(row, "n"), 1e-7) << nm;
    const int order = static_cast<int>(bows.number(row, "order_k"));
    // The table's index of air takes the label for a wavelength in vacuum: 1e-8 in n, 3e-6 degrees in the
    // angle.
    EXPECT_NEAR(deviation(n, bows.number(row, "incidence_deg"), order), bows.number(row, "deviation_deg"),
                5e-6)
        << nm;
  }
}

}  // namespace
}  // namespace abbe
