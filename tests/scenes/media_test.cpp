#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include <fmt/format.h>

#include "tests/angles.h"
#include "tests/scene/meshes.h"
#include "tests/scenes/scene_fixture.h"
#include "transport/path/media.h"
#include "validation/cases/radiative_transfer.h"

// Films of matter that absorbs and scatters, held against what radiative transfer says of it.

namespace abbe {
namespace {

constexpr double kLargestZ = 4.5;  // of a few dozen figures here, by Sidak's correction at 3e-4

// What stands in a scene, seen by a pinhole that looks along +y from (0, -5, 0) in three narrow bands.
struct Bench {
  std::string materials = "";
  std::string shapes = "";
  std::string lights = R"({"environment": {}, "emission": {"spectrum": 1}})";
  std::string camera = R"("from": [0, -5, 0], "to": [0, 0, 0], "up": [0, 0, 1])";
  double fov_deg = 1;
  int samples = 256;
  std::string depth = "";
  std::string integrator = "path";
  std::string bands = R"("B": {"band": [445, 455]}, "G": {"band": [545, 555]}, "R": {"band": [645, 655]})";
};

RenderResult rendered(const Bench& b) {
  return render(test::load_text(fmt::format(
                    R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": {}}}, {}}},
      "sensor": {{"resolution": [4, 4], "channels": {{{}}}}},
      "materials": {{"black": {{"diffuse": {{"reflectance": 0}}}}{}}}, "lights": [{}], "shapes": [{}],
      "render": {{"integrator": "{}", "samples": {}, {}"roulette_depth": 16}}}})",
                    b.fov_deg, b.camera, b.bands, b.materials.empty() ? "" : ", " + b.materials, b.lights,
                    b.shapes, b.integrator, b.samples, b.depth)),
                {});
}

struct Radiance {
  double value = 0;
  double error = 0;
};
// Mean over the film of the radiance in each band, that of the environment alone being 1.
std::vector<Radiance> radiances(const Bench& bench) {
  Bench empty = bench;
  empty.materials = empty.shapes = "";
  empty.lights = Bench().lights;
  empty.samples = 8192;
  empty.integrator = "path";
  const RenderResult one = rendered(empty);
  const RenderResult all = rendered(bench);
  EXPECT_EQ(all.stats.nonfinite_samples, 0U);
  std::vector<Radiance> found;
  for (int channel = 0; channel < all.film.channels(); ++channel) {
    const double unit = test::region(one.film, channel, 0, 0, 4, 4).mean;
    const test::Region of = test::region(all.film, channel, 0, 0, 4, 4);
    found.push_back({of.mean / unit, std::sqrt(of.variance) / unit});
  }
  return found;
}

void expect_near(const std::vector<Radiance>& found, const std::vector<double>& expected, double margin,
                 const std::string& what) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LT(found[i].error, margin * expected[i]) << what << ", band " << i << ": too noisy to tell";
    EXPECT_NEAR(found[i].value, expected[i], kLargestZ * found[i].error + 1e-5 * expected[i])
        << what << ", band " << i;
  }
}

std::string ball(const std::string& material, double radius = 1) {
  return fmt::format(R"({{"sphere": {{"center": [0, 0, 0], "radius": {}}}, "material": "{}"}})", radius,
                     material);
}

// Ten times as much in the blue as in the red, so that the lanes of a path disagree.
constexpr const char* kColoured =
    R"({"table": {"wavelength_nm": [440, 660], "values": [10, 1], "outside": "clamp"}})";

