#include <gtest/gtest.h>

#include "cli/query.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"

// Angles of materials that absorb.

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

}  // namespace
}  // namespace abbe::test
