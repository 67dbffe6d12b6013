// Light and things from afar: lamps up to the distance of the sun, parallel beams, and what they leave of
// what is near.
#include <cmath>

#include <fmt/format.h>

#include "materials/material.h"
#include "tests/angles.h"
#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/plan/plan.h"

namespace abbe {
namespace {

using Imath::V3d;

const V3d kTowards(0.48, 0.6, 0.64);
constexpr const char* kBand = R"("emission": {"spectrum": {"band": [500, 600]}, "irradiance": 1000)";

std::string numbers(const V3d& v) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z);
}

// Lamps of that size at a distance along `kTowards`, which irradiate a surface that faces them by 1000 W/m^2.
std::vector<std::string> lamps(double distance, double radius) {
  const V3d center = kTowards * distance;
  const V3d u = V3d(0, 0, 1).cross(kTowards).normalized() * radius;
  const V3d v = u.cross(kTowards);
  const std::string emission = fmt::format("{}, \"distance\": {:.17g}}}", kBand, distance);
  return {fmt::format(R"({{"sphere": {{"center": {}, "radius": {:.17g}}}, {}}})", numbers(center), radius,
                      emission),
          fmt::format(R"({{"disc": {{"center": {}, "normal": {}, "radius": {:.17g}}}, {}}})", numbers(center),
                      numbers(-kTowards), radius, emission),
          fmt::format(R"({{"quad": {{"corner": {}, "edge_u": {}, "edge_v": {}}}, {}}})",
                      numbers(center - u - v), numbers(u * 2), numbers(v * 2), emission)};
}
const std::string kBeam =
    fmt::format(R"({{"directional": {{"towards": {}}}, {}}}}})", numbers(kTowards), kBand);
const std::string kSun = fmt::format(R"({{"sun": {{"towards": {}}}, {}}}}})", numbers(kTowards), kBand);

