// However path tracing draws directions, and however it combines both ways to a light, it finds the same.
#include <array>
#include <cmath>
#include <ostream>

#include <fmt/format.h>

#include "results/rendered_film.h"
#include "tests/scenes/film_of_plan.h"
#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/trained_plan.h"
#include "transport/technique/path.h"
#include "validation/statistics.h"

namespace abbe {
namespace {

// Family significance 1e-6 over 3 channels x 4 regions x 60 films: z = 6 by Sidak's correction.
constexpr double kLargestZ = 6;

struct Sampling {
  const char* directions;
  const char* lights;
  const char* heuristic;
};
void PrintTo(const Sampling& sampling, std::ostream* out) {
  *out << sampling.directions << ' ' << sampling.lights << ' ' << sampling.heuristic;
}

// By day: so many samples for one of the night.
const int kFewer = test::nightly() ? 1 : 8;

const std::vector<Sampling> kSamplings = [] {
  std::vector<Sampling> all;
  for (const char* directions : {"bsdf", "cosine", "uniform"}) {
    for (const char* lights : {"mis", "bsdf", "light"}) all.push_back({directions, lights, "balance"});
    all.push_back({directions, "mis", "power"});
  }
  return all;
}();

std::vector<Override> with(const Sampling& sampling, int samples) {
  const auto quoted = [](const char* word) { return fmt::format("\"{}\"", word); };
  return {{"/render/integrator", "\"path\""},
          {"/render/directions", quoted(sampling.directions)},
          {"/render/lights", quoted(sampling.lights)},
          {"/render/heuristic", quoted(sampling.heuristic)},
          {"/render/samples", fmt::format("{}", samples)}};
}

constexpr const char* kLamps =
    R"({"quad": {"corner": [-1.5, -1.5, 3], "edge_u": [0, 3, 0], "edge_v": [3, 0, 0]}, "emission": {"illuminant": "D65", "luminance": 100}},
         {"sphere": {"center": [-2, 1.5, 1], "radius": 0.9}, "emission": {"illuminant": "A", "luminance": 200}})";

constexpr const char* kBands =
    R"({"B": {"band": [400, 500]}, "G": {"band": [500, 600]}, "R": {"band": [600, 700]}})";

struct Place {
  const char* name;
  const char* materials;
  const char* things;  ///< Shapes, each after a comma.
  const char* lights = kLamps;
  const char* channels = kBands;
  double margin = 0.02;  ///< Of the means, relative.
  std::size_t step = 1;  ///< By day one of so many samplings, where tables of coats take long.
};

void PrintTo(const Place& place, std::ostream* out) {
  *out << place.name;
}

// Something on a grey floor, by default under a wide lamp and beside another.
std::string text_of(const Place& place) {
  return fmt::format(R"({{"abbe": 1,
    "camera": {{"pinhole": {{"fov_deg": 30}}, "from": [0, -5, 2.5], "to": [0, 0, 0.3], "up": [0, 0, 1]}},
    "sensor": {{"resolution": [12, 12], "channels": {}}},
    "materials": {{"grey": {{"diffuse": {{"reflectance": 0.5}}}}, {}}},
    "lights": [{}],
    "shapes": [{{"quad": {{"corner": [-3, -3, 0], "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}}, "material": "grey"}}{}],
    "render": {{"max_depth": 4}}}})",
                     place.channels, place.materials, place.lights, place.things);
}

// A plate that leans, so that light comes at an angle.
constexpr const char* kPlate =
    R"(, {"quad": {"corner": [-1, -0.6, 0.3], "edge_u": [2, 0, 0], "edge_v": [0, 1.2, 0.7]}, "material": "plate"})";
constexpr const char* kBall =
    R"(, {"sphere": {"center": [0.1, 0, 0.71], "radius": 0.7}, "material": "ball"})";
const std::vector<Place> kPlaces{
    {"Glossy", R"("plate": {"conductor": {"ior": "Cu_Johnson", "roughness": 0.35}})", kPlate},
    // The chance to mirror is another for each wavelength.
    {"Mixed", R"("silver": {"mirror": {"reflectance": 0.9}}, "red": {"diffuse": {"reflectance": 0.6}},
        "glaze": {"coated_diffuse": {"ior": "F2", "reflectance": "cornell_box_walls:red"}},
        "pane": {"thin_glass": {"ior": 1.8}},
        "plate": {"mixture": [{"material": "silver", "weight": {"band": [550, 700], "value": 0.5}}, {"material": "glaze", "weight": 0.2},
                              {"material": "red", "weight": 0.2}, {"material": "pane", "weight": 0.1}]},
        "ball": {"coated_diffuse": {"ior": "F2", "reflectance": 0.7}})",
     R"(, {"quad": {"corner": [-1.2, -0.6, 0.3], "edge_u": [1.2, 0, 0], "edge_v": [0, 1.2, 0.7]}, "material": "plate"},
        {"sphere": {"center": [0.7, 0, 0.51], "radius": 0.5}, "material": "ball"})",
     kLamps, kBands, 0.02, 3},
    // Very rough, and in light from everywhere: the weights of even directions within glass have a heavy
    // tail.
    {"RoughGlass", R"("ball": {"dielectric": {"ior": "F2", "roughness": 0.9}})", kBall,
     R"({"environment": {}, "emission": {"illuminant": "D65", "radiance": 1}})"},
    {"Fog",
     R"("fog": {"medium": {"scattering_per_m": {"table": {"wavelength_nm": [400, 700], "values": [0.2, 0.05], "outside": "clamp"}},
                           "absorption_per_m": 0.02, "phase": {"henyey_greenstein": 0.4}}},
        "ball": {"medium": {"scattering_per_m": {"table": {"wavelength_nm": [400, 700], "values": [1, 4], "outside": "clamp"}}, "phase": "rayleigh"}})",
     R"(, {"sphere": {"center": [0.1, 0, 0.71], "radius": 0.7}, "material": "ball"},
        {"sphere": {"center": [0, 0, 0], "radius": 9}, "material": "fog"})"},
    // What polarised light the plate sends depends on where it comes from.
    {"Polarised", R"("plate": {"conductor": {"ior": "Cr_Johnson", "roughness": 0.3}})", kPlate, kLamps,
     R"({"along": {"filters": [{"band": [500, 600]}], "polariser": {"angle_deg": 0}}, "across": {"filters": [{"band": [500, 600]}], "polariser": {"angle_deg": 90}}})"}};