class GridFile {
 public:
  explicit GridFile(const std::vector<float>& values, std::array<int, 3> size)
      : path_(std::filesystem::temp_directory_path() / fmt::format("abbe_grid_{}.npy", ::getpid())) {
    std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}, {}), }}",
                                     size[2], size[1], size[0]);
    header.resize(117, ' ');
    header += '\n';
    std::ofstream file(path_, std::ios::binary);
    file.write("\x93NUMPY\x01\x00", 8);
    file.put(static_cast<char>(header.size())).put(0);
    file << header;
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(float)));
  }
  ~GridFile() { std::filesystem::remove(path_); }
  GridFile(const GridFile&) = delete;
  GridFile& operator=(const GridFile&) = delete;
  [[nodiscard]] std::string json() const {
    return fmt::format(R"("grid": {{"densities": "{}", "from": [-1, -1, -1], "to": [1, 1, 1]}})",
                       path_.string());
  }

 private:
  std::filesystem::path path_;
};

std::vector<float> ragged(std::size_t count) {
  std::mt19937 random(11);
  std::vector<float> values(count);
  for (float& v : values) v = static_cast<float>(random() % 5) / 2;
  return values;
}

// What scatters all it meets is invisible amid even light, whatever its density and phase function, and so is
// what absorbs as much at no wavelength.
TEST(Media, WhatOnlyScattersIsInvisibleInAFurnace) {
  const GridFile grid(ragged(125), {5, 5, 5});
  const auto medium = [](const std::string& inside) {
    return fmt::format(R"("fog": {{"medium": {{"scattering_per_m": {}, {}}}}})", kColoured, inside);
  };
  const std::vector<double> one(3, 1.0);
  expect_near(
      radiances({.materials = medium(R"("phase": "isotropic")"), .shapes = ball("fog"), .samples = 512}), one,
      0.03, "isotropic");
  expect_near(
      radiances({.materials = medium(R"("phase": {"henyey_greenstein": 0.9})"), .shapes = ball("fog")}), one,
      0.03, "forward");
  expect_near(
      radiances(
          {.materials = medium(R"("phase": "rayleigh", )" + grid.json()),
           .shapes =
               R"({"quad": {"corner": [-9, 9, -9], "edge_u": [1, 0, 0], "edge_v": [0, 0, 1]}, "material": "black"}, )" +
               ball("fog", 1.5)}),
      one, 0.03, "grid");
  expect_near(radiances({.materials = fmt::format(
                             R"("fog": {{"dielectric": {{"ior": 1.5, "scattering_per_m": {}}}}})", kColoured),
                         .shapes = ball("fog")}),
              one, 0.03, "within glass");
  // Dense: much of the light comes out after hundreds of events only.
  expect_near(radiances({.materials = R"("fog": {"medium": {"scattering_per_m": 100}})",
                         .shapes = ball("fog"),
                         .samples = 1024}),
              one, 0.03, "dense");
  expect_near(radiances({.materials = medium(R"("phase": "rayleigh")") +
                                      R"(, "haze": {"medium": {"scattering_per_m": 0.7}})",
                         .shapes = ball("fog", 0.3) + ", " + ball("haze", 1.5)}),
              one, 0.03, "fog within haze");
}

// Light comes out of a thick ball of clear milk after n events with a probability in proportion to n^(-3/2),
// so that long paths carry a good part of it.
TEST(Media, ThickMilkIsInvisibleInAFurnaceToo) {
  expect_near(radiances({.materials = R"("milk": {"dielectric": {"ior": 1.33, "scattering_per_m": 2000}})",
                         .shapes = ball("milk"),
                         .samples = 1024}),
              std::vector<double>(3, 1.0), 0.015, "thick milk");
}

