#include <cmath>
#include <numbers>

#include "materials/interface/fresnel.h"
#include "tests/scenes/margin.h"
#include "tests/scenes/polarised_scene.h"
#include "tests/tier.h"

namespace abbe::test {
namespace {

using Imath::V3d;

double rendered_mean(const Scene& scene) {
  return mean_of(render(scene, {}).film);
}

// A lamp of 1 W/(sr m^2 nm) seen in two faces of a poor metal, one after the other at that angle, the planes
// of incidence at right angles if `crossed`.
std::string two_mirrors(double angle_deg, bool crossed) {
  const double angle = angle_deg * std::numbers::pi / 180;
  const V3d looks(0, 0, 1);
  const V3d first_normal(std::sin(angle), 0, -std::cos(angle));
  const V3d first(0, 0, 1);
  const V3d between = looks - first_normal * (2 * looks.dot(first_normal));
  const V3d across = crossed ? V3d(0, 1, 0) : between.cross(V3d(0, 1, 0));
  const V3d second_normal = across * std::sin(angle) - between * std::cos(angle);
  const V3d second = first + between;
  const V3d leaves = between - second_normal * (2 * between.dot(second_normal));
  return fmt::format(R"({{"abbe": 1,
    "camera": {{"pinhole": {{"fov_deg": 0.2, "f_number": 1}}, "from": [0, 0, 0], "to": [0, 0, 1], "up": [0, 1, 0]}},
    "sensor": {{"observer": "1931", "resolution": [4, 4]}},
    "materials": {{"metal": {{"conductor": {{"ior": {{"n": 1.5, "k": 0.7}}}}}}}},
    "lights": [{{"quad": {}, "emission": {{"illuminant": "E", "luminance": 1}}}}],
    "shapes": [{{"quad": {}, "material": "metal"}}, {{"quad": {}, "material": "metal"}}],
    "render": {{"samples": 64}}}})",
                     square(second + leaves, -leaves, 0.1), square(first, first_normal, 0.1),
                     square(second, second_normal, 0.1));
}

// Two faces that reflect s and p by their powers: in one plane of incidence each keeps its own, in crossed
// ones s is p at the other.
TEST(Polarisation, TwoMirrorsAtAnyAngle) {
  const double unit = rendered_mean(load_text(R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 0.2, "f_number": 1}, "from": [0, 0, 0], "to": [0, 0, 1], "up": [0, 1, 0]},
    "sensor": {"observer": "1931", "resolution": [4, 4]},
    "lights": [{"quad": {"corner": [-1, -1, 1], "edge_u": [0, 2, 0], "edge_v": [2, 0, 0]},
                "emission": {"illuminant": "E", "luminance": 1}}],
    "render": {"samples": 64}})"));
  for (const double angle_deg : {30.0, 45.0, 56.3099325, 70.0}) {
    const FresnelPower<double> face =
        fresnel_conductor(std::cos(angle_deg * std::numbers::pi / 180), 1.5, 0.7);
    const auto seen = [&](bool crossed, const std::vector<Override>& settings) {
      return rendered_mean(load_text(two_mirrors(angle_deg, crossed), settings)) / unit;
    };
    const double kept = (face.Rs * face.Rs + face.Rp * face.Rp) / 2;
    EXPECT_NEAR(seen(false, {}) / kept, 1, 1e-4) << angle_deg;
    EXPECT_NEAR(seen(true, {}) / (face.Rs * face.Rp), 1, 1e-4) << angle_deg;
    for (const bool crossed : {false, true})
      EXPECT_NEAR(seen(crossed, {{"/render/polarisation", "off"}}) / (face.R() * face.R()), 1, 1e-4)
          << angle_deg;
  }
}

