#include "calibration/chart/measured_patches.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "calibration/camera_calibration.h"
#include "calibration/chart/delta_e.h"
#include "calibration/fit/correction.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

ChartTargets colors_of(const std::string& name, const std::string& light = "D50") {
  Diagnostics diagnostics;
  auto colors = load_chart_targets(name, test::illuminant(light), {}, diagnostics);
  EXPECT_TRUE(colors) << diagnostics.text();
  return colors.value_or(ChartTargets{});
}

// Mean CIEDE2000 between two charts, each relative to its own white.
double mean_difference(const ChartTargets& a, const ChartTargets& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.xyz.size(); ++i)
    sum += delta_e_2000(xyz_to_lab(a.xyz[i], a.white), xyz_to_lab(b.xyz[i], b.white));
  return sum / static_cast<double>(a.xyz.size());
}

// Published differences between editions.
TEST(ChartTargets, EditionsDifferAsPublished) {
  const ChartTargets babel = colors_of("colorchecker24_babelcolor_average_xyY");
  const ChartTargets before = colors_of("colorchecker24_before_nov2014");
  const ChartTargets after = colors_of("colorchecker24_after_nov2014");
  const ChartTargets stated_2005 = colors_of("colorchecker24_2005_xyY");
  EXPECT_NEAR(mean_difference(before, after), 0.848, 0.001);
  EXPECT_NEAR(mean_difference(stated_2005, babel), 0.489, 0.001);
  EXPECT_LT(mean_difference(colors_of("colorchecker24_babelcolor_average"), babel), 0.1);
  EXPECT_EQ(colors_of("colorcheckersg_after_nov2014").xyz.size(), 140U);
  EXPECT_EQ(colors_of("colorchecker24_1976_xyY").xyz.size(), 24U);
  EXPECT_NEAR(colors_of("colorchecker24_1976_xyY").white[0], 0.31006 / 0.31616, 1e-12);
}

class Measured : public testing::Test {
 protected:
  std::optional<MeasuredPatches> read(const std::string& rows) {
    std::ofstream(path_) << "# unit: linear camera values\n" << rows;
    return load_measured_patches(path_, diagnostics_);
  }
  void TearDown() override { std::filesystem::remove(path_); }

  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / ("abbe_measured_" + std::to_string(::getpid()) + ".csv");
  Diagnostics diagnostics_;
};

// A camera whose values are the chart's XYZ times a known matrix and gains.
TEST_F(Measured, RecoversTheMatrixOfAMeasuredCamera) {
  const ChartTargets chart = colors_of("colorchecker24_after_nov2014");
  const Matrix3 planted(0.6, 0.25, 0.1142, 0.2, 0.95, -0.15, 0.05, -0.2, 0.9751);
  const Raw gains{1.9, 1, 1.4};
  const Raw diffuser = multiply(planted.inverse(), chart.white);
  std::string rows = "patch,R,G,B\n";
  const auto add = [&](const std::string& name, const XYZ& xyz) {
    const Raw raw = multiply(planted.inverse(), xyz);
    rows += fmt::format("{},{},{},{}\n", name, raw[0] / gains[0], raw[1] / gains[1], raw[2] / gains[2]);
  };
  for (std::size_t i = 0; i < 24; ++i) add(chart.names[i], chart.xyz[i]);
  const auto without_white = read(rows);
  add("perfect diffuser", chart.white);
  const auto measured = read(rows);
  ASSERT_TRUE(measured && without_white) << diagnostics_.text();
  const BalancedPatches balanced = balance(chart, *measured);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(balanced.gains[k], gains[k] / diffuser[k], 1e-12);
  EXPECT_LT(fit_correction(balanced.colors).errors.max, 1e-4);
  const BalancedPatches by_greys = balance(chart, *without_white);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(by_greys.gains[k] / balanced.gains[k], 1, 1e-9)
        << "though the chart's greys are not quite neutral";
}