// A deep layer that scatters evenly and absorbs a tenth of what it meets, under an even sky, looks
// 1 - H(mu) sqrt(1 - albedo) times as bright as the sky [Chandrasekhar1960, sec. 33]. Its density varies with
// wavelength, which changes nothing.
TEST(Media, ADeepLayerReflectsByChandrasekharsFunction) {
  const ChandrasekharH h(0.9);
  double mean = 0;
  for (int i = 0; i < 400; ++i) mean += h((i + 0.5) / 400) / 400;
  EXPECT_NEAR(mean, 2 / 0.9 * (1 - std::sqrt(0.1)), 1e-5);  // its zeroth moment
  const std::string fog = fmt::format(
      R"("fog": {{"medium": {{"scattering_per_m": {{"scale": 0.9, "of": {0}}}, "absorption_per_m": {{"scale": 0.1, "of": {0}}}}}}})",
      kColoured);
  const char* box =
      R"({"mesh": {"vertices": [[-60, -60, -60], [60, -60, -60], [-60, 60, -60], [60, 60, -60], [-60, -60, 0], [60, -60, 0], [-60, 60, 0], [60, 60, 0]],
    "triangles": [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]}, "material": "fog"})";
  for (const double mu : {1.0, 0.5, 0.2}) {
    const double reflected = 1 - h(mu) * std::sqrt(0.1);
    const auto found =
        radiances({.materials = fog,
                   .shapes = box,
                   .camera = fmt::format(R"("from": [0, {}, {}], "to": [0, 0, 0], "up": [1, 0, 0])",
                                         -5 * std::sqrt(1 - mu * mu), 5 * mu),
                   .fov_deg = 0.1,
                   .samples = 1024});
    expect_near(found, {reflected, reflected, reflected}, 0.01, fmt::format("mu = {}", mu));
  }
}

double forward(double cosine) {  // Henyey-Greenstein, g = 0.5
  return 0.75 / (4 * kPi * std::pow(1.25 - cosine, 1.5));
}
double rayleigh(double cosine) {
  return 3 / (16 * kPi) * (1 + cosine * cosine);
}

constexpr const char* kLamp = R"({"point": {"at": [0, 0, 0.5]}, "emission": {"spectrum": 1}})";

// Camera and lamp both stand in the fog, and the path has but one event.
TEST(Media, LightScatteredOnceIsTheIntegralAlongTheLine) {
  const Bench bench{
      .materials =
          R"("fog": {"medium": {"scattering_per_m": 0.3, "absorption_per_m": 0.1, "phase": {"henyey_greenstein": 0.5}}})",
      .shapes = ball("fog", 100),
      .lights = kLamp,
      .fov_deg = 0.01,
      .samples = 2048,
      .depth = R"("max_depth": 1, )"};
  const double expected = single_scattering_radiance({0.3, 0.4, forward}, 0.5, 5, 95);
  expect_near(radiances(bench), {expected, expected, expected}, 0.003, "path");
  // A sphere of it around the lamp alone, which the camera is outside of.
  Bench outside = bench;
  outside.shapes = ball("fog", 2);
  const double nearer = single_scattering_radiance({0.3, 0.4, forward}, 0.5, 2, 2);
  expect_near(radiances(outside), {nearer, nearer, nearer}, 0.003, "from outside");
}

// The beam of a narrow spot across the line of sight, in matter whose lanes differ.
TEST(Media, ABeamIsTheIntegralAcrossIt) {
  constexpr double kHalfAngle_deg = 2;
  const Bench bench{
      .materials =
          R"("fog": {"medium": {"scattering_per_m": {"table": {"wavelength_nm": [440, 460, 540, 560, 640, 660],
        "values": [0.6, 0.6, 0.3, 0.3, 0.1, 0.1], "outside": "clamp"}}, "absorption_per_m": 0.1}})",
      .shapes = ball("fog", 100),
      .lights = fmt::format(R"({{"spot": {{"at": [0, 0, 0.5], "direction": [0, 0, -1], "half_angle_deg": {}}},
                                "emission": {{"spectrum": 1}}}})",
                            kHalfAngle_deg),
      .fov_deg = 0.01,
      .samples = 512,
      .depth = R"("max_depth": 1, )"};
  const double across = 0.5 * std::tan(kHalfAngle_deg * kPi / 180);
  std::vector<double> expected;
  for (const double scattering : {0.6, 0.3, 0.1}) {
    const double way = std::exp(-(scattering + 0.1) * (5 - across));
    expected.push_back(
        way * single_scattering_radiance({scattering, scattering + 0.1, [](double) { return 1 / (4 * kPi); }},
                                         0.5, across, across));
  }
  expect_near(radiances(bench), expected, 0.003, "beam");
}

