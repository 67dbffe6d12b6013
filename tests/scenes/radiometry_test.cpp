// Every case that renders.
#include "tests/tier.h"
#include "tests/validation/cases_run.h"

namespace abbe {
namespace {

class RenderedCase : public testing::TestWithParam<Case> {};

TEST_P(RenderedCase, AgreesWithItsReference) {
  test::expect_passes(GetParam(), {.thorough = test::nightly()});
}

INSTANTIATE_TEST_SUITE_P(Cases, RenderedCase, testing::ValuesIn(test::cases_by<FilmMean, RenderedChart>()),
                         test::case_name);

}  // namespace
}  // namespace abbe