TEST_F(Measured, BalancesOnNeutralPatchesAlone) {
  const XYZ white{0.9, 1, 0.8};
  const ChartTargets chart{
      {"grey", "red", "dark"}, {{0.45, 0.5, 0.4}, {0.4, 0.35, 0.2}, {0.09, 0.1, 0.08}}, white};
  const BalancedPatches balanced =
      balance(chart, {{"dark", "grey", "red"}, {{0.02, 0.1, 0.05}, {0.1, 0.5, 0.25}, {0.3, 0.1, 0.1}}});
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(balanced.gains[k], Raw({5, 1, 2})[k], 1e-12);
    EXPECT_NEAR(balanced.colors.raw[0][k], 0.5, 1e-12);
    EXPECT_NEAR(balanced.colors.raw[1][k], Raw({1.5, 0.1, 0.2})[k], 1e-12);
  }
}

// A black patch is neutral but carries no information about white.
TEST_F(Measured, BalancesWithoutTheBlackPatches) {
  const XYZ white{0.9, 1, 0.8};
  ChartTargets chart{{"black", "grey"}, {{0, 0, 0}, {0.45, 0.5, 0.4}}, white};
  MeasuredPatches measured{{"black", "grey"}, {{0.01, 0.01, 0.01}, {0.1, 0.5, 0.25}}};
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(balance(chart, measured).gains[k], Raw({5, 1, 2})[k], 1e-12);
  // With colours that determine a matrix, for a camera whose values are X, Y and Z.
  for (const XYZ& xyz : {XYZ{0.4, 0.2, 0.1}, XYZ{0.2, 0.4, 0.1}, XYZ{0.2, 0.1, 0.5}}) {
    chart.names.push_back(std::to_string(chart.names.size()));
    chart.xyz.push_back(xyz);
  }
  const BalancedPatches balanced = balance(chart, {chart.names, chart.xyz});
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(balanced.gains[k] * white[k], 1, 1e-9);
}

TEST_F(Measured, ChartsOfNoColoursAreRefusedAtTheirRows) {
  const auto chart_of = [&](const std::string& rows) {
    std::ofstream(path_) << "# unit: 1\n# outside: clamp\n# white_xy: 0.3, 0.3\n" << rows;
    return load_chart_targets(path_.string(), Curve(1), {}, diagnostics_);
  };
  const auto black = chart_of("patch,x,y,Y\nblack,0,0,0\nwhite,0.3,0.3,1\n");
  ASSERT_TRUE(black) << diagnostics_.text();
  EXPECT_EQ(black->xyz[0], (XYZ{0, 0, 0}));
  EXPECT_EQ(black->xyz[1], black->white);
  EXPECT_FALSE(
      chart_of("patch,x,y,Y\nred,0.5,0.3,0.2\nno,0.3,0,0.5\nlow,0.3,-0.1,0.5\nbig,1,1e-300,1e300\n"));
  EXPECT_EQ(diagnostics_.code(), ErrorCode::input);
  const std::string allowed = ", allowed y above 0 or a Y of 0, and finite X, Y, Z)";
  for (const std::string& said : {"csv:6:1: error: states no colour (got 0.3, 0, 0.5" + allowed,
                                  "csv:7:1: error: states no colour (got 0.3, -0.1, 0.5" + allowed,
                                  "csv:8:1: error: states no colour (got 1, 1e-300, 1e+300" + allowed})
    EXPECT_NE(diagnostics_.text().find(said), std::string::npos) << diagnostics_.text();
  EXPECT_EQ(diagnostics_.text().find("csv:5:1"), std::string::npos) << diagnostics_.text();
  diagnostics_ = {};
  EXPECT_FALSE(chart_of("patch,L,a,b\nno,1e200,0,0\n"));
  EXPECT_NE(
      diagnostics_.text().find("csv:5:1: error: states no colour (got 1e+200, 0, 0, allowed L, a, b of"),
      std::string::npos)
      << diagnostics_.text();
}