// What is far smaller than the wavelength scatters by 1/lambda^4 [Strutt1871]: the sky is blue.
TEST(Media, TheSkyIsBlue) {
  const auto scattering = [](double nm) { return 0.01 * std::pow(500 / nm, 4); };
  std::string nms, values;
  for (int nm = 440; nm <= 660; ++nm) {
    nms += fmt::format("{}{}", nms.empty() ? "" : ", ", nm);
    values += fmt::format("{}{}", values.empty() ? "" : ", ", scattering(nm));
  }
  const auto found = radiances(
      {.materials = fmt::format(
           R"("air": {{"medium": {{"phase": "rayleigh", "scattering_per_m": {{"table": {{"wavelength_nm": [{}], "values": [{}], "outside": "clamp"}}}}}}}})",
           nms, values),
       .shapes = ball("air", 3),
       .lights = kLamp,
       .fov_deg = 0.01,
       .samples = 32768,
       .depth = R"("max_depth": 1, )"});
  std::vector<double> expected;
  for (const double nm : {450, 550, 650})
    expected.push_back(single_scattering_radiance({scattering(nm), scattering(nm), rayleigh}, 0.5, 3, 3));
  EXPECT_GT(expected[0] / expected[2], 4);
  expect_near(found, expected, 0.02, "air");
}

// Slabs before a wall that a lamp lights from beyond them: where two share a place, there is the matter of
// one of them, the same for light from either end.
TEST(Media, WhatOverlapsInPartIsTheSameFromBothEnds) {
  const auto slab = [](const std::string& material, double from, double to) {
    return fmt::format(R"(, {{"material": "{}", "mesh": {}}})", material,
                       test::inline_mesh(test::box({-2, from, -2}, {2, to, 2})));
  };
  const std::string thin = slab("thin", -1, 1);
  const std::string dense = slab("dense", 0, 2);
  const std::string within = R"("from": [0, 0.5, 0], "to": [0, 5, 0], "up": [0, 0, 1])";
  struct Case {
    std::string shapes;
    double depth;
    int priority = 0;  // of the thin one
    std::string camera = Bench().camera;
  };
  const std::vector<Case> cases{
      {thin + dense, 0.3 + 2 * 0.9},  // of equal volumes the later one of the scene
      {dense + thin, 2 * 0.3 + 0.9},
      {thin + dense, 2 * 0.3 + 0.9, 1},
      {thin + slab("dense", 0, 4), 2 * 0.3 + 3 * 0.9},  // the smaller volume
      {slab("dense", 0, 4) + thin, 2 * 0.3 + 3 * 0.9},
      {slab("dense", -0.5, 0.5) + thin, 0.3 + 0.9},  // what lies within, whichever comes first
      {thin + slab("dense", -0.5, 0.5), 0.3 + 0.9},
      {thin + dense, 1.5 * 0.9, 0, within},
      {dense + thin, 0.5 * 0.3 + 0.9, 0, within}};
  const auto lit_wall = [&](const Case& c, const std::string& slabs, const char* integrator) {
    Bench bench;
    bench.bands = R"("G": {"band": [545, 555]})";
    bench.materials = fmt::format(
        R"("wall": {{"diffuse": {{"reflectance": 0.5}}}}, "dense": {{"medium": {{"absorption_per_m": 0.9}}}},
           "thin": {{"medium": {{"absorption_per_m": 0.3}}, "priority": {}}})",
        c.priority);
    bench.shapes =
        R"({"quad": {"corner": [-1, 5, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2]}, "material": "wall"})" +
        slabs;
    bench.lights =
        R"({"spot": {"at": [0, 4.5, 1], "direction": [0, 0.5, -1], "half_angle_deg": 8}, "emission": {"spectrum": 1}})";
    bench.camera = c.camera;
    bench.integrator = integrator;
    bench.samples = 1024;
    bench.depth = R"("max_depth": 1, )";
    return test::region(rendered(bench).film, 0, 0, 0, 4, 4);
  };
  for (const Case& c : cases) {
    const test::Region bare = lit_wall(c, "", "path");
    for (const char* integrator : {"path", "light", "bdpt"}) {
      const test::Region seen = lit_wall(c, c.shapes, integrator);
      const double error = std::sqrt(bare.variance + seen.variance) / bare.mean;
      EXPECT_LT(error, 0.04 * std::exp(-c.depth));
      EXPECT_NEAR(seen.mean / bare.mean, std::exp(-c.depth), kLargestZ * error + 2e-4 * std::exp(-c.depth))
          << integrator << " of " << c.shapes;
    }
  }
}

