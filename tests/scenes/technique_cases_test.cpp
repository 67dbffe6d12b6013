// The matrix of techniques: every film with a closed form by every integrator that reaches its light.
#include <set>
#include <string>
#include <vector>

#include "tests/tier.h"
#include "tests/validation/cases_run.h"

namespace abbe {
namespace {

// Those that take long, of techniques that others show by day.
const std::set<std::string> kByNight{"T1-0.8 by bdpt",
                                     "layer-1 by path",
                                     "ball-meter by light",
                                     "T1-0.2 by photon-brute",
                                     "T12-white by sppm",
                                     "T13-60 by photon-map",
                                     "T9-outer by vcm",
                                     "T9-outer by adjoint-brute",
                                     "T15-T by adjoint-brute",
                                     "T12-glass by adjoint-brute",
                                     "ball-inside by adjoint-brute"};

// The cells that tests by day afford, or those of the night.
std::vector<Case> cells(bool by_night) {
  std::vector<Case> chosen = test::cases_by<TechniqueMean>();
  std::erase_if(chosen, [&](const Case& item) {
    const Tier tier = std::get<TechniqueMean>(item.method).tier;
    return tier == Tier::never || (tier == Tier::thorough || kByNight.contains(item.id)) != by_night;
  });
  return chosen;
}

class TechniqueCase : public testing::TestWithParam<Case> {};

TEST_P(TechniqueCase, AgreesWithItsReference) {
  test::expect_passes(GetParam(), {.thorough = test::nightly()});
}

INSTANTIATE_TEST_SUITE_P(Cases, TechniqueCase, testing::ValuesIn(cells(false)), test::case_name);
INSTANTIATE_TEST_SUITE_P(Nightly, TechniqueCase, testing::ValuesIn(cells(true)), test::case_name);

}  // namespace
}  // namespace abbe
