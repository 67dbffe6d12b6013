#include "cli/answer.h"

#include <limits>

#include <gtest/gtest.h>

#include "cli/compare.h"
#include "io/exr.h"
#include "tests/cli/program.h"

namespace abbe::cli {
namespace {

TEST(Answer, JsonKeepsOrderAndEveryDigit) {
  const double third = 1.0 / 3;
  const std::string line = text({{"z", third}, {"a", nullptr}}, true);
  EXPECT_EQ(line, "{\"z\":0.3333333333333333,\"a\":null}\n");
  EXPECT_EQ(Json::parse(line)["z"].get<double>(), third);
}

TEST(Answer, ReadableAnswersPutWavelengthsInColumns) {
  const Json answer{{"name", "N-BK7"}, {"wavelength_nm", {400.0, 550.5}}, {"n", {1.53, nullptr}}};
  EXPECT_EQ(text(answer, false),
            "name  N-BK7\nwavelength_nm     n\n          400  1.53\n        550.5     -\n");
}

TEST(Answer, NumbersThatAreNotFiniteAreADashWhereJsonHasNull) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const Json answer{{"ratio", -kNone}, {"all", {1.5, kNone, std::numeric_limits<double>::infinity()}}};
  EXPECT_EQ(text(answer, false), "ratio  -\nall  1.5  -  -\n");
  EXPECT_EQ(text(answer, true), "{\"ratio\":null,\"all\":[1.5,null,null]}\n");
}

TEST(Answer, BlackFilmsHaveNoRatio) {
  const std::filesystem::path black = test::scratch() / "black.exr";
  write_exr(black, {1, 1, {{"Y", {0}}}, {}});
  testing::internal::CaptureStdout();
  EXPECT_NO_THROW(compare({black, black}));
  const std::string printed = testing::internal::GetCapturedStdout();
  EXPECT_NE(printed.find("\nmean_ratio  -\n"), std::string::npos) << printed;
}

TEST(Answer, ReadableListsStayInTheirLine) {
  const Json answer{{"XYZ", {1.0, 2.5, 3.0}}, {"raw", {{"R", 0.5}, {"G", 1.0}}}};
  EXPECT_EQ(text(answer, false), "XYZ  1  2.5  3\nraw  R 0.5  G 1\n");
}

TEST(Answer, OneValueIsNoList) {
  EXPECT_EQ(one_or_all({1.5}).dump(), "1.5");
  EXPECT_EQ(one_or_all({1.5, 2.0}).dump(), "[1.5,2.0]");
}

TEST(Answer, ListsOfOneAreTheirElementAtAnyDepth) {
  EXPECT_EQ(without_lists_of_one(
                Json::parse(R"({"a":[1.5],"b":[[2.5],[3.5]],"c":[[4.5]],"d":"x","e":{"f":[5.5]},"g":[]})"))
                .dump(),
            R"({"a":1.5,"b":[2.5,3.5],"c":4.5,"d":"x","e":{"f":5.5},"g":[]})");
}

TEST(Answer, UnknownNamesOfTheCommandLineAreMissingInputs) {
  Diagnostics diagnostics;
  diagnostics.error({}, "unknown material \"x\"");
  try {
    check(diagnostics);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code, ErrorCode::input);
    EXPECT_NE(std::string(e.what()).find("unknown material \"x\""), std::string::npos);
  }
}

TEST(Answer, PlacedComplaintsKeepTheirCodeAndBeginTheirLine) {
  Diagnostics diagnostics;
  diagnostics.error({std::make_shared<SourceText>(SourceText{"a.json", "{}"}), 0, "/camera"}, "no camera");
  try {
    check(diagnostics);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code, ErrorCode::scene);
    EXPECT_NE(std::string(e.what()).find("\na.json:1:1: /camera: "), std::string::npos) << e.what();
  }
}

TEST(Answer, AListOfNamesAnswersNoQuestion) {
  const test::Outcome run = test::abbe("query --list illuminant --json ior N-BK7 --at 550");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(
      run.err.find("--list: lists names only and cannot be combined with a query (got ior, allowed alone)"),
      std::string::npos)
      << run.err;
  EXPECT_TRUE(run.out.empty());
}

}  // namespace
}  // namespace abbe::cli