class PathSamplings : public testing::TestWithParam<Place> {};

TEST_P(PathSamplings, FindTheSame) {
  const std::string text = text_of(GetParam());
  const Film usual = render(test::load_text(text, with(kSamplings[0], 2048 / kFewer)), {}).film;
  const std::size_t step = test::nightly() ? 1 : GetParam().step;
  for (std::size_t i = 1; i < kSamplings.size(); i += step) {
    const RenderResult other = render(test::load_text(text, with(kSamplings[i], 1024 / kFewer)), {});
    EXPECT_EQ(other.stats.nonfinite_samples, 0U);
    const test::Comparison c = test::compare_regions(usual, other.film, 2);
    EXPECT_LT(c.largest_z, kLargestZ) << testing::PrintToString(kSamplings[i]);
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(usual, other.film, GetParam().margin, 0.2))
        << testing::PrintToString(kSamplings[i]);
  }
}

INSTANTIATE_TEST_SUITE_P(Places, PathSamplings, testing::ValuesIn(kPlaces),
                         [](const auto& info) { return std::string(info.param.name); });

// Lamps at points can only be connected to: in fog by two ways, along the ray and from where it scatters.
TEST(PathSampling, LampsAtPointsAreConnectedTo) {
  Place place = kPlaces[3];
  place.lights =
      R"({"point": {"at": [0.9, -0.6, 1.6]}, "emission": {"illuminant": "A", "luminous_intensity": 60}})";
  const std::string text = text_of(place);
  const Film usual = render(test::load_text(text, with(kSamplings[0], 2048 / kFewer)), {}).film;
  for (const Sampling& sampling :
       {Sampling{"bsdf", "light", "balance"}, Sampling{"uniform", "mis", "power"}}) {
    const Film other = render(test::load_text(text, with(sampling, 1024 / kFewer)), {}).film;
    const test::Comparison c = test::compare_regions(usual, other, 2);
    EXPECT_LT(c.largest_z, kLargestZ) << testing::PrintToString(sampling);
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(usual, other, place.margin, 0.2))
        << testing::PrintToString(sampling);
  }
}

// Where nothing is lit but by such a lamp, scattering alone finds nothing.
TEST(PathSampling, ScatteringAloneMeetsNoLampAtAPoint) {
  const Scene scene = test::load_text(R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 30}, "from": [0, -5, 2.5], "to": [0, 0, 0.3], "up": [0, 0, 1]},
    "sensor": {"resolution": [4, 4], "observer": "1931"},
    "materials": {"fog": {"medium": {"scattering_per_m": 0.2}}, "grey": {"diffuse": {"reflectance": 0.5}}},
    "lights": [{"point": {"at": [0.9, -0.6, 1.6]}, "emission": {"illuminant": "A", "luminous_intensity": 60}}],
    "shapes": [{"quad": {"corner": [-3, -3, 0], "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}, "material": "grey"},
               {"sphere": {"center": [0, 0, 0], "radius": 9}, "material": "fog"}]})",
                                      with({"bsdf", "bsdf", "balance"}, 16));
  const Film film = render(scene, {}).film;
  EXPECT_EQ(test::region(film, 1, 0, 0, 4, 4).mean, 0);
}

