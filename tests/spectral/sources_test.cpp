#include "spectral/sources.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "io/error.h"
#include "spectral/library.h"

namespace abbe {
namespace {

TEST(Quantities, photons_per_second_of_a_lamp) {
  // 100 W at 500 nm: of the order of 1e20 photons per second.
  EXPECT_NEAR(photon_energy(500), 3.97289e-19, 1e-24);
  EXPECT_NEAR(100 / photon_energy(500), 2.51706e20, 1e15);
}

TEST(Quantities, spectral_densities) {
  // 10.2 J in 500-600 nm is 0.102 J/nm; 100 W evenly over 400-800 nm is 0.25 W/nm.
  EXPECT_NEAR(band(500, 600, 0.102).integral(), 10.2, 1e-12);
  EXPECT_NEAR(band(400, 800, 0.25).integral(), 100, 1e-12);
}

TEST(Planck, stefan_boltzmann_law) {
  // pi times the integral over all wavelengths is 5.670374e-8 T^4. The long tail is integrated in steps of
  // 0.1 %.
  const double kelvin = 6000;
  double total = 0;
  for (double nm = 50; nm < 1e7; nm *= 1.001) total += planck_radiance(kelvin, nm * 1.0005) * nm * 0.001;
  EXPECT_NEAR(M_PI * total / (5.670374419e-8 * std::pow(kelvin, 4)), 1, 1e-5);
}

TEST(Planck, does_not_overflow) {
  EXPECT_EQ(planck_radiance(1, 300), 0);
  EXPECT_GT(planck_radiance(1e6, 1100), 0);
}

TEST(Daylight, agrees_with_the_tabulated_illuminants) {
  for (const auto& [name, kelvin] :
       {std::pair{"D50", 5000.0}, {"D55", 5500.0}, {"D65", 6500.0}, {"D75", 7500.0}}) {
    Diagnostics diagnostics;
    const auto table = load_illuminant(name, {}, diagnostics);
    ASSERT_TRUE(table) << diagnostics.text();
    const Curve curve = daylight(kelvin * 1.4388 / 1.4380);
    for (int nm = 300; nm <= 830; nm += 5)
      EXPECT_NEAR(curve(nm), table->curve(nm), 0.006) << name << " at " << nm;
  }
}

TEST(Bands, gaussian_shape_and_area) {
  for (const double width : {1e-3, 0.37, 10.0, 80.0}) {
    const Curve curve = gaussian(550.2, width, 2);
    EXPECT_EQ(curve(550.2), 2);
    EXPECT_NEAR(curve(550.2 + width / 2), 1, 1e-6);
    EXPECT_NEAR(curve(550.2 - 0.3 * width), 2 * std::exp2(-4 * 0.09), 5e-4);
    EXPECT_NEAR(curve.integral(), 2 * width * std::sqrt(M_PI / (4 * std::log(2.0))), 1e-9 * width);
  }
}

TEST(Bands, lines_keep_their_power_and_add) {
  const std::vector<SpectralLine> mercury = {{435.8343, 1e-3, 2}, {546.074, 1e-3, 3}, {546.0743, 1e-3, 5}};
  const Curve curve = lines(mercury);
  EXPECT_NEAR(curve.integral(), 10, 1e-8);
  EXPECT_NEAR(curve(435.8343), 2000, 1e-6);
  EXPECT_NEAR(curve(546.07415), 8000, 1e-6);
  EXPECT_NEAR(curve(546.0736), 3000, 1e-6);
  EXPECT_EQ(curve(546.07), 0);
  EXPECT_EQ(lines({}).integral(), 0);
}

TEST(Bands, refuse_empty_widths) {
  EXPECT_THROW((void)band(500, 500), Error);
  EXPECT_THROW((void)gaussian(500, 0), Error);
  const std::vector<SpectralLine> flat = {{500, 0, 1}};
  EXPECT_THROW((void)lines(flat), Error);
}

}  // namespace
}  // namespace abbe