// L = 150 corresponds to Y = (166/116)^3.
TEST_F(Measured, ChartsInPercentAreRefusedAtTheirRows) {
  const auto complaint = [&](const std::string& rows) {
    std::ofstream(path_) << "# unit: 1\n# white_xy: 0.3, 0.3\n" << rows;
    diagnostics_ = {};
    EXPECT_FALSE(load_chart_targets(path_.string(), Curve(1), {}, diagnostics_));
    EXPECT_EQ(diagnostics_.code(), ErrorCode::input);
    EXPECT_EQ(diagnostics_.all().size(), 1U);
    return diagnostics_.text();
  };
  const std::string allowed = ", allowed 2 at most: Y of the perfect diffuser is 1)";
  const std::string xyy = complaint("patch,x,y,Y\nbright,0.3,0.3,2\nwhite,0.3457,0.3585,91.29\n");
  EXPECT_NE(xyy.find("csv:5:1: error: has another scale (got a Y of 91.29" + allowed), std::string::npos)
      << xyy;
  const std::string lab = complaint("patch,L,a,b\nbright,130,0,0\nbrighter,150,0,0\nblack,0,0,0\n");
  EXPECT_NE(lab.find("csv:5:1: error: has another scale (got a Y of 2.93056" + allowed), std::string::npos)
      << lab;
}

TEST_F(Measured, PatchesOfOnePixelTellNoNoise) {
  const auto with_blue = [&](const std::string& deviation) {
    diagnostics_ = {};
    const auto patches = read(
        "patch,R,G,B,R_deviation,G_deviation,B_deviation,R_pixels,G_pixels,B_pixels\n"
        "red,3,2,1,0.2,0.4,0,4,16,25\ngrey,2,2,2,0.2,0.4," +
        deviation + ",4,16,1\n");
    EXPECT_TRUE(patches) << diagnostics_.text();
    return patches.value_or(MeasuredPatches{}).deviations;
  };
  const std::string warning =
      "csv:4:1: warning: patch \"grey\" has no B_deviation, as one pixel gives none: all patches get equal "
      "weights";
  for (const char* unknown : {"", "0", "0.0"}) {
    EXPECT_TRUE(with_blue(unknown).empty()) << unknown;
    EXPECT_EQ(diagnostics_.all().size(), 1U);
    EXPECT_NE(diagnostics_.text().find(warning), std::string::npos) << diagnostics_.text();
  }
  const std::vector<Raw> known = with_blue("0.3");
  ASSERT_EQ(known.size(), 2U);
  test::expect_near(known[0], {0.1, 0.1, 0}, 1e-15);
  test::expect_near(known[1], {0.1, 0.1, 0.3}, 1e-15);
  EXPECT_TRUE(diagnostics_.all().empty()) << diagnostics_.text();
}

// The second patch of the table has the given deviations, pixels and saturated fractions.
TEST_F(Measured, PatchesThatAreLeftOutMayTellNoNoise) {
  const auto with_second = [&](const std::string& cells) {
    diagnostics_ = {};
    return read(
        "patch,R,G,B,R_deviation,G_deviation,B_deviation,R_pixels,G_pixels,B_pixels,"
        "R_saturated,G_saturated,B_saturated\n"
        "red,3,2,1,0.2,0.4,0.5,4,16,25,0,0,0\nlamp,9,9,9," +
        cells + "\ngrey,2,2,2,0.6,0.4,0.5,4,16,25,0,0,0\n");
  };
  const auto left_out = with_second(",0,0.3,1,1,1,0,1,0");
  ASSERT_TRUE(left_out) << diagnostics_.text();
  ASSERT_EQ(left_out->deviations.size(), 3U);
  test::expect_near(left_out->deviations[0], {0.1, 0.1, 0.1}, 1e-15);
  test::expect_near(left_out->deviations[2], {0.3, 0.1, 0.1}, 1e-15);
  EXPECT_EQ(diagnostics_.all().size(), 1U) << diagnostics_.text();
  EXPECT_NE(diagnostics_.text().find("patch \"lamp\" has saturated pixels"), std::string::npos);
  const auto counted = with_second(",0,0.3,1,1,1,0,0,0");
  ASSERT_TRUE(counted) << diagnostics_.text();
  EXPECT_TRUE(counted->deviations.empty());
  for (const char* wrong : {",0,-0.3,1,1,1,0,0,0", ",0,0.3,1,1,0,0,0,0", ",0,much,1,1,1,0,0,0"}) {
    EXPECT_FALSE(with_second(wrong)) << wrong;
    EXPECT_EQ(diagnostics_.code(), ErrorCode::input);
  }
}

