#include <gtest/gtest.h>

#include "cli/query.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"

// Angles of materials that absorb, and the medium that angles are in.

namespace abbe::test {
namespace {

TEST(QueryAngles, NoCriticalAngleBelowAnIndexOfOne) {
  EXPECT_TRUE(json_output(cli::query_critical, {"Ag_Johnson", {550}})["angle_deg"].is_null());
}

TEST(QueryAngles, OfMetalsTheLeastRpHasAnAngleButNoTotalReflection) {
  for (const char* metal : {"Au_Johnson", "Ag_Johnson", "Al_Rakic"}) {
    const json found = json_output(cli::query_brewster, {metal, {550}});
    EXPECT_EQ(found["kind"], "pseudo-Brewster") << metal;
    const double angle = found["angle_deg"];
    const std::vector<double> around{angle - 0.01, angle, angle + 0.01};
    const json p = json_output(cli::query_reflectance, {metal, {550}, around})["Rp"];
    EXPECT_EQ(found["Rp"], p[1]);
    EXPECT_LT(p[1], p[0]) << metal;
    EXPECT_LT(p[1], p[2]) << metal;
    EXPECT_NEAR(p[0].get<double>(), p[2].get<double>(), 1e-9) << metal;
    EXPECT_TRUE(json_output(cli::query_critical, {metal, {550}})["angle_deg"].is_null()) << metal;
  }
  EXPECT_EQ(json_output(cli::query_brewster, {"N-BK7", {550}})["kind"], "Brewster");
  const auto metal = scratch().write("dense.csv", "# unit: 1\nwavelength_nm,n,k\n500,3,3\n600,3,3\n");
  EXPECT_TRUE(json_output(cli::query_critical, {metal.string(), {550}})["angle_deg"].is_null())
      << "which n alone would have";
}

TEST(QueryAngles, NothingComesThroughAPrismOfMetal) {
  const json gold = json_output(cli::query_prism, {"Au_Johnson", 60, {587.5618}, {}});
  for (const char* figure : {"deviation_deg", "incidence_deg", "Ts", "Tp"})
    EXPECT_TRUE(gold[figure].is_null()) << figure;
}

TEST(QueryAngles, AreInTheMediumThatIsTold) {
  const auto expect_medium = [](const char* id, const char* medium) {
    EXPECT_EQ(json_output(cli::query_prism, {id, 60, {550}, {}})["medium"], medium);
    EXPECT_EQ(json_output(cli::query_critical, {id, {550}})["medium"], medium);
    EXPECT_EQ(json_output(cli::query_reflectance, {id, {550}, {0}})["medium"], medium);
  };
  expect_medium("N-BK7", "air");
  expect_medium("water_20.0C", "vacuum");
}

}  // namespace
}  // namespace abbe::test