// Inside a closed sphere that emits 1 - a of what it would send were it black, and reflects a, every ray
// carries as much as in that black one.
TEST(PathSampling, FurnacesAreEven) {
  const Film black = render(test::load("furnace.json", {{"/shapes/0/emission/spectrum", "1"},
                                                        {"/materials/wall/diffuse/reflectance", "0"}}),
                            {})
                         .film;
  const double expected = test::region(black, 1, 0, 0, 16, 16).mean;
  for (const Sampling& sampling : kSamplings) {
    std::vector<Override> settings = with(sampling, test::nightly() ? 1024 : 256);
    settings.push_back({"/shapes/0/emission/spectrum", "0.5"});
    settings.push_back({"/materials/wall/diffuse/reflectance", "0.5"});
    const Film film = render(test::load("furnace.json", settings), {}).film;
    const test::Region all = test::region(film, 1, 0, 0, 16, 16);
    EXPECT_EQ(equivalence({all.mean, std::sqrt(all.variance)}, expected, 0.01), Verdict::pass)
        << testing::PrintToString(sampling) << ": " << all.mean / expected;
  }
}

// A meter's first directions are drawn likewise: under an even sky each tells pi L by the cosine, and by
// even directions 2 pi L cos, of the relative variance 1/3.
TEST(PathSampling, MetersDrawTheirDirectionsToo) {
  const auto measured = [](const char* directions) {
    const Scene scene =
        test::load_text(R"({"abbe": 1, "camera": {"irradiance_probe": {"at": [0, 0, 0], "normal": [0, 0, 1]}},
      "sensor": {"resolution": [1, 1], "response": "energy", "channels": {"all": 1}},
      "lights": [{"environment": {}, "emission": {"spectrum": 1}}]})",
                        with({directions, "bsdf", "balance"}, 65536));
    return test::region(render(scene, {}).film, 0, 0, 0, 1, 1);
  };
  const test::Region cosine = measured("cosine");
  const test::Region uniform = measured("uniform");
  EXPECT_LT(std::sqrt(cosine.variance), 1e-6 * cosine.mean);
  EXPECT_NEAR(uniform.mean / cosine.mean, 1, 0.01);
}

// A small lamp in the middle of a bulb of thin glass, whose caustic photons have shown: see
// caustic_guide_test.cpp. The guide is asked besides any way to draw directions.
TEST(PathSampling, TheGuideShowsCausticsToAll) {
  constexpr double kThrough = 24.0 / 26;
  const std::string bulb = R"(, {"sphere": {"center": [0, 2, 0], "radius": 0.5}, "material": "glass"})";
  const auto over_floor = [](const std::string& more) {
    return R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 8}, "from": [4, 2, 0], "to": [1, 0, 0], "up": [0, 1, 0]},
    "sensor": {"resolution": [8, 8], "observer": "1931"},
    "materials": {"grey": {"diffuse": {"reflectance": 0.5}}, "glass": {"thin_glass": {"ior": 1.5}}},
    "lights": [{"sphere": {"center": [0, 2, 0], "radius": 0.01}, "emission": {"spectrum": 1, "radiance": 100}}],
    "shapes": [{"quad": {"corner": [-9, 0, -9], "edge_u": [0, 0, 18], "edge_v": [18, 0, 0]}, "material": "grey"})" +
           more + R"(], "render": {"roulette_depth": 1}})";
  };
  const Scene open = test::load_text(over_floor(""), with(kSamplings[0], 256));
  const test::Region bare = test::region(test::film_of(open, make_plan(open), 256), 1, 0, 0, 8, 8);
  const int samples = test::nightly() ? 1024 : 256;
  for (const Sampling& sampling : kSamplings) {
    if (!test::nightly() && std::string(sampling.lights) != "mis") continue;
    const Scene closed = test::load_text(over_floor(bulb), with(sampling, samples));
    const Plan plan = make_trained_plan(closed, 2);
    ASSERT_FALSE(plan.guides.path_caustics.empty());
    const test::Region seen =
        test::region(test::film_of(closed, plan, static_cast<unsigned>(samples)), 1, 0, 0, 8, 8);
    EXPECT_NEAR(seen.mean / bare.mean, kThrough, kInterval * std::sqrt(seen.variance) / bare.mean)
        << testing::PrintToString(sampling);
    EXPECT_LT(std::sqrt(seen.variance) / seen.mean, test::nightly() ? 0.01 : 0.02)
        << testing::PrintToString(sampling);
  }
}

