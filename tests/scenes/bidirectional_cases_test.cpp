// Every film with a closed form, rendered by bidirectional path tracing.
#include "tests/validation/cases_run.h"

namespace abbe {
namespace {

// Enclosures whose paths have hundreds of events, every two of which are joined, are for the nights.
std::vector<Case> affordable() {
  std::vector<Case> cases = test::cases_by<FilmMean>();
#ifndef ABBE_NIGHTLY
  std::erase_if(cases, [](const Case& item) { return item.id == "T1-0.95" || item.id == "T8"; });
#endif
  return cases;
}

class BidirectionalCase : public testing::TestWithParam<Case> {};

TEST_P(BidirectionalCase, AgreesWithItsReference) {
  Case item = GetParam();
  std::get<FilmMean>(item.method).settings.push_back({"/render/integrator", "bdpt"});
  test::expect_passes(item, {});
}

INSTANTIATE_TEST_SUITE_P(Cases, BidirectionalCase, testing::ValuesIn(affordable()), test::case_name);

}  // namespace
}  // namespace abbe
