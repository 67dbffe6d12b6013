#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include "cli/query.h"
#include "materials/index/library.h"
#include "materials/index/relative_index.h"
#include "spectral/air.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"

// Materials that absorb or whose absorption is unknown, and the medium in which angles are given.

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

TEST(QueryAngles, AreInAirAsInScenes) {
  for (const char* id : {"N-BK7", "water_20.0C"}) {
    EXPECT_EQ(json_output(cli::query_prism, {id, 60, {550}, {}})["medium"], "air");
    EXPECT_EQ(json_output(cli::query_critical, {id, {550}})["medium"], "air");
    EXPECT_EQ(json_output(cli::query_brewster, {id, {550}})["medium"], "air");
    EXPECT_EQ(json_output(cli::query_reflectance, {id, {550}, {0}})["medium"], "air");
  }
  // The catalogued index of water is relative to vacuum.
  constexpr double kWavelengthNm = 587.5618;
  EXPECT_NEAR(json_output(cli::query_critical, {"water_20.0C", {kWavelengthNm}})["angle_deg"].get<double>(),
              48.605, 5e-4);
  Diagnostics diagnostics;
  const NamedIndex water = *load_index("water_20.0C", {}, diagnostics);
  const double in_scenes =
      relative_index(water.index, nullptr, SampledSpectrum(static_cast<float>(kWavelengthNm))).n[0];
  EXPECT_NEAR(json_output(cli::query_brewster, {"water_20.0C", {kWavelengthNm}})["angle_deg"].get<double>(),
              std::atan(in_scenes) * 180 / std::numbers::pi, 1e-5);
  EXPECT_NEAR(json_output(cli::query_prism, {"water_20.0C", 60, {kWavelengthNm}, {}})["n"].get<double>(),
              in_scenes, 1e-6);
}

// Reflectance of one transparent layer at normal incidence by its characteristic matrix [Born1999, sec. 1.6].
TEST(QueryAngles, UnderACoatingAllIndicesAreRelativeToAir) {
  cli::ReflectanceOptions options{"water", {550}};
  options.coating = "MgF2:100";
  const json coated = json_output(cli::query_reflectance, options);
  EXPECT_EQ(coated["medium"], "air");
  const double water = json_output(cli::query_ior, {"water", {550}})["n"].get<double>() / air_index(550);
  const double film = json_output(cli::query_ior, {"MgF2", {550}})["n"];
  const double phase = 2 * std::numbers::pi * film * 100 / 550;
  const std::complex<double> b(std::cos(phase), -water / film * std::sin(phase));
  const std::complex<double> c(water * std::cos(phase), -film * std::sin(phase));
  EXPECT_NEAR(coated["R"].get<double>(), std::norm((b - c) / (b + c)), 1e-12);
  options.coating = "";
  const double r = (water - 1) / (water + 1);
  EXPECT_NEAR(json_output(cli::query_reflectance, options)["R"].get<double>(), r * r, 1e-12);
}

TEST(QueryIor, ExtinctionThatIsNotMeasuredIsUnknownAndForbidsNoIndex) {
  cli::IndexOptions options{"N-LASF31A", {300, 334, 500}};
  options.thickness_mm = 10;
  const json glass = json_output(cli::query_ior, options);
  EXPECT_GT(glass["n"][0], 1.9);
  EXPECT_TRUE(glass["k"][0].is_null());
  EXPECT_TRUE(glass["internal_transmittance"][0].is_null());
  EXPECT_DOUBLE_EQ(glass["k"][1].get<double>(), 5.4391e-06);
  EXPECT_TRUE(glass["internal_transmittance"][2].is_number());
  for (const char* clear : {"water", "hoya/FCD1"}) {
    options = {clear, {650}};
    options.thickness_mm = 1000;
    const json found = json_output(cli::query_ior, options);
    EXPECT_TRUE(found["n"].is_number());
    EXPECT_TRUE(found["k"].is_null() && found["internal_transmittance"].is_null()) << found;
  }
  testing::internal::CaptureStdout();
  options.json = false;
  EXPECT_NO_THROW(cli::query_ior(options));
  EXPECT_NE(testing::internal::GetCapturedStdout().find("k  -\n"), std::string::npos);
}

TEST(QueryList, TellsWhereExtinctionsAreMeasured) {
  const json told = json_output(cli::query_list, {"material"});
  const auto place = [&](const char* name) {
    return static_cast<std::size_t>(std::ranges::find(told["material"], name) - told["material"].begin());
  };
  EXPECT_EQ(told["low_nm"][place("N-LASF31A")], 250);
  EXPECT_EQ(told["k_low_nm"][place("N-LASF31A")], 334);
  EXPECT_EQ(told["k_high_nm"][place("N-LASF31A")], 2500);
  EXPECT_TRUE(told["k_low_nm"][place("water")].is_null());
  testing::internal::CaptureStdout();
  EXPECT_NO_THROW(cli::query_list({"material"}));
  const std::string listed = testing::internal::GetCapturedStdout();
  EXPECT_NE(listed.find("\nN-LASF31A\t250-2500 nm (k 334-2500 nm)\t"), std::string::npos);
  EXPECT_NE(listed.find("\nwater\t"), std::string::npos);
  EXPECT_NE(listed.find(" nm (k unknown)\t"), std::string::npos);
}

TEST(QueryReflectance, WhereItHangsOnAnExtinctionThatIsNotMeasuredIsAnError) {
  const auto metal = scratch().write("metal.yml",
                                     "DATA:\n  - type: tabulated n\n    data: |\n      0.4 1\n      0.7 1\n"
                                     "  - type: tabulated k\n    data: |\n      0.5 3\n      0.6 3\n");
  const cli::ReflectanceOptions within{metal.string(), {550}};
  EXPECT_NEAR(json_output(cli::query_reflectance, within)["R"].get<double>(), 9.0 / 13, 1e-12);
  EXPECT_EQ(fault(
                [&] {
                  (void)cli::query_reflectance({metal.string(), {550, 450}});
                },
                "the k of metal has no data at this wavelength (got 450 nm, allowed [500, 600] nm)"),
            ErrorCode::usage);
  cli::ReflectanceOptions coated{"N-BK7", {450}};
  coated.coating = metal.string() + ":20";
  EXPECT_EQ(fault([&] { (void)cli::query_reflectance(coated); }, "the k of metal"), ErrorCode::usage);
  EXPECT_TRUE(json_output(cli::query_reflectance, {"N-LASF31A", {300}})["R"].is_number())
      << "which its small k does not change";
}

}  // namespace
}  // namespace abbe::test
