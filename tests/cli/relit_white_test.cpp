#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/picture.h"
#include "tests/cli/lit_dome.h"

// White of pictures after the lights of a film were weighted differently.

namespace abbe::test {
namespace {

// For a film with light layers: the name of the white, and the warning about it.
struct Relit {
  std::string white;
  std::string err;
  double warmth;
};
Relit relit(const std::string& film, const std::string& options) {
  const Outcome run = abbe("develop " + film + " " + options + " --display " + file("relit.png"));
  EXPECT_EQ(run.code, 0) << run.err;
  return {read_picture(file("relit.png")).metadata.at("white"), run.err, warmth(file("relit.png"))};
}

class RelitFilm : public testing::TestWithParam<const char*> {};

// The ball is grey in the light of the D65 lamp alone, as if the dome emitted nothing.
TEST_P(RelitFilm, ShowsTheMainLightThatIsLeftAsWhite) {
  const std::string film = film_of(lit_dome("relit.json", GetParam()), "relit", "--layers lights");
  const Relit left = relit(film, "--light dome=0");
  EXPECT_EQ(left.white, "faint");
  EXPECT_LT(std::abs(left.warmth), 0.02);
  const bool corrects = GetParam() == kNikon;
  EXPECT_EQ(left.err.find("--white dome") != std::string::npos, corrects) << left.err;
  EXPECT_EQ(left.err.empty(), !corrects) << left.err;
  for (const char* same : {"--light dome=0.5", "--light faint=0", "--light dome=3 --light faint=3",
                           "--light dome=0 --light faint=0", "--light dome=0 --white dome"}) {
    const Relit kept = relit(film, same);
    EXPECT_EQ(kept.white, "dome") << same;
    EXPECT_EQ(kept.err, "") << same;
  }
  const Relit asked = relit(film, "--light dome=0 --white A");
  EXPECT_EQ(asked.white, "A");
  EXPECT_EQ(asked.err, "");
}

TEST_P(RelitFilm, KeepsTheWhiteThatItsSceneAsksForWhateverLightsAreLeft) {
  for (const char* white : {"FL11", "faint", "dome"}) {
    const std::string film =
        film_of(lit_dome("told.json", GetParam(), fmt::format("\"{}\"", white)), "told", "--layers lights");
    for (const char* lights : {"--light dome=0", "--light faint=0"}) {
      const Relit kept = relit(film, lights);
      EXPECT_EQ(kept.white, white) << lights;
      EXPECT_EQ(kept.err, "") << lights;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(White, RelitFilm, testing::Values(kObserver, kWideObserver, kNikon, kSpectral));

// A sensor that records radiances is corrected for the remaining light if its scene contains it.
TEST(RelitWhite, ASensorThatLooksAtLightsThatAreLeftIsCorrectedForThem) {
  const std::string film = film_of(lit_dome("s.json", kSpectral), "lit", "--layers lights");
  const Relit seen = relit(film, "--light dome=0 --scene " + lit_dome("n.json", kNikon));
  EXPECT_EQ(seen.white, "faint");
  EXPECT_LT(std::abs(seen.warmth), 0.005);
  EXPECT_EQ(seen.err, "");
}

// That scene with more lights, which precede its own.
std::string with_lights(const std::string& name, const std::string& path, const std::string& lights) {
  std::string text = read_file(path);
  text.insert(text.find('[', text.find("\"lights\"")) + 1, lights + ", ");
  return scratch().write(name, text).string();
}

TEST(RelitWhite, OfLightsThatShareALayerIsToldWhereTheyHaveOne) {
  const std::string path = lit_dome("rest.json", kObserver);
  EXPECT_EQ(relit(film_of(path, "rest", "--layers lights:faint"), "--light rest=0").white, "faint");
  const std::string three = with_lights("three.json", path,
                                        R"({"name": "other", "point": {"at": [0, 0, 1]},
    "emission": {"illuminant": "FL11", "luminous_intensity": 0.001}})");
  const Relit untold = relit(film_of(three, "three", "--layers lights:dome"), "--light dome=0");
  EXPECT_EQ(untold.white, "dome");
  const std::string told = "does not record the colour of \"rest\" (choose a white with --white)";
  EXPECT_NE(untold.err.find(told), std::string::npos) << untold.err;
}

// Two lamps of one colour are together brighter than a third lamp that is brighter than each.
TEST(RelitWhite, IsThatOfTheLightsThatTogetherGiveMost) {
  const std::string path = with_lights("group.json", lit_dome("group.json", kObserver),
                                       R"({"name": "other", "point": {"at": [0, 0, 1]},
    "emission": {"illuminant": "D65", "luminous_intensity": 0.0007}}, {"name": "third",
    "point": {"at": [0, 0, 1]}, "emission": {"illuminant": "FL11", "luminous_intensity": 0.0013}})");
  const std::string film = film_of(path, "group", "--layers lights");
  EXPECT_EQ(relit(film, "--light dome=0").white, "faint");
  EXPECT_EQ(relit(film, "--light dome=0 --light faint=0.3").white, "third");
}

}  // namespace
}  // namespace abbe::test