// A polarised lamp and a poor, rough metal at right angles to itself, with other shapes, in mist as fine as
// air. The camera stands outside: what photons that matter scatters near a lens bring to it goes by one over
// their squared distance, which has no finite variance.
std::string hall(const std::string& others) {
  return R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 40, "f_number": 4}, "from": [0, -4, 1], "to": [0, 0, 0.9], "up": [0, 0, 1]},
    "sensor": {"resolution": [8, 8], "channels": {"A": {"band": [450, 500]}, "B": {"band": [600, 650]}}},
    "materials": {"card": {"diffuse": {"reflectance": 0.8}}, "glass": {"dielectric": {"ior": "N-SF11"}},
                  "metal": {"conductor": {"ior": {"n": 1.5, "k": 0.4}, "roughness": 0.4}},
                  "matt": {"dielectric": {"ior": {"n": 1.6}, "roughness": 0.4}},
                  "mist": {"medium": {"scattering_per_m": 0.15, "phase": "rayleigh"}}},
    "lights": [{"sphere": {"center": [0.3, -0.4, 2.9], "radius": 0.3},
                "emission": {"illuminant": "E", "radiant_flux_W": 10, "polarised": {"axis": [1, 0.2, 0.3]}}}],
    "shapes": [{"sphere": {"center": [0, 0, 1], "radius": 3.5}, "material": "mist"},
               {"quad": {"corner": [-2, -2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]}, "material": "card"},
               {"quad": {"corner": [-2, 1.5, 0], "edge_u": [4, 0, 0], "edge_v": [0, 0, 3]}, "material": "metal"},
               {"quad": {"corner": [-1.5, -2, 0], "edge_u": [0, 4, 0], "edge_v": [0, 0, 3]}, "material": "metal"},
               {"sphere": {"center": [0.7, 0.3, 0.5], "radius": 0.4}, "material": "matt"})" +
         others + R"(], "render": {"max_depth": 6, "roulette_depth": 5}})";
}

constexpr const char* kBall =
    R"(, {"sphere": {"center": [-0.6, 0.2, 0.5], "radius": 0.4}, "material": "glass"})";

// By day of as many photons as suit a film this small.
std::vector<Override> by(const char* integrator, int samples) {
  std::vector<Override> settings{{"/render/integrator", integrator},
                                 {"/render/samples", std::to_string(samples)}};
  if (!nightly() && std::string(integrator) == "sppm")
    settings.push_back({"/render/photons", R"({"per_sample": 1024})"});
  return settings;
}

Film seen_by(const char* integrator, int samples, const std::string& others) {
  return render(load_text(hall(others), by(integrator, samples)), {}).film;
}

// What a row measures of light is the same whichever end it is carried from.
TEST(Polarisation, IsTheSameFromEitherEnd) {
  const Film path = seen_by("path", nightly() ? 16384 : 1024, "");
  const Film photons = seen_by("light", nightly() ? 131072 : 8192, "");
  const Comparison light = compare_regions(path, photons, 4);
  std::printf("light: largest z %.2f, ratio of the means %.5f\n", light.largest_z, light.ratio);
  EXPECT_LT(light.largest_z, 5.5);
  EXPECT_NEAR(light.ratio, 1, ratio_margin(path, photons, 0.01, 0.1));
  const Film with_ball = seen_by("path", nightly() ? 16384 : 512, kBall);
  for (const char* integrator : {"bdpt", "vcm", "sppm"}) {
    const Film film = seen_by(integrator, nightly() ? 4096 : 64, kBall);
    const Comparison c = compare_regions(with_ball, film, nightly() ? 4 : 2);
    std::printf("%s: largest z %.2f, ratio of the means %.5f\n", integrator, c.largest_z, c.ratio);
    EXPECT_LT(c.largest_z, 5.5) << integrator;
    EXPECT_NEAR(c.ratio, 1, ratio_margin(with_ball, film, 0.01, 0.2)) << integrator;
  }
}

// As that of the same paths where no other component is asked for.
TEST(Polarisation, TheErrorOfAStokesFilmIsThatOfItsIntensities) {
  const auto error = [](const char* stokes) {
    std::vector<Override> settings = by("path", 16);
    settings.push_back({"/sensor/stokes", stokes});
    return render(load_text(hall(""), settings), {.measure_error = true}).stats.error.frame_mean;
  };
  ASSERT_GT(error("false"), 0.01);
  EXPECT_NEAR(error("true") / error("false"), 1, 1e-6);
}