// Stress 30: what is left of light after optical depths from 1e-8 to 1e4.
TEST(Media, TransmittanceHoldsAtAnyOpticalDepth) {
  for (const double depth : {1e-8, 1e-4, 0.1, 1.0, 10.0, 20.0, 1e4}) {
    const auto found =
        radiances({.materials = fmt::format(R"("ink": {{"medium": {{"absorption_per_m": {}}}}})", depth / 2),
                   .shapes = ball("ink"),
                   .fov_deg = 0.01,
                   .samples = 8192});
    for (const Radiance& r : found) EXPECT_NEAR(r.value, std::exp(-depth), 1e-3 * std::exp(-depth)) << depth;
  }
}

// One film of three bands, whose paths carry lanes that scatter very differently, against a film for each
// band, in matter that turns light far and colours it.
TEST(Media, LanesAgreeWithFilmsOfOneBand) {
  const Bench all{
      .materials = fmt::format(
          R"("fog": {{"medium": {{"scattering_per_m": {}, "absorption_per_m": 0.5, "phase": {{"henyey_greenstein": -0.3}}}}}})",
          kColoured),
      .shapes = ball("fog"),
      .lights =
          R"({"sphere": {"center": [3, 0, 3], "radius": 1}, "emission": {"spectrum": 1}}, {"sphere": {"center": [0.2, 0.3, 0], "radius": 0.3}, "emission": {"spectrum": 0.1}})",
      .fov_deg = 20,
      .samples = 1024};
  const std::vector<Radiance> together = radiances(all);
  const std::array<std::string, 3> bands{R"("B": {"band": [445, 455]})", R"("G": {"band": [545, 555]})",
                                         R"("R": {"band": [645, 655]})"};
  for (std::size_t i = 0; i < bands.size(); ++i) {
    Bench one = all;
    one.bands = bands.at(i);
    const Radiance alone = radiances(one).front();
    const double error = std::hypot(together[i].error, alone.error);
    EXPECT_LT(error, 0.03 * alone.value);
    EXPECT_NEAR(together[i].value, alone.value, kLargestZ * error) << bands.at(i);
  }
}

// The box that `GridFile` fills, without its braces.
constexpr const char* kFogBox =
    R"("mesh": {"vertices": [[-1, -1, -1], [1, -1, -1], [-1, 1, -1], [1, 1, -1], [-1, -1, 1], [1, -1, 1], [-1, 1, 1], [1, 1, 1]],
    "triangles": [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]}, "material": "fog")";

// An even grid in the box it fills is a box of even matter.
TEST(Media, AnEvenGridIsEvenMatter) {
  const GridFile grid(std::vector<float>(27, 2.0F), {3, 3, 3});
  const std::string box = fmt::format("{{{}}}", kFogBox);
  const auto bench = [&](const std::string& scale, const std::string& shape, const std::string& gridded) {
    return radiances(
        {.materials = fmt::format(
             R"("fog": {{"medium": {{"scattering_per_m": {{"scale": {0}, "of": {1}}}, "absorption_per_m": {0}, "phase": "rayleigh"{2}}}}})",
             scale, kColoured, gridded),
         .shapes = shape,
         .lights = R"({"sphere": {"center": [3, 0, 3], "radius": 1}, "emission": {"spectrum": 100}})",
         .fov_deg = 20,
         .samples = 4096});
  };
  const auto even = bench("1", box, "");
  const auto gridded = bench("0.5", ball("fog", 2), ", " + grid.json());
  for (std::size_t i = 0; i < even.size(); ++i) {
    const double error = std::hypot(even[i].error, gridded[i].error);
    EXPECT_LT(error, 0.05 * even[i].value);
    EXPECT_NEAR(even[i].value, gridded[i].value, kLargestZ * error) << i;
  }
}

