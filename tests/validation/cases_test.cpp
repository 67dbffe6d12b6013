// Every case that needs no render; tests/scenes has the others.
#include <algorithm>
#include <array>
#include <filesystem>
#include <regex>
#include <set>

#include "io/table.h"
#include "tests/validation/cases_run.h"

namespace abbe {
namespace {

// One test per suite, since every process that lists the cases computes all expected values anew.
class ComputedCases : public testing::TestWithParam<Suite> {};
constexpr std::array kComputedSuites{Suite::optics, Suite::colour, Suite::camera, Suite::sensor};

std::string suite_name(Suite suite) {
  return std::string(kSuiteNames.at(static_cast<std::size_t>(suite)));
}

TEST_P(ComputedCases, AgreeWithTheirReferences) {
  int run = 0;
  for (const Case& item : test::cases_by<Computed>()) {
    if (item.suite != GetParam()) continue;
    SCOPED_TRACE(item.id);
    test::expect_passes(item, {});
    ++run;
  }
  EXPECT_GT(run, 0);
}

INSTANTIATE_TEST_SUITE_P(Suites, ComputedCases, testing::ValuesIn(kComputedSuites),
                         [](const testing::TestParamInfo<Suite>& info) { return suite_name(info.param); });

TEST(CaseList, EveryComputedCaseIsRunAbove) {
  for (const Case& item : test::cases_by<Computed>())
    EXPECT_NE(std::find(kComputedSuites.begin(), kComputedSuites.end(), item.suite), kComputedSuites.end())
        << item.id;
}

TEST(CaseList, EveryCaseHasAnIdOfItsOwnAndASource) {
  std::set<std::string> ids;
  std::set<Suite> suites;
  for (const Case& item : all_cases()) {
    EXPECT_TRUE(ids.insert(item.id).second) << item.id << " twice";
    EXPECT_TRUE(std::regex_search(item.source, std::regex(R"(\[[A-Z]\w+\d\w*)")))
        << item.id << ": " << item.source;
    EXPECT_GT(item.margin.value, 0) << item.id;
    suites.insert(item.suite);
  }
  EXPECT_EQ(suites.size(), kSuiteNames.size());
}

Case planted(double measured, double standard_error, Margin margin) {
  return {Suite::optics, "planted", "", "", "", margin, Computed{[=] {
            return std::vector<Figure>{{"good", 2, {2, 0}}, {"judged", 2, {measured, standard_error}}};
          }}};
}

TEST(CaseVerdict, MarginsAreHeld) {
  EXPECT_TRUE(run_case(planted(2.09, 0, {0.1})).passed());
  EXPECT_FALSE(run_case(planted(2.11, 0, {0.1})).passed());
  EXPECT_TRUE(run_case(planted(1.81, 0, {0.1, Margin::Kind::relative})).passed());
  EXPECT_FALSE(run_case(planted(1.79, 0, {0.1, Margin::Kind::relative})).passed());
  EXPECT_FALSE(run_case(planted(std::nan(""), 0, {0.1})).passed());
}

TEST(CaseVerdict, NoiseCountsAgainstASampledFigure) {
  EXPECT_TRUE(run_case(planted(2.05, 0.001, {0.1})).passed());
  EXPECT_EQ(run_case(planted(2.05, 0.05, {0.1})).verdict, Verdict::inconclusive);
}

TEST(CaseVerdict, TheWorstFigureIsNamed) {
  EXPECT_EQ(run_case(planted(2.01, 0, {0.1})).worst, 1U);
  EXPECT_EQ(run_case(planted(2, 0, {0.1})).worst, 0U);
  const Case undefined{Suite::optics, "planted", "", "", "", {0.1}, Computed{[] {
                         return std::vector<Figure>{{"no number", 2, {std::nan(""), 0}}, {"far", 2, {9, 0}}};
                       }}};
  EXPECT_EQ(run_case(undefined).worst, 0U) << "no number is worse than any";
}

TEST(CaseVerdict, NoFiguresAreNoPass) {
  EXPECT_FALSE(
      run_case({Suite::optics, "empty", "", "", "", {1}, Computed{[] { return std::vector<Figure>{}; }}})
          .passed());
}

TEST(Reference, WhatIsNotThereIsAnError) {
  const ReferenceTable table("beer_lambert");
  EXPECT_THROW(static_cast<void>(table.number(0, "name")), Error);
  EXPECT_THROW(static_cast<void>(table.number(table.rows(), "tau")), Error);
  EXPECT_THROW(static_cast<void>(table.text(0, "nothing")), Error);
  EXPECT_THROW(ReferenceTable("nothing"), Error);
}

}  // namespace
}  // namespace abbe