// What it is worth there, so that the test above tells what leaves it out.
TEST(Polarisation, MattersThere) {
  Scene scene = load_text(hall(""), by("path", 2048));
  const Film carried = render(scene, {}).film;
  scene.render.polarisation = false;
  const Film left_out = render(scene, {}).film;
  EXPECT_GT(compare_regions(carried, left_out, 4).largest_z, 10);
}

// A lamp of that emission behind shapes, seen along z by an observer.
std::string lamp_behind(const std::string& emission, const std::string& sensor, const std::string& shapes) {
  return R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 0.2, "f_number": 1}, "from": [0, 0, 0], "to": [0, 0, 1], "up": [0, 1, 0]},
    "sensor": {"observer": "1931", "resolution": [4, 4])" +
         sensor + R"(},
    "materials": {
      "across": {"polariser": {"angle_deg": 90}}, "slanted": {"polariser": {"angle_deg": 45}}, "along": {"polariser": {}},
      "quarter": {"wave_plate": {"retardance_deg": 90, "angle_deg": 45}},
      "half": {"wave_plate": {"retardance_deg": 180, "angle_deg": 45}},
      "third": {"wave_plate": {"retardance_deg": 120, "angle_deg": 45}}, "wedge": {"depolariser": {}}},
    "lights": [{"quad": {"corner": [-1, -1, 9], "edge_u": [0, 2, 0], "edge_v": [2, 0, 0]},
                "emission": {"illuminant": "E", "luminance": 1)" +
         emission + R"(}}],
    "shapes": [)" +
         shapes + R"(], "render": {"samples": 64, "roulette_depth": 20}})";
}
std::string stack_of(const std::vector<std::string>& materials) {
  std::string shapes;
  for (std::size_t k = 0; k < materials.size(); ++k)
    shapes += fmt::format(
        R"({}{{"quad": {{"corner": [-1, -1, {}], "edge_u": [0, 2, 0], "edge_v": [2, 0, 0]}}, "material": "{}"}})",
        k == 0 ? "" : ", ", k + 1, materials[k]);
  return shapes;
}

TEST(Polarisation, MalusLawOfAPolarisedLampBeforeAPolariser) {
  const double unit = rendered_mean(load_text(lamp_behind("", "", "")));
  constexpr double kLampDeg = 20;  // from x towards y; the picture's right is -x
  const double lamp = kLampDeg * std::numbers::pi / 180;
  const std::string emission =
      fmt::format(R"(, "polarised": {{"axis": [{}, {}, 0]}})", -std::cos(lamp), std::sin(lamp));
  for (int k = 0; k < 19; ++k) {
    const double angle_deg = 10.0 * k;
    const std::string sensor = fmt::format(R"(, "polariser": {{"angle_deg": {}}})", angle_deg);
    const double cosine = std::cos((angle_deg - kLampDeg) * std::numbers::pi / 180);
    EXPECT_NEAR(rendered_mean(load_text(lamp_behind(emission, sensor, ""))) / unit, cosine * cosine, 1e-4)
        << angle_deg;
  }
  EXPECT_NEAR(rendered_mean(load_text(lamp_behind("", R"(, "polariser": {"angle_deg": 30})", ""))) / unit,
              0.5, 1e-4);
}

// Unpolarised light through elements one behind the other: half of it through the first polariser, then what
// Mueller's matrices of ideal elements leave.
TEST(Polarisation, PolarisersAndWavePlatesInARow) {
  const double unit = rendered_mean(load_text(lamp_behind("", "", "")));
  const auto through = [&](const std::vector<std::string>& materials) {
    return rendered_mean(load_text(lamp_behind("", "", stack_of(materials)))) / unit;
  };
  EXPECT_NEAR(through({"along"}), 0.5, 1e-4);
  EXPECT_NEAR(through({"along", "across"}), 0, 1e-6);
  EXPECT_NEAR(through({"along", "slanted"}), 0.25, 1e-4);
  EXPECT_NEAR(through({"along", "slanted", "across"}), 0.125, 1e-4);
  EXPECT_NEAR(through({"along", "quarter", "across"}), 0.25, 1e-4);
  EXPECT_NEAR(through({"along", "half", "across"}), 0.5, 1e-4);
  EXPECT_NEAR(through({"along", "third", "across"}), 0.375, 1e-4);
  EXPECT_NEAR(through({"along", "quarter", "quarter", "across"}), 0.5, 1e-4);
  EXPECT_NEAR(through({"along", "wedge", "across"}), 0.25, 1e-4);
}

// A ball of thin air, lit by a beam, whose light turned once is polarised by sin^2/(1 + cos^2) of the angle,
// across the plane of both ways: a tabulated solution of a clear sky's kind, by its first order.
TEST(Polarisation, AirSeenBySingleScattering) {
  for (const double turned_deg : {20.0, 60.0, 90.0, 140.0}) {
    const double turned = turned_deg * std::numbers::pi / 180;
    const V3d beam(0, std::sin(turned),
                   -std::cos(turned));  // the camera looks along z: light goes on to it along -z
    const Scene scene = load_text(fmt::format(
        R"({{"abbe": 1,
        "camera": {{"pinhole": {{"fov_deg": 0.2, "f_number": 1}}, "from": [0, 0, -10], "to": [0, 0, 0], "up": [0, 1, 0]}},
        "sensor": {{"observer": "1931", "resolution": [4, 4], "stokes": true}},
        "materials": {{"air": {{"medium": {{"scattering_per_m": 0.01, "phase": "rayleigh"}}}}}},
        "lights": [{{"directional": {{"towards": {}}}, "emission": {{"illuminant": "E", "illuminance": 1}}}}],
        "shapes": [{{"sphere": {{"center": [0, 0, 0], "radius": 1}}, "material": "air"}}],
        "render": {{"samples": 512, "max_depth": 1, "integrator": "path"}}}})",
        text_of(beam * -1.0)));
    const Film film = render(scene, {}).film;
    const auto element = [&](int k) { return region(film, 1 + k * 3, 0, 0, 4, 4).mean; };  // of Y
    const double cosine = std::cos(turned);
    const double degree = (1 - cosine * cosine) / (1 + cosine * cosine);
    EXPECT_NEAR(element(1) / element(0), degree, 3e-3)
        << turned_deg;  // across the plane is the picture's right
    EXPECT_NEAR(element(2) / element(0), 0, 3e-3) << turned_deg;
    EXPECT_NEAR(element(3) / element(0), 0, 1e-4) << turned_deg;
  }
}

