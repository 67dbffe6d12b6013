// The matrix of techniques: every film with a closed form by every integrator that reaches its light.
#include <algorithm>
#include <initializer_list>
#include <vector>

#include "tests/tier.h"
#include "tests/validation/cases_run.h"

namespace abbe {
namespace {

// The cells that some of the tiers afford.
std::vector<Case> cells(std::initializer_list<Tier> tiers) {
  std::vector<Case> chosen = test::cases_by<TechniqueMean>();
  std::erase_if(chosen, [&](const Case& item) {
    return std::find(tiers.begin(), tiers.end(), std::get<TechniqueMean>(item.method).tier) == tiers.end();
  });
  return chosen;
}

class TechniqueCase : public testing::TestWithParam<Case> {};

TEST_P(TechniqueCase, AgreesWithItsReference) {
  test::expect_passes(GetParam(), {.thorough = test::nightly()});
}

INSTANTIATE_TEST_SUITE_P(Cases, TechniqueCase, testing::ValuesIn(cells({Tier::quick, Tier::tests})),
                         test::case_name);
INSTANTIATE_TEST_SUITE_P(Nightly, TechniqueCase, testing::ValuesIn(cells({Tier::thorough})), test::case_name);

}  // namespace
}  // namespace abbe
