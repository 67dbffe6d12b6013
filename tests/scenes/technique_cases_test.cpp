// The matrix of techniques: every film with a closed form by every integrator that reaches its light.
#include "tests/tier.h"
#include "tests/validation/cases_run.h"

namespace abbe {
namespace {

// The cells that the night alone affords, or the others.
std::vector<Case> cells(bool nightly) {
  std::vector<Case> chosen = test::cases_by<TechniqueMean>();
  std::erase_if(chosen, [&](const Case& item) {
    return (std::get<TechniqueMean>(item.method).tier == Tier::thorough) != nightly;
  });
  return chosen;
}

class TechniqueCase : public testing::TestWithParam<Case> {};

TEST_P(TechniqueCase, AgreesWithItsReference) {
  test::expect_passes(GetParam(), {});
}

INSTANTIATE_TEST_SUITE_P(Cases, TechniqueCase, testing::ValuesIn(cells(false)), test::case_name);
INSTANTIATE_TEST_SUITE_P(Nightly, TechniqueCase, testing::ValuesIn(cells(true)), test::case_name);

}  // namespace
}  // namespace abbe