TEST(Polarisation, FilmsOfStokesVectorsAreTheSameByEveryIntegrator) {
  const auto seen = [](const char* integrator, int samples) {
    std::vector<Override> settings = by(integrator, samples);
    settings.push_back({"/sensor/stokes", "true"});
    settings.push_back({"/lights/0/emission/polarised", R"({"circular": "right", "degree": 0.7})"});
    return render(load_text(hall(""), settings), {}).film;
  };
  const struct {
    const char* integrator;
    int by_day, at_night;
  } others[] = {{"light", 256, 2048},
                {"bdpt", 64, 256},
                {"vcm", 64, 256},
                {"sppm", 64, 512},
                {"adjoint-brute", 2048, 2048}};
  const Film path = seen("path", nightly() ? 2048 : 256);
  for (const auto& [integrator, by_day, at_night] : others) {
    const Comparison c = compare_regions(path, seen(integrator, nightly() ? at_night : by_day), 2);
    std::printf("%s: largest z %.2f\n", integrator, c.largest_z);
    EXPECT_LT(c.largest_z, 5.5) << integrator;
  }
  for (int element = 1; element < 4; ++element) {
    double largest = 0;
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const Region r = region(path, 2 * element, 4 * i, 4 * j, 4 * i + 4, 4 * j + 4);
        largest = std::max(largest, std::abs(r.mean) / std::sqrt(r.variance));
      }
    EXPECT_GT(largest, 10) << "element " << element << " is told from noise";
  }
}

