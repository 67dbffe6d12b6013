#include "lens/iris.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>

#include <fmt/format.h>

#include "scene/camera/lens_optics.h"
#include "tests/angles.h"
#include "tests/scenes/scene_fixture.h"

// Pictures through the blades of a stop, of an ideal and of a real lens.

namespace abbe {
namespace {

using ComplexDouble = std::complex<double>;

const std::string kThin = R"("thin_lens": {"focal_length": 0.1, "f_number": 8, "focus_distance": 2)";
const std::string kReal = R"("lens_system": {"prescription": "achromat", "f_number": 8, "focus_distance": 2)";

std::string with_blades(const std::string& lens, int blades, double rotation_deg = 0) {
  return blades == 0
             ? lens + "}"
             : fmt::format(R"({}, "blades": {}, "blade_rotation_deg": {}}})", lens, blades, rotation_deg);
}

double share_of(int blades) {
  return blades / (2 * kPi) * std::sin(2 * kPi / blades);
}

Film even_field(const std::string& lens) {
  return render(test::load_text(R"({"abbe": 1, "camera": {)" + lens +
                                R"(, "from": [0, 0, 0], "to": [0, 2, 0], "up": [0, 0, 1]},
    "sensor": {"resolution": [4, 4], "pixel_pitch_um": 50, "channels": {"all": {"band": [545, 555]}}},
    "lights": [{"environment": {}, "emission": {"spectrum": 1}}],
    "render": {"integrator": "path", "samples": 16384}})"),
                {})
      .film;
}

TEST(Iris, TakesItsShareOfAnEvenField) {
  for (const std::string& lens : {kThin, kReal}) {
    const test::Region round = test::region(even_field(with_blades(lens, 0)), 0, 0, 0, 4, 4);
    for (const int blades : {5, 8}) {
      const test::Region some = test::region(even_field(with_blades(lens, blades, 20)), 0, 0, 0, 4, 4);
      const double ratio = some.mean / round.mean;
      const double deviation = std::sqrt(some.variance + round.variance) / round.mean;
      std::printf("%d blades: %.5f of the round one's, %.5f of the circle, deviation %.5f\n", blades, ratio,
                  share_of(blades), deviation);
      // The rim sees the scene at a slant of 6.25 mm over 2 m, 1e-5 of cosines that the blades take away.
      EXPECT_NEAR(ratio, share_of(blades), 5 * deviation + 1e-5);
    }
  }
}

// A small white disc that lies at the distance before or behind the plane in focus.
std::string speck(const std::string& lens, double distance) {
  const double radius = distance / 10000;
  return fmt::format(
      R"({{"abbe": 1, "camera": {{{}, "from": [0, 0, 0], "to": [0, 2, 0], "up": [0, 0, 1]}},
  "sensor": {{"resolution": [104, 104], "pixel_pitch_um": 12, "channels": {{"all": {{"band": [545, 555]}}}}}},
  "materials": {{"white": {{"diffuse": {{"reflectance": 0.8}}}}}},
  "lights": [{{"spot": {{"at": [0, {}, 0], "direction": [0, 1, 0], "half_angle_deg": 0.6}}, "emission": {{"illuminant": "E", "luminous_intensity": 1000}}}}],
  "shapes": [{{"disc": {{"center": [0, {}, 0], "normal": [0, -1, 0], "radius": {}}}, "material": "white"}}],
  "render": {{"integrator": "light", "samples": 48}}}})",
      lens, distance - 100 * radius, distance, radius);
}

// What a picture has in every pixel, at its place [m] from the middle: x to the right, y up.
struct Spread {
  std::vector<std::pair<ComplexDouble, double>> pixels;

  explicit Spread(const Scene& scene) {
    const Film film = render(scene, {}).film;
    double sum = 0;
    for (int j = 0; j < film.height(); ++j)
      for (int i = 0; i < film.width(); ++i) {
        const ComplexDouble at(i + 0.5 - film.width() / 2.0, film.height() / 2.0 - j - 0.5);
        const double value = film.mean(static_cast<std::size_t>(j * film.width() + i), 0);
        pixels.emplace_back(at * scene.camera.pixel_pitch, value);
        sum += value;
      }
    for (auto& pixel : pixels) pixel.second /= sum;
  }
  template <typename F>
  [[nodiscard]] double mean(F f) const {
    double sum = 0;
    for (const auto& [at, share] : pixels) sum += share * f(at);
    return sum;
  }
  [[nodiscard]] ComplexDouble moment(int order) const {
    ComplexDouble sum = 0;
    for (const auto& [at, share] : pixels) sum += share * std::pow(at, order);
    return sum;
  }
};

