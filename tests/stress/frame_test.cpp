// The same scene elsewhere, in another size, of thin triangles, or of surfaces twice at one place.
#include <cmath>

#include <fmt/format.h>

#include "tests/scenes/film_of_plan.h"
#include "tests/scenes/scene_fixture.h"

namespace abbe {
namespace {

// A ball of glass and one of rough metal on a card, under a lamp: lengths times `scale`, all of it moved by
// `away`.
Scene still_life(double scale, double away) {
  const auto at = [=](double x, double y, double z) {
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", scale * x + away, scale * y + away, scale * z + away);
  };
  const auto along = [=](double x, double y, double z) {
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", scale * x, scale * y, scale * z);
  };
  return test::load_text(fmt::format(
      R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 40}}, "from": {}, "to": {}, "up": [0, 0, 1]}},
      "sensor": {{"resolution": [32, 32], "observer": "1931"}},
      "materials": {{"card": {{"diffuse": {{"reflectance": "cornell_box_walls:red"}}}}, "glass": {{"dielectric": {{"ior": 1.5}}}},
                     "metal": {{"conductor": {{"ior": "Au_Johnson", "roughness": 0.3}}}}}},
      "lights": [{{"sphere": {{"center": {}, "radius": {:.17g}}}, "emission": {{"spectrum": 1}}}},
                 {{"environment": {{}}, "emission": {{"spectrum": 0.01}}}}],
      "shapes": [{{"quad": {{"corner": {}, "edge_u": {}, "edge_v": {}}}, "material": "card"}},
                 {{"sphere": {{"center": {}, "radius": {:.17g}}}, "material": "glass"}},
                 {{"sphere": {{"center": {}, "radius": {:.17g}}}, "material": "metal"}}],
      "render": {{"samples": 16, "integrator": "path"}}}})",
      at(0, -4, 2), at(0, 0, 0.5), at(1, -1, 4), 0.7 * scale, at(-3, -3, 0), along(6, 0, 0), along(0, 6, 0),
      at(-0.7, 0, 0.6), 0.6 * scale, at(0.7, 0, 0.6), 0.6 * scale));
}

// Of all values, relative to their mean square.
double rel_mse(const Film& film, const Film& reference) {
  double apart = 0;
  double square = 0;
  for (std::size_t pixel = 0; pixel < static_cast<std::size_t>(film.width() * film.height()); ++pixel)
    for (int channel = 0; channel < film.channels(); ++channel) {
      apart += std::pow(film.mean(pixel, channel) - reference.mean(pixel, channel), 2);
      square += std::pow(reference.mean(pixel, channel), 2);
    }
  return apart / square;
}

// Stress 20.
TEST(Stress, ASceneFarFromTheOriginIsTheSame) {
  const Film here = render(still_life(1, 0), {}).film;
  for (const double away : {1e3, 1e5})
    EXPECT_LT(rel_mse(render(still_life(1, away), {}).film, here), 1e-4) << away;
}

// Stress 21.
TEST(Stress, ASceneOfAnySizeIsTheSame) {
  const Film here = render(still_life(1, 0), {}).film;
  for (const double scale : {1e-3, 1e3, 1e6})
    EXPECT_LT(rel_mse(render(still_life(scale, 0), {}).film, here), 1e-4) << scale;
  // In a scene of some micrometres rays start an atom's size off surfaces, 1e-4 of a ball. That moves photons
  // which show where caustics are to other cells, so the same paths are those of plans without.
  const auto untaught = [](const Scene& scene) { return test::film_of(scene, make_plan(scene), 16); };
  EXPECT_LT(rel_mse(untaught(still_life(1e-6, 0)), untaught(still_life(1, 0))), 1e-4);
}