// Through a polariser as well, what only scatters is invisible amid even light, which is met and connected to
// from everywhere in it.
TEST(Polarisation, AirBehindAPolariserIsInvisibleInAFurnace) {
  const auto seen = [](const char* shapes) {
    return region(render(load_text(fmt::format(R"({{"abbe": 1,
        "camera": {{"pinhole": {{"fov_deg": 8, "f_number": 1}}, "from": [0, 0, -10], "to": [0, 0, 0], "up": [0, 1, 0]}},
        "sensor": {{"resolution": [4, 4], "channels": {{"A": {{"polariser": {{"angle_deg": 0}}}}}}}},
        "materials": {{"air": {{"medium": {{"phase": "rayleigh", "scattering_per_m": 1}}}}}},
        "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
        "shapes": [{}], "render": {{"samples": {}, "integrator": "path", "max_depth": 200}}}})",
                                               shapes, 32768)),
                         {})
                      .film,
                  0, 0, 0, 4, 4);
  };
  const Region air = seen(R"({"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "air"})");
  const double ratio = air.mean / seen("").mean;
  std::printf("air behind a polariser: %.5f +- %.5f\n", ratio, std::sqrt(air.variance) / air.mean);
  EXPECT_NEAR(ratio, 1, 0.003);
}

// Light goes through a polariser to a mirror and back through it, which takes no more.
TEST(Polarisation, OneSurfaceIsMetTwiceByWayOfAMirror) {
  const auto seen = [](const char* sheet) {
    return region(render(load_text(fmt::format(R"({{"abbe": 1,
        "camera": {{"pinhole": {{"fov_deg": 2}}, "from": [0, -10, 0], "to": [0, 0, 0], "up": [0, 0, 1]}},
        "sensor": {{"resolution": [2, 2], "channels": {{"G": {{"band": [500, 600]}}}}}},
        "materials": {{"p": {{"polariser": {{}}}}, "m": {{"mirror": {{"reflectance": 1}}}}}},
        "lights": [{{"quad": {{"corner": [-30, -30, -30], "edge_u": [0, 0, 60], "edge_v": [60, 0, 0]}}, "emission": {{"spectrum": 1}}}}],
        "shapes": [{}{{"quad": {{"corner": [-3, 2, -3], "edge_u": [6, 0, 0], "edge_v": [0, 0, 6]}}, "material": "m"}}],
        "render": {{"samples": 32}}}})",
                                               sheet)),
                         {})
                      .film,
                  0, 0, 0, 2, 2)
        .mean;
  };
  const double with = seen(
      R"({"quad": {"corner": [-3, 0, -3], "edge_u": [6, 0, 0], "edge_v": [0, 0, 6]}, "material": "p"}, )");
  EXPECT_NEAR(with / seen(""), 0.5, 1e-4);
}

// A poor metal that light comes to from a card alone, so that all of what photons bring there is merged.
TEST(Polarisation, MergedPhotonsAreReflectedAsLightIs) {
  const auto seen = [](const char* integrator, int samples) {
    return render(
               load_text(R"({"abbe": 1,
        "camera": {"pinhole": {"fov_deg": 12, "f_number": 4}, "from": [0, -2, 1.6], "to": [0, 1, 0.5], "up": [0, 0, 1]},
        "sensor": {"resolution": [4, 4], "channels": {"A": {"band": [500, 600]}}, "stokes": true},
        "materials": {"card": {"diffuse": {"reflectance": 0.8}},
                      "metal": {"conductor": {"ior": {"n": 1.5, "k": 0.4}, "roughness": 0.3}}},
        "lights": [{"directional": {"towards": [0, 0, 1]}, "emission": {"illuminant": "E", "illuminance": 1000}}],
        "shapes": [{"quad": {"corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}, "material": "card"},
                   {"quad": {"corner": [-1, 1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 0, 1.5]}, "material": "metal"}],
        "render": {}})",
                         {{"/render/integrator", integrator}, {"/render/samples", std::to_string(samples)}}),
               {})
        .film;
  };
  const auto degree = [](const Film& film) {
    return region(film, 1, 0, 0, 4, 4).mean / region(film, 0, 0, 0, 4, 4).mean;
  };
  const double by_paths = degree(seen("path", 8192));
  EXPECT_GT(std::abs(by_paths), 0.1);
  for (const char* integrator : {"photon-map", "vcm"}) {
    const double by_photons = degree(seen(integrator, 128));
    std::printf("%s: Q/I %.5f, by paths %.5f\n", integrator, by_photons, by_paths);
    EXPECT_NEAR(by_photons / by_paths, 1, 0.015) << integrator;
  }
}

}  // namespace
}  // namespace abbe::test
