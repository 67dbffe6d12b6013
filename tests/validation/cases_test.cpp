// Every case that needs no render; tests/scenes has the others.
#include <filesystem>
#include <regex>
#include <set>

#include "io/reference_table.h"
#include "tests/validation/cases_run.h"

namespace abbe {
namespace {

class ComputedCase : public testing::TestWithParam<Case> {};

TEST_P(ComputedCase, AgreesWithItsReference) {
  test::expect_passes(GetParam(), {});
}

INSTANTIATE_TEST_SUITE_P(Cases, ComputedCase, testing::ValuesIn(test::cases_by<Computed>()), test::case_name);

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