// A white card seen squarely, and some light.
std::string card(const std::string& light, const std::string& more = "") {
  return fmt::format(R"({{"abbe": 1,
    "camera": {{"pinhole": {{"fov_deg": 20}}, "from": [0, 0, 3], "to": [0, 0, 0], "up": [0, 1, 0]}},
    "sensor": {{"resolution": [8, 8], "response": "energy", "channels": {{"all": {{"band": [500, 600]}}}}}},
    "materials": {{"white": {{"diffuse": {{"reflectance": 0.8}}}}, "air": {{"dielectric": {{"ior": 1}}}}, "glass": {{"dielectric": {{"ior": 1.5}}}}}},
    "shapes": [{{"quad": {{"corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}}, "material": "white"}}{}],
    "lights": [{}], "render": {{"samples": 64}}}})",
                     more, light);
}
double film_mean(const Scene& scene) {
  return test::whole(render(scene, {}).film).mean;
}
double film_mean(const std::string& text) {
  return film_mean(test::load_text(text));
}

// What light sampling says of a surface that faces the lamp, on a grid of strata; every sample is seen, and
// where the lamp looks larger than the steps of float directions, met and counted by the density of
// scattering too.
void expect_irradiance(const Scene& scene, bool met, const std::string& what) {
  const Imath::V3f point(-scene.origin_m);
  const Light& light = scene.lights[0];
  constexpr int kSide = 64;
  double sum = 0;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const auto s =
          sample_light(light, scene.shapes, {point},
                       {(static_cast<float>(i) + 0.5F) / kSide, (static_cast<float>(j) + 0.5F) / kSide}, 0);
      ASSERT_TRUE(s) << what;
      sum += static_cast<double>(s->factor) / static_cast<double>(s->pdf) * V3d(s->wi).dot(kTowards);
      ASSERT_FALSE(scene.occluded(point, s->end)) << what;
      const auto hit = scene.intersect({point, s->wi});
      if (!met || !hit) continue;  // a rim
      ASSERT_EQ(scene.shapes[hit->shape].light, 0) << what;
      ASSERT_NEAR(light_pdf(light, scene.shapes, {point}, s->wi, hit->point, hit->normal, 0) / s->pdf, 1,
                  1e-5)
          << what;
    }
  EXPECT_NEAR(sum / (kSide * kSide) * light.emission.curve().integral() / 1000, 1, 1e-5) << what;
}

TEST(Far, LampsIrradiateFromAnyDistance) {
  for (const double distance : {1.0, 1e3, 1e6, 1e8, 1.5e11})
    for (const double looks : {4.65e-3, 1e-5, 1 / distance}) {
      if (looks > 0.01) continue;
      for (const std::string& lamp : lamps(distance, looks * distance))
        expect_irradiance(test::load_text(card(lamp)), looks > 1e-3, lamp);
    }
}

TEST(Far, ACardUnderAFarLampIsAsBrightAsInAParallelBeam) {
  const double beam = film_mean(card(kBeam));
  // Through the lens: E rho cos / pi, as what a dome of that radiance would make of the card.
  const double dome = film_mean(
      card(R"({"environment": {}, "emission": {"spectrum": {"band": [500, 600]}, "radiance": 1}})"));
  EXPECT_NEAR(beam / dome / (1000 * kTowards.z / kPi), 1, 2e-3);
  EXPECT_NEAR(film_mean(card(kSun)) / beam, 1, 1e-4);
  for (const double distance : {1e6, 1e8, 1.5e11})
    for (const std::string& lamp : lamps(distance, 1e-5 * distance))
      EXPECT_NEAR(film_mean(card(lamp)) / beam, 1, 1e-5) << lamp;
}

// Things that lead step by step from near to far, none of them a thousand times further than the last, and
// none of them in the way.
TEST(Far, AChainOfThingsIntoTheDistanceChangesNothingNear) {
  std::string chain;
  for (const double distance : {900.0, 8e5, 7e8})
    chain += fmt::format(R"(, {{"sphere": {{"center": {}, "radius": {}}}, "material": "white"}})",
                         numbers(V3d(distance, 0, -0.2 * distance)), 0.1 * distance);
  EXPECT_NEAR(film_mean(card(kBeam, chain)) / film_mean(card(kBeam)), 1, 2e-4);
}

TEST(Far, ASunIsADiscOfItsRadiance) {
  const auto seen = [](const std::string& light, const char* to) {
    return film_mean(test::load_text(fmt::format(
        R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 0.1}}, "from": [0, 0, 0], "to": {}, "up": [0, 1, 0]}},
      "sensor": {{"resolution": [2, 2], "channels": {{"all": {{"band": [500, 600]}}}}}}, "lights": [{}], "render": {{"samples": 16}}}})",
        to, light)));
  };
  const double dome = seen(
      R"({"environment": {}, "emission": {"spectrum": {"band": [500, 600]}, "radiance": 1}})", "[0, 0, 1]");
  const double sine = std::sin(0.533 / 2 * kPi / 180);
  EXPECT_NEAR(seen(kSun, "[0.48, 0.6, 0.64]") / dome / (1000 / (kPi * sine * sine)), 1, 1e-5);
  EXPECT_EQ(seen(kSun, "[0.48, 0.6, 0.65]"), 0) << "beside it";
  EXPECT_EQ(seen(kBeam, "[0.48, 0.6, 0.64]"), 0) << "a beam is not seen";
}

