#include <algorithm>
#include <vector>

#include "materials/interface/snell.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

namespace abbe {
namespace {

using Imath::V3d;

// From the middle of the slit of `prism.json`, or into that of `sunlit_prism.json`, along the axis of the
// beam.
BasicRay<double> axis_of(const Scene& scene) {
  if (const auto* beam = std::get_if<DirectionalLight>(&scene.lights[0].kind))
    return {V3d(-0.020055575, 0, -0.0038770365) - scene.origin_m, -V3d(beam->towards)};
  const auto& light = std::get<Quad>(scene.shapes[std::get<AreaLight>(scene.lights[0].kind).shape].shape);
  return {light.corner + (light.edge_u + light.edge_v) / 2, light.edge_u.cross(light.edge_v).normalized()};
}

// Column [pixels] at which the film shows the chief ray of a wavelength: the axis of the beam through the
// prism and the screen's plane, then the lens's centre.
double chief_column(const Scene& scene, double lambda_nm) {
  BasicRay<double> ray = axis_of(scene);
  const auto prism = std::find_if(scene.shapes.begin(), scene.shapes.end(),
                                  [](const ShapeInstance& s) { return s.name == "prism"; });
  const double n = interior_index(scene.materials[prism->material])->n(lambda_nm);
  for (int event = 0; event < 3; ++event) {
    const auto hit = intersect_exact(scene, ray, 1e-9);
    const V3d& normal = hit->hit.normal;
    if (event == 2) {
      const CameraConnection c =
          *sample_towards(scene.camera, Imath::V3f(hit->hit.point), {0.5F, 0.5F}, SampledSpectrum(550), 0);
      return c.film.x;
    }
    const bool entering = normal.dot(ray.direction) < 0;
    ray = {hit->hit.point, *refract(-ray.direction, entering ? normal : -normal, entering ? n : 1 / n)};
  }
  return 0;
}

// Light-weighted mean column of a channel over a window of the film.
double centroid(const Film& film, int channel, int x0, int y0, int x1, int y1) {
  double sum = 0;
  double moment = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const double value = film.mean(static_cast<std::size_t>(y * film.width() + x), channel);
      sum += value;
      moment += value * (x + 0.5);
    }
  return moment / sum;
}
double centroid(const Film& film, int channel) {
  return centroid(film, channel, 0, 0, film.width(), film.height());
}

struct Line {
  const char* name;
  double nm;
};
// By day the outermost.
const auto kLines = test::by_night<std::vector<Line>>(
    {{"C", 656.2725}, {"d", 587.5618}, {"F", 486.1327}, {"g", 435.8343}}, {{"C", 656.2725}, {"g", 435.8343}});

TEST(Prism, FraunhoferLinesFallWhereTheSellmeierFormulaPutsThem) {
  for (const Line& line : kLines) {
    const std::string emission = "{\"lines\": [{\"nm\": " + std::to_string(line.nm) +
                                 ", \"width_nm\": 0.01, \"power\": 1}], \"radiant_flux_W\": 1}";
    const Scene scene =
        test::load("prism.json", {{"/lights/0/emission", emission}, {"/render/samples", "3"}});
    const int channel = line.nm > 600 ? 0 : line.nm > 500 ? 1 : 2;
    const double expected = chief_column(scene, line.nm);
    const auto middle = static_cast<int>(expected);
    // Rays inclined to the prism's principal plane are deviated more and bend the line, so only its middle is
    // looked at: 16 rows of the 200 it is long, and 40 columns to each side of the 15 it is wide.
    const Film film = render(scene, {}).film;
    const double column =
        centroid(film, channel, middle - 40, film.height() / 2 - 8, middle + 40, film.height() / 2 + 8);
    EXPECT_NEAR(column, expected, 0.1) << line.name;
  }
}

TEST(Prism, FraunhoferLinesOfAParallelSunbeamFallThereToo) {
  for (const Line& line : kLines) {
    const Scene scene = test::load(
        "sunlit_prism.json",
        {{"/lights/0",
          R"({"directional": {"towards": [-238.555886, 0, -155.936158]}, "emission": {"lines": [{"nm": )" +
              std::to_string(line.nm) + R"(, "width_nm": 0.01, "power": 1}], "irradiance": 1}})"},
         {"/sensor/observer", "\"1931\""},
         {"/render/samples", "2"}});
    const double expected = chief_column(scene, line.nm);
    const auto middle = static_cast<int>(expected);
    const Film film = render(scene, {}).film;
    const double column =
        centroid(film, 1, middle - 20, film.height() / 2 - 6, middle + 20, film.height() / 2 + 6);
    EXPECT_NEAR(column, expected, 0.1) << line.name;
  }
}

TEST(Prism, BandpassBlocksEndWhereTheirBandsEnd) {
  const Scene scene = test::load("prism.json", {{"/render/samples", "12"}});
  const Film film = render(scene, {}).film;
  // Where the column means of two neighbouring blocks cross, against the chief ray of the limit they share;
  // the image of the slit blurs both edges over its width.
  const auto profile = [&film](int channel) {
    std::vector<double> columns(static_cast<std::size_t>(film.width()));
    for (int x = 0; x < film.width(); ++x)
      columns[static_cast<std::size_t>(x)] =
          test::region(film, channel, x, film.height() / 2 - 20, x + 1, film.height() / 2 + 20).mean;
    return columns;
  };
  // Half of the width at half height of a line: the plate's 0.4 mm slit seen from the lamp, 0.87 mm on the
  // screen.
  const double half_slit = 0.5 * 7.7;
  const auto crossing = [](const std::vector<double>& a, const std::vector<double>& b, double near) {
    // Where the left block's column falls below the right block's one, within reach of the expected boundary.
    for (auto x = static_cast<std::size_t>(near - 40); x < static_cast<std::size_t>(near + 40); ++x)
      if (a[x] < b[x]) return static_cast<double>(x);
    return -1.0;
  };
  const double blue_green = chief_column(scene, 500);
  const double green_red = chief_column(scene, 600);
  EXPECT_NEAR(crossing(profile(2), profile(1), blue_green), blue_green, 0.1 + half_slit);
  EXPECT_NEAR(crossing(profile(1), profile(0), green_red), green_red, 0.1 + half_slit);
}

TEST(Prism, ColoursStandInOrder) {
  const Scene scene = test::load("prism.json", {{"/render/samples", "2"}});
  const Film film = render(scene, {}).film;
  const double red = centroid(film, 0);
  const double green = centroid(film, 1);
  const double blue = centroid(film, 2);
  // Red is deviated least and lies to the right.
  EXPECT_GT(red, green + 40);
  EXPECT_GT(green, blue + 80);
}

}  // namespace
}  // namespace abbe