TEST_F(Measured, SaysWhatIsMissingOrUnknown) {
  const ChartTargets chart = colors_of("colorchecker24_after_nov2014");
  const auto few = read("patch,R,G,B\nperfect diffuser,1,1,1\ndark skin,0.1,0.1,0.1\n");
  ASSERT_TRUE(few);
  test::expect_error([&] { static_cast<void>(balance(chart, *few)); }, ErrorCode::input,
                     "missing: light skin, blue sky");
  const ChartTargets red{{"red"}, {{0.4, 0.2, 0.1}}, {0.95, 1, 1.09}};
  test::expect_error(
      [&] {
        static_cast<void>(balance(red, {{"red"}, {{0.4, 0.2, 0.1}}}));
      },
      ErrorCode::input, "nothing to balance white on");
  test::expect_error(
      [&] {
        static_cast<void>(balance(red, {{"red", "Perfect diffuser"}, {{0.4, 0.2, 0.1}, {1, 1, 1}}}));
      },
      ErrorCode::input, "unknown patch \"Perfect diffuser\"; did you mean \"perfect diffuser\"?");
  EXPECT_FALSE(read("patch,R,G\ndark skin,1,1\n"));
  EXPECT_NE(diagnostics_.text().find("no column \"B\""), std::string::npos);
}

TEST_F(Measured, NamesEachPatchOnce) {
  EXPECT_FALSE(read("patch,R,G,B\ngrey,0.1,0.1,0.1\nred,0.3,0.1,0.1\ngrey,0.2,0.2,0.2\n"));
  EXPECT_EQ(diagnostics_.code(), ErrorCode::input);
  EXPECT_NE(diagnostics_.text().find(".csv:5:1: error: patch \"grey\" is named twice"), std::string::npos)
      << diagnostics_.text();
}

TEST(ChartTargets, ReflectancesCannotBeMadeFromColours) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_chart("colorchecker24_after_nov2014", {}, diagnostics));
  EXPECT_NE(diagnostics.text().find("contains colours, but camera values"), std::string::npos);
}

// Hot pixels are saturated in any light.
TEST_F(Measured, PatchesOfFewDefectivePixelsCount) {
  const std::string columns = "patch,R,G,B,R_pixels,G_pixels,B_pixels,R_saturated,G_saturated,B_saturated\n";
  const auto measured = read(columns + "sound,1,1,1,200,400,200,2,4,0\nbright,1,1,1,200,400,200,0,5,0\n");
  ASSERT_TRUE(measured) << diagnostics_.text();
  EXPECT_EQ(measured->saturated, (std::set<std::string>{"bright"}));
  EXPECT_NE(diagnostics_.text().find("expose less, or show it on more pixels if defective ones exceed 1 %"),
            std::string::npos)
      << diagnostics_.text();
}

// The table of another program has no columns of saturated pixels, but its deviations reveal them.
TEST_F(Measured, PatchesWithoutNoiseAtTheTopAreClipped) {
  const std::string columns = "patch,R,G,B,R_deviation,G_deviation,B_deviation,R_pixels,G_pixels,B_pixels\n";
  const auto clipped = [&](const std::string& rows) {
    diagnostics_ = {};
    const auto measured = read(columns + rows);
    EXPECT_TRUE(measured) << diagnostics_.text();
    return measured ? measured->saturated : std::set<std::string>{};
  };
  const std::string noisy = "a,1,1,1,.1,.1,.1,50,50,50\n";
  EXPECT_EQ(clipped(noisy + "b,3,2,2,.1,0,.1,50,50,50\nc,2,2,1,.1,0,.1,50,50,50\n"),
            (std::set<std::string>{"b", "c"}));
  EXPECT_NE(
      diagnostics_.text().find(
          "csv:4:1: warning: patch \"b\" has the highest value of G in all its pixels, without the noise "
          "of others: it counts as clipped and is excluded"),
      std::string::npos)
      << diagnostics_.text();
  EXPECT_TRUE(clipped(noisy + "b,3,2,2,.1,0,.1,50,9,50\n").empty()) << "few pixels are even by chance";
  EXPECT_TRUE(clipped(noisy + "b,3,2,2,.1,0,.1,50,50,50\nc,2,1,1,.1,0,.1,50,50,50\n").empty())
      << "darker patches have no noise either";
}

}  // namespace
}  // namespace abbe