// Photons are aimed at a pane that does not show, and must bring what light sampling finds without it: from
// lamps near and far, and from infinity.
TEST(Far, PhotonsOfEveryLightBringAllOfIt) {
  const std::string pane =
      R"(, {"quad": {"corner": [-6, -6, 1.5], "edge_u": [13, 0, 0], "edge_v": [0, 13, 0]}, "material": "air"})";
  // From below the pane.
  const Override from{"/camera/from", "[0, -2.5, 1]"};
  std::vector<std::string> lights = lamps(1e8, 4.65e5);
  if (!test::nightly()) lights.resize(1);  // by day of one shape
  lights.push_back(kBeam);
  lights.push_back(kSun);
  lights.push_back(
      R"({"sun": {"towards": [0.1, 0.2, 1], "angular_diameter_deg": 14}, "emission": {"spectrum": {"band": [500, 600]}, "irradiance": 1000}})");
  lights.push_back(
      R"({"point": {"at": [2e6, 0, 3e6]}, "emission": {"spectrum": {"band": [500, 600]}, "intensity": 1e15}})");
  lights.push_back(
      R"({"spot": {"at": [2e6, 0, 3e6], "direction": [-2, 0, -3], "half_angle_deg": 1}, "emission": {"spectrum": {"band": [500, 600]}, "intensity": 1e15}})");
  const unsigned samples = test::nightly() ? 1024 : 128;
  for (const std::string& light : lights) {
    const Scene with =
        test::load_text(card(light, pane), {from, {"/render/samples", std::to_string(samples)}});
    const RenderResult traced = render(with, {});
    ASSERT_GT(traced.stats.paths, samples * 64U) << "photons were traced";
    const test::Region all = test::whole(traced.film);
    const test::Region sampled = test::whole(render(test::load_text(card(light), {from}), {}).film);
    EXPECT_NEAR(all.mean / sampled.mean, 1, test::ratio_margin(all, sampled, 3e-3, 0.1)) << light;
  }
}

// A ball of glass throws a caustic on the card: by chance, and by photons.
TEST(Far, CausticsOfASunAgree) {
  const int samples = test::nightly() ? 4096 : 40;  // with photons; four times as many by chance
  const std::string ball = R"(, {"sphere": {"center": [0, 0, 0.6], "radius": 0.4}, "material": "glass"})";
  const auto caustic = [&](const std::string& light, const char* integrator, int samples) {
    Scene scene = test::load_text(card(light, ball), {{"/render/integrator", integrator},
                                                      {"/sensor/resolution", "[32, 32]"},
                                                      {"/render/samples", std::to_string(samples)}});
    scene.features.light_tracing = true;
    scene.features.light_is_traced.assign(1, true);
    return render(scene, {}).film;
  };
  for (
      const std::string& light :
      {std::string(
           R"({"sun": {"towards": [0.3, 0.2, 1], "angular_diameter_deg": 40}, "emission": {"spectrum": {"band": [500, 600]}, "irradiance": 1}})"),
       std::string(
           R"({"sphere": {"center": [3e7, 2e7, 1e8], "radius": 3e7}, "emission": {"spectrum": {"band": [500, 600]}, "radiance": 1}})")}) {
    const Film by_chance = caustic(light, "path", 4 * samples);
    const Film by_photons = caustic(light, "auto", samples);
    const test::Comparison c = test::compare_regions(by_chance, by_photons, 4);
    std::printf("largest z %.2f, ratio of the means %.5f\n", c.largest_z, c.ratio);
    EXPECT_LT(c.largest_z, 5.6) << light;
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(by_chance, by_photons, 0.003, 0.08)) << light;
  }
}

std::string refused(const Scene& scene) {
  const std::optional<Error> refused = refusal(scene);
  return refused ? refused->what() : "";
}

// Light sampling passes a cloud on the way to the sun, and takes off what it takes off; photons start below.
TEST(Far, PhotonsThatWouldPassACloudAreRefused) {
  const std::string ball_and_cloud =
      R"(, {"sphere": {"center": [0, 0, 0.6], "radius": 0.4}, "material": "glass"}, {"sphere": {"center": [4800, 6000, 6400], "radius": 500}, "name": "cloud", "material": "air"})";
  const Override thin{"/materials/air", R"({"medium": {"absorption_per_m": 0.003}})"};
  const Override dense{"/materials/air", R"({"diffuse": {"reflectance": 0.8}})"};
  EXPECT_NE(refused(test::load_text(card(kSun, ball_and_cloud), {thin})).find("cloud"), std::string::npos);
  EXPECT_EQ(refused(test::load_text(card(kSun, ball_and_cloud), {dense})), "")
      << "what hides the sun is no cloud";
}