// Stress 22: a card of triangles a million times longer than wide is as bright as one of two triangles.
TEST(Stress, SliversAreAsBrightAsTheirSurface) {
  std::string vertices;
  std::string triangles;
  constexpr int kStrips = 400;
  const auto edge = [](int i) {
    return i < kStrips / 2 ? -1 + 2e-6 * i : -1 + 1e-3 + (i - kStrips / 2) * 1.999 / (kStrips / 2);
  };
  for (int i = 0; i <= kStrips; ++i)
    vertices += fmt::format("{}[{:.17g}, -1, 0], [{:.17g}, 1, 0]", i > 0 ? ", " : "", edge(i), edge(i));
  for (int i = 0; i < kStrips; ++i)
    triangles += fmt::format("{}[{}, {}, {}], [{}, {}, {}]", i > 0 ? ", " : "", 2 * i, 2 * i + 2, 2 * i + 1,
                             2 * i + 1, 2 * i + 2, 2 * i + 3);
  const auto film = [](const std::string& card) {
    RenderResult result = render(
        test::load_text(fmt::format(
            R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 30}}, "from": [0, -1, 4], "to": [0, 0, 0], "up": [0, 1, 0]}},
        "sensor": {{"resolution": [32, 32], "channels": {{"all": 1}}}},
        "materials": {{"card": {{"oren_nayar": {{"reflectance": 0.8, "sigma_deg": 20}}}}}},
        "lights": [{{"sphere": {{"center": [2, 0, 2], "radius": 0.5}}, "emission": {{"spectrum": 1}}}}, {{"environment": {{}}, "emission": {{"spectrum": 0.1}}}}],
        "shapes": [{{{}, "material": "card"}}], "render": {{"samples": 16}}}})",
            card)),
        {});
    EXPECT_EQ(result.stats.nonfinite_samples, 0U);
    return std::move(result.film);
  };
  const Film plain = film(R"("quad": {"corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]})");
  const Film slivers =
      film(fmt::format(R"("mesh": {{"vertices": [{}], "triangles": [{}]}})", vertices, triangles));
  EXPECT_LT(rel_mse(slivers, plain), 1e-6);
}

// Stress 23: which of two surfaces at one place is met is nobody's choice, but always the same one's.
TEST(Stress, CoplanarDuplicatesAreDeterministic) {
  Scene scene = test::load_text(R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 40}, "from": [0.3, -0.2, 4], "to": [0, 0, 0], "up": [0, 1, 0]},
    "sensor": {"resolution": [40, 40], "observer": "1931"},
    "materials": {"red": {"diffuse": {"reflectance": "cornell_box_walls:red"}}, "green": {"diffuse": {"reflectance": "cornell_box_walls:green"}},
                  "glass": {"dielectric": {"ior": 1.5}}, "water": {"dielectric": {"ior": "water"}, "priority": 1}},
    "lights": [{"environment": {}, "emission": {"spectrum": 1}}],
    "shapes": [{"quad": {"corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}, "material": "red"},
               {"quad": {"corner": [-1, -1, 0], "edge_u": [0, 2, 0], "edge_v": [2, 0, 0]}, "material": "green"},
               {"mesh": {"vertices": [[-1, -1, 0], [1, -1, 0], [1, 1, 0]], "triangles": [[0, 1, 2], [0, 1, 2], [1, 2, 0]]}, "material": "red"},
               {"sphere": {"center": [0, 0, 1], "radius": 0.5}, "material": "glass"}, {"sphere": {"center": [0, 0, 1], "radius": 0.5}, "material": "water"}],
    "render": {"samples": 8}})");
  const auto bytes = [&scene](int threads, std::optional<Crop> crop) {
    RenderOptions options;
    options.threads = threads;
    options.crop = crop;
    return std::string(render(scene, options).film.bytes());
  };
  const std::string once = bytes(1, {});
  for (const int threads : {2, 5}) EXPECT_EQ(bytes(threads, {}), once);
  EXPECT_EQ(bytes(1, Crop{0, 0, 40, 40}), once);
}

}  // namespace
}  // namespace abbe