// The mean of z^n over a polygon of n corners R exp(i a) is 2 R^n exp(i n a)/((n + 1)(n + 2)): over the
// triangle of 0 and the neighbours p and q it is that of p^j q^(n - j), j from 0 to n, times 2/(n + 2), and
// with q = p exp(2 pi i/n) all of these but one p^n add up to 0. As z^n is harmonic, the disc that the speck
// is imaged to changes nothing of it; lower powers have the mean 0, and of a circle all have.
void expect_polygon(const Spread& seen, int blades, double corner, double radius, double within) {
  const ComplexDouble found = seen.moment(blades) / std::pow(radius, blades);
  const double size = 2.0 / ((blades + 1) * (blades + 2));
  const ComplexDouble expected = std::polar(size, blades * corner);
  std::printf("%d blades: %.5f at %.2f degrees, expected %.5f at %.2f\n", blades, std::abs(found),
              std::arg(found) * 180 / kPi, size, std::arg(expected) * 180 / kPi);
  EXPECT_LT(std::abs(found - expected), within * size) << found << " for " << expected;
  for (int order = 1; order < blades; ++order)
    EXPECT_LT(std::abs(seen.moment(order)) / std::pow(radius, order), 0.01) << order;
  const lens::Iris polygon(blades, 90 - corner * 180 / kPi);
  const double outside = seen.mean([&](const ComplexDouble& z) {
    const ComplexDouble point = 0.95 * z / radius;
    return polygon.contains({point.real(), point.imag()}) ? 0 : 1;
  });
  EXPECT_LT(outside, 0.002);
}

TEST(Iris, BlursASpeckToItsPolygon) {
  const double image_distance = 1 / (1 / 0.1 - 1 / 2.0);
  for (const auto& [blades, rotation] : {std::pair(5, 0.0), {5, 11.0}, {8, 30.0}})
    for (const double distance : {20.0, 0.8}) {
      const double radius = 0.1 / 16 * image_distance * std::abs(1 / 2.0 - 1 / distance);
      // Nearer than the plane in focus it is upside down.
      const double corner = kPi / 2 - rotation * kPi / 180 + (distance < 2 ? kPi : 0);
      const Scene scene = test::load_text(speck(with_blades(kThin, blades, rotation), distance));
      expect_polygon(Spread(scene), blades, corner, radius, 0.05);
    }
}

TEST(Iris, BlursASpeckToItsPolygonThroughARealLens) {
  const Spread round(test::load_text(speck(with_blades(kReal, 0), 20)));
  const double radius = std::sqrt(2 * round.mean([](const ComplexDouble& z) { return std::norm(z); }));
  EXPECT_LT(std::abs(round.moment(5)) / std::pow(radius, 5), 0.002);
  for (const auto& [blades, rotation] : {std::pair(5, 0.0), {5, 11.0}, {8, 30.0}}) {
    const Scene scene = test::load_text(speck(with_blades(kReal, blades, rotation), 20));
    expect_polygon(Spread(scene), blades, kPi / 2 - rotation * kPi / 180, radius, 0.06);
  }
}

// Lamps and matter out of focus behind four blades.
std::string still(const std::string& lens) {
  return R"({"abbe": 1, "camera": {)" + lens +
         R"(, "from": [0, -1.2, 0.5], "to": [0, 0, 0.2], "up": [0, 0, 1]},
  "sensor": {"resolution": [16, 16], "pixel_pitch_um": 1000, "channels": {"all": {"band": [500, 600]}}},
  "materials": {"white": {"diffuse": {"reflectance": 0.7}}, "copper": {"conductor": {"ior": "Cu_Johnson", "roughness": 0.4}}},
  "lights": [{"sphere": {"center": [0.5, -0.3, 0.9], "radius": 0.1}, "emission": {"illuminant": "E", "luminance": 300}},
             {"quad": {"corner": [-0.5, 0.4, 1], "edge_u": [0, 0.3, 0], "edge_v": [0.3, 0.05, 0]}, "emission": {"illuminant": "A", "luminance": 400}}],
  "shapes": [{"quad": {"corner": [-1.5, -1.5, 0], "edge_u": [3, 0, 0], "edge_v": [0, 3, 0]}, "material": "white"},
             {"sphere": {"center": [-0.15, 0, 0.2], "radius": 0.2}, "material": "copper"}],
  "render": {"max_depth": 4}})";
}

TEST(NightlyIris, IsTheSameForEveryTechnique) {
  const std::array lenses{
      with_blades(R"("thin_lens": {"focal_length": 0.05, "f_number": 1, "focus_distance": 0.5)", 4, 10),
      with_blades(R"("lens_system": {"prescription": "achromat", "focus_distance": 0.6)", 4, 10)};
  for (const std::string& lens : lenses) {
    const auto by = [&](const char* integrator, const char* samples) {
      Scene scene =
          test::load_text(still(lens), {{"/render/integrator", integrator}, {"/render/samples", samples}});
      scene.features.light_tracing = true;
      scene.features.light_is_traced.assign(scene.lights.size(), true);
      return render(scene, {}).film;
    };
    const Film path = by("path", "2048");
    const std::pair<const char*, const char*> others[] = {{"light", "1024"}, {"bdpt", "256"}, {"vcm", "96"}};
    for (const auto& [integrator, samples] : others) {
      const test::Comparison c = test::compare_regions(path, by(integrator, samples), 4);
      std::printf("%s: largest z %.2f, ratio of the means %.5f\n", integrator, c.largest_z, c.ratio);
      EXPECT_LT(c.largest_z, 5.5) << integrator;  // 1e-6 over 16 regions x 3 techniques x 2 lenses
      EXPECT_NEAR(c.ratio, 1, 0.02) << integrator;
    }
  }
}

}  // namespace
}  // namespace abbe
