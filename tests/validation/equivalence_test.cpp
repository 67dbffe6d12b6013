#include "validation/statistics.h"

#include <gtest/gtest.h>

#include "validation/cases/case.h"

namespace abbe {
namespace {

TEST(Equivalence, PassesOnlyWithTheWholeIntervalInside) {
  EXPECT_EQ(equivalence({1.001, 0.001}, 1, 0.01), Verdict::pass);
  EXPECT_EQ(equivalence({1.001, 0.002}, 1, 0.01), Verdict::inconclusive);
  EXPECT_EQ(equivalence({1.02, 0.001}, 1, 0.01), Verdict::fail);
}

TEST(Equivalence, ABiasWithinTheMarginStillFailsOnceItIsCertain) {
  EXPECT_EQ(equivalence({1.0099, 0.0001}, 1, 0.01), Verdict::fail);
}

TEST(Equivalence, NoNumberFails) {
  EXPECT_EQ(equivalence({0.0 / 0.0, 0.001}, 1, 0.01), Verdict::fail);
}

// The closed forms themselves, against published or independently computed figures.
TEST(Cases, ExpectedValuesAreTheKnownFigures) {
  const auto expected = [](const std::string& id) {
    for (const Case& item : all_cases())
      if (const auto* film = std::get_if<FilmMean>(&item.method); film && item.id == id)
        return film->expected();
    ADD_FAILURE() << id;
    return 0.0;
  };
  const double pi = 3.14159265358979;
  const std::vector<std::pair<const char*, double>> known{{"T1-0.5", 104.16667 * 2},
                                                          {"T2-centre", 198.94368},
                                                          {"T2-corner", 38.28673},
                                                          {"T3-corner", .13853161 * pi},
                                                          {"T3-centre", .23945647 * pi},
                                                          {"T4", .05573420 * pi},
                                                          {"T5-axis", .5 * pi},
                                                          {"T5-off", .06587843 * pi},
                                                          {"T6-adjacent", .20004378 * pi},
                                                          {"T6-discs", .38196601 * pi},
                                                          {"T8", 100 / (4 * pi) * 32.885906 / .98},
                                                          {"T9-outer", .4},
                                                          {"T9-inner", .2},
                                                          {"T10-upper", 4.0 / 3},
                                                          {"T10-lower", 2.0 / 3},
                                                          {"T11-4", .5904 * pi},
                                                          {"T13-0", .92307692 * pi / 4},
                                                          {"T13-60", .848128 * pi / 4},
                                                          {"T13-60-off", .836232 * pi / 4},
                                                          {"prism-N-BK7", .888681 * pi / 4},
                                                          {"T14-2", .85714286 * pi / 4},
                                                          {"T14-3", .8 * pi / 4},
                                                          {"T15-T", .33911112 * pi / 4},
                                                          {"T15-R", .04499008 * pi / 4}};
  for (const auto& [id, value] : known) EXPECT_NEAR(expected(id), value, 1e-5 * value) << id;
  // The integrands of these cases have steps where rays begin to miss the disc.
  const std::vector<std::pair<const char*, double>> stepped{{"ball-disc", .335174},
                                                            {"ball-meter", 6.760140},
                                                            {"ball-axis", 1.126585},
                                                            {"pane-thick", .752064},
                                                            {"pane-thin", .579721}};
  for (const auto& [id, value] : stepped) EXPECT_NEAR(expected(id), value, 3e-5 * value) << id;
  EXPECT_NEAR(expected("worked-example") * 4.5e-6 * 4.5e-6, 2433, 0.5);
  EXPECT_NEAR(expected("T17-60") / expected("T17-0"), 0.60899778, 1e-8);
  EXPECT_NEAR(expected("T17-90") / expected("T17-0"), 0.31830989, 1e-8);
}

}  // namespace
}  // namespace abbe
