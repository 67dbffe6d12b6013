#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "validation/cases/case.h"

namespace abbe {

void PrintTo(const Case& item, std::ostream* out) {
  *out << item.id << ": " << item.title;
}

namespace {

#ifdef ABBE_NIGHTLY
constexpr bool kNightly = true;
#else
constexpr bool kNightly = false;
#endif

class Radiometry : public testing::TestWithParam<Case> {};

TEST_P(Radiometry, AgreesWithItsClosedForm) {
  const Case& item = GetParam();
  const double margin = kNightly ? item.nightly_margin : item.margin;
  const CaseResult result = run_case(item, margin);
  RecordProperty("measured", std::to_string(result.measured.mean));
  std::printf("%s %s: expected %.8g, measured %.8g +- %.2g (%d samples per pixel, %.1f CPU s)\n",
              item.id.c_str(), item.title.c_str(), item.expected, result.measured.mean,
              result.measured.standard_error, result.samples, result.cpu_s);
  EXPECT_EQ(result.verdict, Verdict::pass)
      << item.source << ": relative difference " << result.measured.mean / item.expected - 1 << ", margin "
      << margin;
}

std::string test_name(const testing::TestParamInfo<Case>& info) {
  return info.param.id + "_" + std::to_string(info.index);
}

INSTANTIATE_TEST_SUITE_P(Cases, Radiometry, testing::ValuesIn(radiometry_cases()), test_name);

}  // namespace
}  // namespace abbe
