// A ball of every material in light of radiance 1 from everywhere: white matter cannot be told from the
// light, and no other is brighter. Phong's is not either: it makes energy out of light that arrives at
// grazing angles, which a camera sees as too much light from lamps, not from all around.
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "description/load.h"
#include "tests/scenes/scene_fixture.h"

namespace abbe {
namespace {

enum class Returns { all, no_more };
struct WhiteMatter {
  const char* matter;
  Returns returns;
};
const std::multimap<std::string, WhiteMatter> kWhites{
    {"diffuse", {R"({"reflectance": 1})", Returns::all}},
    {"dielectric", {R"({"ior": "hikari/F2"})", Returns::all}},
    {"dielectric", {R"({"ior": 1.5, "roughness": 0.4})", Returns::all}},
    {"dielectric", {R"({"ior": 1.3, "scattering_per_m": 1})", Returns::all}},
    {"dielectric",
     {R"({"ior": "hikari/F2", "coating": [{"ior": 1.38, "thickness_nm": 99.6}]})", Returns::all}},
    {"conductor", {R"({"ior": 0})", Returns::all}},
    {"conductor", {R"({"ior": 0, "roughness": [0.2, 0.6]})", Returns::all}},
    {"conductor", {R"({"ior": "Ag_Johnson", "roughness": 0.3})", Returns::no_more}},
    {"film", {R"({"layers": [{"ior": 1.33, "thickness_nm": 400}]})", Returns::all}},
    {"medium", {R"({"scattering_per_m": 2, "phase": {"henyey_greenstein": 0.7}})", Returns::all}},
    {"coated_diffuse", {R"({"ior": 1.5, "reflectance": 1})", Returns::all}},
    {"thin_glass", {R"({"ior": 1.5})", Returns::all}},
    {"mirror", {R"({"reflectance": 1})", Returns::all}},
    {"schlick", {R"({"ior": "Al_Rakic"})", Returns::no_more}},
    {"oren_nayar", {R"({"reflectance": 1, "sigma_deg": 40})", Returns::all}},
    {"principled", {R"({"base_color": 1, "sheen": 1, "clearcoat": 1, "roughness": 0.3})", Returns::no_more}},
    {"principled", {R"({"base_color": 1, "metallic": 1, "roughness": 0.1})", Returns::no_more}},
    {"cosine_power", {R"({"reflectance": 1, "exponent": 2})", Returns::no_more}},
    {"cosine_power", {R"({"reflectance": 1, "exponent": 2, "reciprocal": true})", Returns::no_more}},
    {"phong", {R"({"reflectance": 1, "exponent": 20})", Returns::no_more}},
    {"retroreflector", {R"({"reflectance": 1, "exponent": 50})", Returns::no_more}},
    {"polariser", {R"({"extinction_ratio": 1})", Returns::all}},
    {"polariser", {R"({"angle_deg": 30})", Returns::no_more}},
    {"wave_plate", {R"({"retardance_deg": 90})", Returns::all}},
    {"depolariser", {R"({})", Returns::all}},
    {"mixture",
     {R"([{"material": "white", "weight": 0.4}, {"material": "silver", "weight": 0.6}])", Returns::all}}};

// Perhaps with another shape of the material "other".
Film film_of_ball(const std::string& matter, const std::string& other = R"("diffuse": {"reflectance": 1})",
                  const std::string& more = "") {
  return render(test::load_text(fmt::format(R"({{"abbe": 1,
    "camera": {{"pinhole": {{"fov_deg": 20}}, "from": [0, 0, -4], "to": [0, 0, 0], "up": [0, 1, 0]}},
    "sensor": {{"resolution": [8, 8], "response": "energy", "channels": {{"all": 1}}}},
    "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
    "materials": {{"ball": {{{}}}, "other": {{{}}}, "white": {{"diffuse": {{"reflectance": 1}}}}, "silver": {{"mirror": {{"reflectance": 1}}}}}},
    "shapes": [{{"sphere": {{"center": [0, 0, 0], "radius": 1}}, "material": "ball"}}{}],
    "render": {{"samples": 512, "max_depth": 200, "roulette_depth": -1, "integrator": "path"}}}})",
                                            matter, other, more)),
                {})
      .film;
}

TEST(Furnace, HasEveryMaterial) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_material("{}", diagnostics));
  const std::string words = diagnostics.text();
  const std::size_t first = words.find("allowed ");
  ASSERT_NE(first, std::string::npos) << words;
  std::string name;
  int known = 0;
  for (std::size_t i = first + 8; i < words.size() && words[i] != '\n'; ++i) {
    if (std::isalpha(static_cast<unsigned char>(words[i])) || words[i] == '_') {
      name += words[i];
      continue;
    }
    if (!name.empty()) {
      EXPECT_TRUE(kWhites.contains(name)) << name;
      ++known;
    }
    name.clear();
  }
  EXPECT_GE(known, 15) << words;
}

TEST(Furnace, NoMaterialIsBrighterThanTheLight) {
  const Film unit = film_of_ball(R"("dielectric": {"ior": 1})");
  const double one = test::region(unit, 0, 0, 0, 8, 8).mean;
  for (const auto& [key, white] : kWhites) {
    const test::Region seen =
        test::region(film_of_ball(fmt::format(R"("{}": {})", key, white.matter)), 0, 0, 0, 8, 8);
    const double ratio = seen.mean / one;
    const double noise = 4.9 * std::sqrt(seen.variance) / one;
    SCOPED_TRACE(fmt::format("{} {}: {} +- {}", key, white.matter, ratio, noise));
    EXPECT_LT(ratio, 1 + noise + 5e-3);
    EXPECT_GT(ratio, white.returns == Returns::all ? 1 - noise - 5e-3 : 0.2);
    EXPECT_LT(noise, 0.03);
  }
}

