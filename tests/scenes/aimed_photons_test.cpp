// Where pilots aim photons: at what lets light through to the film.
#include <algorithm>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "results/scene_warnings.h"
#include "tests/scenes/scene_fixture.h"
#include "transport/render/trained_plan.h"
#include "transport/technique/light.h"

namespace abbe {
namespace {

// Of the photons of a plan, the share that adds to the film.
double share_landed(const Plan& plan) {
  constexpr std::uint32_t kPhotons = 1 << 15;
  RayCaster caster(plan.scene);
  LightTracer tracer(plan, caster, 1);
  std::vector<Sampler> photons;
  for (std::uint32_t i = 0; i < kPhotons; ++i) photons.emplace_back(5, Purpose::light, 0, 0, i);
  std::vector<bool> landed(kPhotons);
  tracer.trace(photons, [&](std::uint32_t photon, const FilmPoint&, std::span<const double>) {
    landed[photon] = true;
  });
  return static_cast<double>(std::count(landed.begin(), landed.end(), true)) / kPhotons;
}

// What prism faces reflect, and what is drawn anywhere, never comes there.
TEST(AimedPhotons, MostComeThroughASlit) {
  for (const auto& [name, least] : {std::pair("prism_area.json", 0.5), std::pair("sunlit_prism.json", 0.5)}) {
    const Scene scene = test::load(name, {});
    const double share = share_landed(make_trained_plan(scene, 2));
    std::printf("%s: %.3f of the photons\n", name, share);
    EXPECT_GT(share, least) << name;
  }
}

// A white floor that so many lamps light through a pane, of which a camera below the pane sees that much.
Scene floor_below_pane(double fov_deg, int count = 1) {
  std::string lamps = R"({"point": {"at": [0, 0, 4]}, "emission": {"illuminant": "E", "intensity": 1}})";
  for (const std::string lamp = lamps; count > 1; --count) lamps += ", " + lamp;
  return test::load_text(R"({"abbe": 1, "sensor": {"resolution": [4, 4], "observer": "1931"},
    "camera": {"pinhole": {"fov_deg": )" +
                         std::to_string(fov_deg) +
                         R"(}, "from": [0.2, 0.1, 0.9], "to": [0.2, 0.1, 0], "up": [0, 1, 0]},
    "materials": {"pane": {"thin_glass": {"ior": 1.5}}, "white": {"diffuse": {"reflectance": 1}}},
    "shapes": [{"quad": {"corner": [-1, -1, 1], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}, "material": "pane"},
               {"quad": {"corner": [-2, -2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]}, "material": "white"}],
    "lights": [)" + lamps +
                         "]}");
}

// Of the first pilots some come to a view of 4 degrees, about one to one of 1 degree: the others of that are
// aimed around where these have gone, but for half of them, which go anywhere.
TEST(AimedPhotons, AreAimedForCertainByNoFewOthers) {
  const Scene narrow = floor_below_pane(4);
  const Plan learnt = make_trained_plan(narrow, 2);
  EXPECT_FALSE(learnt.guides.undertrained);
  EXPECT_GT(share_landed(learnt), 0.3);
  const Scene narrowest = floor_below_pane(1);
  const Plan guessed = make_trained_plan(narrowest, 2);
  EXPECT_TRUE(guessed.guides.undertrained);
  const double share = share_landed(guessed);
  EXPECT_GT(share, 1e-3);
  EXPECT_LT(share, 0.5);
}

// What each of many lamps is shown by too few photons to aim its others by, all are by many together, but
// for those that none shows where most are shown by one.
TEST(AimedPhotons, AreNotRareWhereManyLampsAreShownByFewEach) {
  EXPECT_FALSE(make_trained_plan(floor_below_pane(8, 64), 2).guides.undertrained);
  EXPECT_TRUE(make_trained_plan(floor_below_pane(3, 128), 2).guides.undertrained);
  EXPECT_TRUE(make_trained_plan(floor_below_pane(0.5, 4), 2).guides.undertrained);
}

// A mirror of this width [m] that sends some of the light of one lamp into the view of 4 degrees. Beside it
// there are tiny mirrors that send no light there.
Scene floor_below_pane_and_mirror(double fov_deg, double width, int tiny_mirrors) {
  std::string others;
  for (int i = 0; i < tiny_mirrors; ++i)
    others += fmt::format(
        R"(, {{"quad": {{"corner": [-0.9, {}, 0.5], "edge_u": [1e-4, 0, 0], "edge_v": [0, 1e-4, 0]}}, "material": "mirror"}})",
        0.01 * i);
  return test::load_text(fmt::format(R"({{"abbe": 1, "sensor": {{"resolution": [4, 4], "observer": "1931"}},
    "camera": {{"pinhole": {{"fov_deg": {4}}}, "from": [0.2, 0.1, 0.9], "to": [0.2, 0.1, 0], "up": [0, 1, 0]}},
    "materials": {{"pane": {{"thin_glass": {{"ior": 1.5}}}}, "white": {{"diffuse": {{"reflectance": 1}}}},
                  "mirror": {{"mirror": {{"reflectance": 1}}}}}},
    "shapes": [{{"quad": {{"corner": [-1, -1, 1], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}}, "material": "pane"}},
               {{"quad": {{"corner": [-2, -2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]}}, "material": "white"}},
               {{"quad": {{"corner": [0.5, 0.1, 0.3], "edge_u": [0, {0}, {1}], "edge_v": [{2}, 0, {3}]}}, "material": "mirror"}}{5}],
    "lights": [{{"point": {{"at": [0, 0, 4]}}, "emission": {{"illuminant": "E", "intensity": 1}}}}]}})",
                                     width, 0.094 * width, 0.32 * width, 0.947 * width, fov_deg, others));
}

// A mirror of 5 mm brings about 1 % of the light. Few pilot photons find it among very many mirrors. If there
// are few, it gets an equal part of the photons. A mirror of 3 cm is found by many.
TEST(AimedPhotons, TellHowMuchLightFewPilotsFound) {
  const Scene few = floor_below_pane_and_mirror(2, 0.005, 64);
  EXPECT_NEAR(make_trained_plan(few, 2).guides.undertrained_fraction, 0.01, 0.007);
  const Scene stratified = floor_below_pane_and_mirror(2, 0.005, 0);
  EXPECT_EQ(make_trained_plan(stratified, 2).guides.undertrained_fraction, 0);
  const Scene many = floor_below_pane_and_mirror(2, 0.03, 64);
  EXPECT_EQ(make_trained_plan(many, 2).guides.undertrained_fraction, 0);
}

TEST(AimedPhotons, AreReportedIfFewTrainedTheGuide) {
  GuidingData guides{.photon_guides = {},
                     .photon_wavelengths = {std::span<const Curve>(), std::span<const Curve>()}};
  EXPECT_EQ(undertrained_warning(nullptr), std::nullopt);
  EXPECT_EQ(undertrained_warning(&guides), std::nullopt);
  guides.undertrained_fraction = 0.009;
  EXPECT_EQ(undertrained_warning(&guides), std::nullopt);
  guides.undertrained_fraction = 0.031;
  EXPECT_EQ(
      undertrained_warning(&guides).value_or(""),
      "3.1 % of the light that pilot photons found takes paths that fewer than 50 of them took: that light "
      "is noisy, and its error is uncertain");
  guides.undertrained = true;
  EXPECT_EQ(undertrained_warning(&guides).value_or(""),
            "too few pilot photons contribute to the film to guide others: light that arrives through "
            "mirrors and glass "
            "is noisy, and its error is uncertain");
}

}  // namespace
}  // namespace abbe