// The density integrated along all of a ray [m], which is given in the scene file's coordinates.
double column_along(const Scene& scene, const Imath::V3d& within, const Imath::V3d& direction, float time) {
  const Imath::V3f at(within - scene.origin_m);
  const MediumStack inside = enclosing_media(scene, at, time);
  EXPECT_FALSE(inside.empty());
  const MediumAt medium = medium_at(scene, inside, SampledSpectrum(550));
  constexpr float kFar = 100;
  const Imath::V3f along(direction);
  constexpr float kForever = std::numeric_limits<float>::infinity();
  return static_cast<double>(medium.march(ray_at(at - along * kFar, along, time), kForever, kForever).column);
}

// A density of 1 + x in a box of half-width 1, wherever a box of an object or of the scene is placed.
TEST(Media, AGridMovesWithWhatHoldsIt) {
  const GridFile grid({0, 2, 0, 2, 0, 2, 0, 2}, {2, 2, 2});
  const Scene scene = test::load_text(fmt::format(
      R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 1}}, "from": [0, -5, 0], "to": [0, 0, 0], "up": [0, 0, 1]}},
      "sensor": {{"resolution": [4, 4], "channels": {{"all": 1}}}},
      "materials": {{"fog": {{"medium": {{"absorption_per_m": 1, {1}}}}}}},
      "objects": {{"cloud": {{"shapes": [{{{0}}}]}}}},
      "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
      "shapes": [{{{0}}}, {{"instance": {{"of": "cloud", "transform": {{"translate": [5, 0, 0]}}}}}},
        {{"instance": {{"of": "cloud", "transform": {{"scale": 2, "rotate": {{"axis": [0, 0, 1], "deg": 90}}, "translate": [-9, 0, 0]}}}}}},
        {{{0}, "motion": {{"keyframes": [{{"time_s": 0, "translate": [0, 9, 0]}}]}}}},
        {{"instance": {{"of": "cloud"}}, "motion": {{"keyframes": [{{"time_s": 0, "translate": [0, -9, 0]}}, {{"time_s": 1, "translate": [0, -9, 4]}}]}}}}],
      "render": {{}}}})",
      kFogBox, grid.json()));
  const auto column = [&](const Imath::V3d& within, const Imath::V3d& direction, float time = 0) {
    return column_along(scene, within, direction, time);
  };
  EXPECT_NEAR(column({0.5, 0, 0}, {1, 0, 0}), 2, 1e-5) << "of the scene";
  EXPECT_NEAR(column({5.5, 0, 0}, {0, 1, 0}), 3, 1e-5) << "translated";
  EXPECT_NEAR(column({4.5, 0, 0}, {0, 0, 1}), 1, 1e-5) << "translated";
  EXPECT_NEAR(column({-9, 1, 0}, {1, 0, 0}), 6, 1e-5) << "turned and scaled";
  EXPECT_NEAR(column({-9, -1, 0}, {0, 0, -1}), 2, 1e-5) << "turned and scaled";
  EXPECT_NEAR(column({0.5, 9, 0}, {0, 0, 1}), 3, 1e-5) << "in a pose";
  EXPECT_NEAR(column({0.5, -9, 2}, {0, 1, 0}, 0.5F), 3, 1e-5) << "in motion";
}

}  // namespace
}  // namespace abbe