// Directions drawn without the guide keep their density beside it, and one that the guide adds has both.
TEST(PathSampling, TheGuideAddsToAnyDirections) {
  constexpr float kShare = 0.4F;
  CausticLobes::LobePacket along_normal;
  along_normal.z[0] = 1;
  along_normal.probability[0] = 1;
  const Imath::V3f normal(0, 0, 1);
  const SurfaceVertex vertex({{0, 0, 0}, normal, 0, 0}, Basis<float>(normal), {0.6F, 0, 0.8F},
                             DiffuseBsdf{SampledSpectrum(0.5F)});
  const Scene scene = test::load("furnace.json", with({"uniform", "mis", "balance"}, 1));
  const Plan plan = make_plan(scene);
  RayCaster caster(scene);
  const PathTracer tracer(plan, caster);
  for (std::uint32_t i = 0; i < 8; ++i) {
    CameraPath path(Sampler(0, Purpose::camera, 0, 0, i), 0);
    path.caustics = CausticLobes({&along_normal, 1}, 0.5F, kShare);
    const auto event = tracer.scatter(path, vertex, {0.5F, {0.3F, 0.6F}});
    ASSERT_TRUE(event);
    EXPECT_EQ(event->pdf, pdf_of_directions(DirectionSampling::uniform, vertex, event->wi)[0]);
    const auto added = tracer.scatter_added(path, vertex);
    ASSERT_TRUE(added);
    EXPECT_TRUE(path.seeks_caustic);
    const float both = kShare * path.caustics.pdf(vertex.hit.point, added->wi) +
                       pdf_of_directions(DirectionSampling::uniform, vertex, added->wi)[0];
    EXPECT_NEAR(added->pdf, both, 1e-5F * both);
  }
}

// Within a matt ball, light scattered three times is a smooth function of two directions. Roulette that
// begins at once ends no path here, but takes a number from each event, so that the directions no longer have
// one group: they find the same with more noise.
TEST(PathSampling, DirectionsOfTwoMattEventsAreOnePointOfASequence) {
  constexpr int kEdge = 24;
  const auto films_of = [](const char* roulette_depth) {
    const Scene scene = test::load_text(R"({"abbe": 1,
        "camera": {"pinhole": {"focal_length": 20}, "from": [0, -0.5, 0], "to": [0, 1, 0.2], "up": [0, 0, 1]},
        "sensor": {"resolution": [24, 24], "pixel_pitch_um": 1000, "observer": "1931"},
        "materials": {"white": {"diffuse": {"reflectance": 0.9}}},
        "lights": [{"point": {"at": [0.2, 0.1, 0.3]}, "emission": {"spectrum": 1, "intensity": 1}}],
        "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "white"}],
        "render": {"integrator": "path", "max_depth": 3}})",
                                        {{"/render/roulette_depth", roulette_depth}});
    const Plan plan = make_plan(scene);
    return std::array{test::film_of(scene, plan, 64, 1), test::film_of(scene, plan, 64, 2)};
  };
  const auto scatter = [](const std::array<Film, 2>& films) {
    double sum = 0;
    for (std::size_t pixel = 0; pixel < kEdge * kEdge; ++pixel)
      sum += std::pow(films[0].mean(pixel, 1) - films[1].mean(pixel, 1), 2);
    return sum;
  };
  EXPECT_LT(scatter(films_of("4")), 0.6 * scatter(films_of("1")));
}

// Numbers that one event leaves over for the next tell nothing of itself: neither of its direction nor, where
// it takes one of them, of its roulette.
TEST(PathSampling, NumbersLeftOverAreNotOnesTaken) {
  constexpr int kLayers = 4;
  const auto light_of_three_events = [](const char* roulette_depth) {
    const Scene scene = test::load("cornell.json", {{"/sensor/resolution", "[16, 16]"},
                                                    {"/materials/white/diffuse/reflectance", "0.2"},
                                                    {"/render/integrator", "path"},
                                                    {"/render/max_depth", "3"},
                                                    {"/render/roulette_depth", roulette_depth}});
    const RenderResult result = test::layered_film_of(make_plan(scene), bounce_layers(kLayers), 2048);
    return result.layers->average(3 * 3 + 1);
  };
  const Film::Average joined = light_of_three_events("4");
  const Film::Average apart = light_of_three_events("1");
  EXPECT_NEAR(joined.mean, apart.mean, kInterval * std::hypot(joined.standard_error, apart.standard_error));
  EXPECT_LT(joined.standard_error + apart.standard_error, 0.015 * joined.mean);
}

// Films of other settings are other films, which do not merge.
TEST(PathSampling, IsPartOfAFilmsIdentity) {
  const auto identity = [](const Sampling& sampling) {
    return identity_of(test::load("furnace.json", with(sampling, 1)), "furnace.json", {});
  };
  for (std::size_t i = 1; i < kSamplings.size(); ++i)
    EXPECT_NE(identity(kSamplings[0]), identity(kSamplings[i])) << testing::PrintToString(kSamplings[i]);
}

}  // namespace
}  // namespace abbe
