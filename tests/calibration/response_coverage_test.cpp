#include "tests/calibration/response_fixture.h"

namespace abbe::test {
namespace {

TEST(ResponseCoverage, HundredNoisySeriesOfEachCurve) {
  for (const char* name : {"linear", "gamma:2.2", "s-curve"}) {
    const Recovery recovery = recover_often(name, 100);
    RecordProperty(std::string("coverage of ") + name, std::to_string(recovery.coverage));
    EXPECT_LT(recovery.worst, 0.003) << name;
    EXPECT_GE(recovery.coverage, 0.90) << name;
    EXPECT_LE(recovery.coverage, 0.99) << name;
  }
}

// The series do not state how the noise of a code grows with it.
TEST(ResponseCoverage, HundredSeriesOfSinglePixelsOfEachCurve) {
  for (const char* name : {"linear", "gamma:2.2", "s-curve"}) {
    const Recovery recovery = recover_often(name, 100, kSinglePixels, false);
    RecordProperty(std::string("coverage of single pixels of ") + name, std::to_string(recovery.coverage));
    EXPECT_GE(recovery.coverage, 0.90) << name;
    EXPECT_LE(recovery.coverage, 0.99) << name;
  }
}

}  // namespace
}  // namespace abbe::test