// Matter goes on behind films, which are a quad or a ball within it.
TEST(Furnace, FilmsLeaveTheMatterAroundThem) {
  constexpr const char* kFilm = R"("film": {"layers": [{"ior": 2, "thickness_nm": 90}]})";
  constexpr const char* kSheet =
      R"(, {"quad": {"corner": [-0.5, -0.5, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0.2]}, "material": "other"})";
  constexpr const char* kBall =
      R"(, {"sphere": {"center": [0, 0, 0.1], "radius": 0.6}, "material": "other"})";
  const auto mean = [](const Film& film) { return test::region(film, 0, 0, 0, 8, 8); };
  const double one = mean(film_of_ball(R"("dielectric": {"ior": 1})")).mean;
  constexpr const char* kFog = R"("medium": {"absorption_per_m": 1})";
  const double fog = mean(film_of_ball(kFog)).mean;
  for (const char* shape : {kSheet, kBall}) {
    const test::Region water = mean(film_of_ball(R"("dielectric": {"ior": 1.33})", kFilm, shape));
    EXPECT_NEAR(water.mean / one, 1, 4.9 * std::sqrt(water.variance) / one + 2e-3) << shape;
    const test::Region clear =
        mean(film_of_ball(kFog, R"("film": {"layers": [{"ior": 1, "thickness_nm": 90}]})", shape));
    EXPECT_NEAR(clear.mean / fog, 1, 4.9 * std::sqrt(clear.variance) / fog + 2e-3) << shape;
  }
}

// Fog that ends where a floor, or glass, begins; glass and fog in one place; ground glass within glass, where
// what it scatters more than once is lost.
TEST(Furnace, MatterMayTouchAndLieInMatter) {
  struct Pair {
    const char* ball;
    const char* other;
    const char* more;
    Returns returns;
  };
  constexpr const char* kFog = R"("medium": {"scattering_per_m": 2})";
  constexpr const char* kGlass = R"("dielectric": {"ior": 1.5})";
  constexpr const char* kSame = R"(, {"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "other"})";
  constexpr const char* kAround =
      R"(, {"sphere": {"center": [0, 0, 0], "radius": 1.3}, "material": "other"})";
  const Pair pairs[] = {
      {kFog, R"("diffuse": {"reflectance": 1})", kSame, Returns::all},
      {kFog, kGlass, kSame, Returns::all},
      {kGlass, kFog, kSame, Returns::all},
      {kGlass, kFog, kAround, Returns::all},
      {R"("dielectric": {"ior": 1.5, "roughness": 0.5})", kGlass, kAround, Returns::no_more},
      {R"("dielectric": {"ior": 1.5, "roughness": 1})", R"("dielectric": {"ior": 2.4})", kAround,
       Returns::no_more}};
  const double one = test::region(film_of_ball(R"("dielectric": {"ior": 1})"), 0, 0, 0, 8, 8).mean;
  for (const Pair& pair : pairs) {
    const test::Region seen = test::region(film_of_ball(pair.ball, pair.other, pair.more), 0, 0, 0, 8, 8);
    const double ratio = seen.mean / one;
    const double noise = 4.9 * std::sqrt(seen.variance) / one;
    SCOPED_TRACE(fmt::format("{} and {}: {} +- {}", pair.ball, pair.other, ratio, noise));
    EXPECT_LT(ratio, 1 + noise + 2e-3);
    EXPECT_GT(ratio, pair.returns == Returns::all ? 1 - noise - 2e-3 : 0.1);
    EXPECT_LT(noise, 0.1);
  }
}

// Lamps as bright as the sky they hide change nothing, whichever of them is chosen: light sampling and
// scattering balance at the place where the path scattered, on one side of a surface and from everywhere.
TEST(Furnace, LampsLikeTheSkyCannotBeTold) {
  constexpr const char* kBlack = R"("diffuse": {"reflectance": 0})";
  constexpr const char* kLamps = R"(,
    {"disc": {"center": [0, 1.5, 0], "normal": [0, -1, 0], "radius": 4}, "material": "other", "emission": {"spectrum": 1}},
    {"disc": {"center": [2, 0, 0.5], "normal": [-1, 0, 0], "radius": 0.8}, "material": "other", "emission": {"spectrum": 1}},
    {"sphere": {"center": [-2, -2, -1], "radius": 0.7}, "material": "other", "emission": {"spectrum": 1}})";
  const double one = test::region(film_of_ball(R"("dielectric": {"ior": 1})"), 0, 0, 0, 8, 8).mean;
  for (const char* matter :
       {R"("diffuse": {"reflectance": 1})", R"("conductor": {"ior": 0, "roughness": 0.5})",
        R"("dielectric": {"ior": 1.5, "roughness": 0.4})", R"("medium": {"scattering_per_m": 2})"}) {
    const test::Region seen = test::region(film_of_ball(matter, kBlack, kLamps), 0, 0, 0, 8, 8);
    const double noise = 4.9 * std::sqrt(seen.variance) / one;
    SCOPED_TRACE(fmt::format("{}: {} +- {}", matter, seen.mean / one, noise));
    EXPECT_NEAR(seen.mean / one, 1, noise + 2e-3);
    EXPECT_LT(noise, 0.02);
  }
}

}  // namespace
}  // namespace abbe
