// Every case that renders.
#include "tests/validation/cases_run.h"

namespace abbe {
namespace {

#ifdef ABBE_NIGHTLY
constexpr bool kNightly = true;
#else
constexpr bool kNightly = false;
#endif

class RenderedCase : public testing::TestWithParam<Case> {};

TEST_P(RenderedCase, AgreesWithItsReference) {
  test::expect_passes(GetParam(), {.thorough = kNightly});
}

INSTANTIATE_TEST_SUITE_P(Cases, RenderedCase, testing::ValuesIn(test::cases_by<FilmMean, RenderedChart>()),
                         test::case_name);

}  // namespace
}  // namespace abbe