// Lamps that look large from afar: photons must come from as far aside as light sampling does, or not at all.
TEST(Far, PhotonsAloneBringAllOfALargeLamp) {
  // The card is not in the middle, so that what comes from aside crosses the target far out.
  const auto lit = [](double half_width, const char* integrator, const char* samples) {
    const std::string lamp = fmt::format(
        R"({{"quad": {{"corner": [-{0}, -{0}, 1e5], "edge_u": [0, {1}, 0], "edge_v": [{1}, 0, 0]}}, "emission": {{"spectrum": {{"band": [500, 600]}}, "radiance": 1}}}})",
        half_width, 2 * half_width);
    const std::string below = R"(, {"sphere": {"center": [0, 0, -6], "radius": 0.5}, "material": "white"})";
    return test::load_text(card(lamp, below), {{"/render/integrator", integrator},
                                               {"/render/samples", samples},
                                               {"/camera/pinhole/fov_deg", "36"}});
  };
  const char* samples = test::nightly() ? "65536" : "16384";
  const test::Region photons = test::whole(render(lit(3e5, "light", samples), {}).film);
  const test::Region paths = test::whole(render(lit(3e5, "path", "256"), {}).film);
  EXPECT_NEAR(photons.mean / paths.mean, 1, test::ratio_margin(photons, paths, 0.05, 0.2));
  EXPECT_NE(refused(lit(2e6, "light", "1")).find("within 84 degrees of one direction"), std::string::npos);
  EXPECT_EQ(refused(lit(2e6, "path", "1")), "");
}

// Radius on the screen of `rainbow.json` [mm] where the bow of rays with one inner reflection ends: rays turn
// around the middle of the drop, entering at the angle of incidence i and leaving after two chords of pi - 2
// r each.
double bow_edge(double n) {
  constexpr double kDrop = 10;
  constexpr double kScreen = 200;
  double largest = 0;
  for (int step = 1; step < 100000; ++step) {
    const double i = std::asin(step / 100000.0);
    const double r = std::asin(step / 100000.0 / n);
    const double back = 4 * r - 2 * i;  // from the way back
    const double leaves = 4 * r - i;    // where, about the middle, from the way it came
    largest =
        std::max(largest, kDrop * std::sin(leaves) + (kScreen - kDrop * std::cos(leaves)) * std::tan(back));
  }
  return largest;
}

TEST(Far, ADropInAParallelBeamThrowsTheBowWhereDescartesPutsIt) {
  for (const double nm : test::nightly() ? std::vector{400.0, 550.0, 700.0} : std::vector{550.0}) {
    const Scene scene = test::load(
        "rainbow.json",
        {{"/lights/0",
          fmt::format(
              R"({{"directional": {{"towards": [0, 0, 1]}}, "emission": {{"lines": [{{"nm": {}, "width_nm": 0.1, "power": 1}}], "irradiance": 1}}}})",
              nm)},
         {"/camera/pinhole/fov_deg", "90"},
         {"/sensor", R"({"resolution": [201, 201], "channels": {"all": 1}})"},
         {"/render/samples", test::nightly() ? "24" : "6"}});
    const Film film = render(scene, {}).film;
    // Millimetres of the screen per pixel, and the mean over rings of 1 mm around the middle of the drop.
    const double scale = 400 / 201.0;
    std::vector<double> sum(300);
    std::vector<double> count(300);
    for (int y = 0; y < 201; ++y)
      for (int x = 0; x < 201; ++x) {
        const auto ring = static_cast<std::size_t>(std::hypot((x - 100) * scale, (100 - y) * scale - 30) / 2);
        sum.at(ring) += film.mean(static_cast<std::size_t>(y * 201 + x), 0);
        ++count.at(ring);
      }
    std::size_t brightest = 40;
    for (std::size_t ring = 40; ring < 100; ++ring)
      if (sum[ring] / count[ring] > sum[brightest] / count[brightest]) brightest = ring;
    const double n = interior_index(scene.materials[scene.shapes[0].material])->n(nm);
    const double edge = bow_edge(n);
    EXPECT_NEAR(2 * static_cast<double>(brightest) + 1, edge, 2.5) << nm;
    const auto ring_beyond = static_cast<std::size_t>(edge / 2) + 4;
    EXPECT_LT(sum[ring_beyond] / count[ring_beyond], 0.05 * sum[brightest] / count[brightest])
        << "Alexander's band";
  }
}

}  // namespace
}  // namespace abbe
