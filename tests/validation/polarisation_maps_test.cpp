#include "report/maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/exr.h"
#include "io/picture.h"
#include "report/display_color.h"
#include "report/image_difference.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"

namespace abbe::test {
namespace {

// Light of intensity 2 with these degrees and angles of polarisation.
Image film(const std::vector<double>& degrees, const std::vector<double>& angles_deg) {
  Image image{static_cast<int>(degrees.size()), 1, {{"V", {}}, {"S1.V", {}}, {"S2.V", {}}, {"S3.V", {}}}, {}};
  for (std::size_t i = 0; i < degrees.size(); ++i) {
    const double twice = angles_deg[i] * std::numbers::pi / 90;
    image.channels[0].values.push_back(2);
    image.channels[1].values.push_back(static_cast<float>(2 * degrees[i] * std::cos(twice)));
    image.channels[2].values.push_back(static_cast<float>(2 * degrees[i] * std::sin(twice)));
    image.channels[3].values.push_back(0);
  }
  for (std::size_t k = 0; k < 4; ++k)
    image.channels.push_back({"Variance." + image.channels[k].name, std::vector<float>(degrees.size(), 0)});
  image.metadata = {{"sensor_channels", "V,S1.V,S2.V,S3.V"},
                    {"channel.V", "energy"},
                    {"exposure_s", "1"},
                    {"gathering_area_m2", "1e-10"},
                    {"sensor", "{}"}};
  return image;
}

TEST(PolarisationDifference, IsTakenWhereLightIsPolarised) {
  const Image reference = film({0.5, 0.04, 1, 0.2}, {10, 90, 175, 40});
  const Image image = film({0.4, 0.5, 1, 0.5}, {20, 0, 2, 130});
  const auto difference = polarisation_difference(image, reference);
  ASSERT_TRUE(difference);
  EXPECT_DOUBLE_EQ(difference->polarised_fraction, 0.75);
  EXPECT_NEAR(difference->degree_mean, (0.1 + 0 + 0.3) / 3, 1e-6);
  EXPECT_NEAR(difference->degree_max, 0.3, 1e-6);
  EXPECT_NEAR(difference->angle_deg_mean, (10.0 + 7 + 90) / 3, 1e-4);
  EXPECT_NEAR(difference->angle_deg_max, 90, 1e-4);
  EXPECT_FALSE(polarisation_difference({4, 1, {{"V", {1, 1, 1, 1}}}, {}}, reference));
}

TEST(PolarisationMaps, ShowDegreeAndAngle) {
  const auto maps = polarisation_maps({{0.9, 0.3, 45}, {0, 0, 0}}, MeasuredStokes::all, 2, 1);
  ASSERT_EQ(maps.size(), 3U);
  EXPECT_EQ(polarisation_maps({{0.3, 0.3, 45}}, MeasuredStokes::linear, 1, 1).front().name, "linear_degree");
  EXPECT_EQ(maps[0].name, "degree");
  EXPECT_EQ(maps[1].name, "linear_degree");
  EXPECT_EQ(maps[2].name, "angle");
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(maps[0].map.channels[c].values[0], map_color(0.9)[c], 1e-6);
    EXPECT_NEAR(maps[1].map.channels[c].values[0], map_color(0.3)[c], 1e-6);
    EXPECT_NEAR(maps[2].map.channels[c].values[0], cyclic_color(0.25, 0.3)[c], 1e-6);
    EXPECT_NEAR(maps[2].map.channels[c].values[1], cyclic_color(0, 0)[c], 1e-6);
  }
}

TEST(PolarisationProgram, DevelopsMapsAndComparesFilms) {
  const std::string a = file("a.exr");
  const std::string b = file("b.exr");
  write_exr(a, film({0.5, 0}, {30, 0}));
  write_exr(b, film({0.75, 0}, {170, 0}));
  const std::string folder = file("polarised/maps");
  const Outcome run = abbe("develop " + a + " --stokes " + folder);
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* map : {"/degree.png", "/linear_degree.png", "/angle.png"})
    EXPECT_EQ(read_picture(folder + map).width, 2) << map;
  const Image values = read_exr(folder + "/polarisation.exr");
  EXPECT_NEAR(values.find("DoLP.V")->values[0], 0.5, 1e-6);
  EXPECT_NEAR(values.find("AoLP.V")->values[0], 30, 1e-4);
  const nlohmann::json answer = abbe("compare " + b + " " + a + " --json").json();
  EXPECT_NEAR(answer["degree_max"].get<double>(), 0.25, 1e-6);
  EXPECT_NEAR(answer["angle_deg_max"].get<double>(), 40, 1e-4);
  EXPECT_EQ(answer["relMSE"], 0) << "intensities alone";
  write_exr(b, {2, 1, {{"V", {1, 1}}}, {}});
  EXPECT_FALSE(abbe("compare " + b + " " + b + " --json").json().contains("degree_max"));
  const Outcome refused = abbe("develop " + b + " --stokes " + folder);
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("does not measure polarisation"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace abbe::test
