// Every case that renders.
#include <set>
#include <string>
#include <vector>

#include "tests/tier.h"
#include "tests/validation/cases_run.h"

namespace abbe {
namespace {

class RenderedCase : public testing::TestWithParam<Case> {};

TEST_P(RenderedCase, AgreesWithItsReference) {
  test::expect_passes(GetParam(), {.thorough = test::nightly()});
}

// Those that take long, and of each kind another one by day.
const std::set<std::string> kByNight{"T1-0.95",
                                     "T8",
                                     "T10-lower",
                                     "T14-3",
                                     "T16-outside",
                                     "ball-meter",
                                     "layer-1",
                                     "chart-A",
                                     "chart-D50",
                                     "chart-FL2",
                                     "chart-FL11",
                                     "chart-LED-B1",
                                     "T3-x",
                                     "T12-FL11",
                                     "flat-bessell_B-5000",
                                     "flat-bessell_R-5000",
                                     "flat-bessell_I-5000",
                                     "flat-bessell_V-2856",
                                     "flat-bessell_R-2856",
                                     "flat-bessell_I-2856",
                                     "flat-bessell_B-6500",
                                     "flat-bessell_V-6500"};

std::vector<Case> cases(bool by_night) {
  std::vector<Case> chosen = test::cases_by<FilmMean, RenderedChart>();
  std::erase_if(chosen, [&](const Case& item) { return kByNight.contains(item.id) != by_night; });
  return chosen;
}

INSTANTIATE_TEST_SUITE_P(Cases, RenderedCase, testing::ValuesIn(cases(false)), test::case_name);
INSTANTIATE_TEST_SUITE_P(Nightly, RenderedCase, testing::ValuesIn(cases(true)), test::case_name);

}  // namespace
}  // namespace abbe
