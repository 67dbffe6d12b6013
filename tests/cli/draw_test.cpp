#include <cmath>
#include <numbers>
#include <regex>

#include <gtest/gtest.h>

#include "cli/query.h"
#include "cli/rays.h"
#include "description/load.h"
#include "io/data_directory.h"
#include "report/layout.h"
#include "report/light_rays.h"
#include "scene/shapes/shape.h"
#include "tests/angles.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"
#include "transport/path/ray_trace.h"

namespace abbe::test {
namespace {

using Imath::V3d;
constexpr DrawingPlane kElevation{{1, 0, 0}, {0, 0, 1}};

Scene loaded(const std::string& text) {
  Diagnostics diagnostics;
  auto scene = load_scene(scratch().write("draw.json", text), {}, diagnostics);
  if (!scene) throw Error(ErrorCode::scene, "draw.json", diagnostics.text());
  return *std::move(scene);
}

// Scene of the prism with these lights instead of its environment.
std::string prism_with(const std::string& lights) {
  const std::string text = prism_scene();
  const std::size_t begin = text.find(R"("lights": [)") + 11;
  return text.substr(0, begin) + lights + text.substr(text.find("],\n  \"shapes\""));
}

// Ray through the prism at an angle of incidence, in the coordinates of the scene file [mm].
struct Across {
  V3d origin, direction;
};
Across across_prism(double incidence_deg) {
  const double elevation = (incidence_deg - 30) * kDegree;
  const V3d direction(std::cos(elevation), 0, std::sin(elevation));
  return {V3d(-7.5, 1.25, 4.330127018922193) - 60.0 * direction, direction};
}

// Lines that `abbe draw` draws for a ray.
std::vector<DrawnRay> drawn(const Scene& scene, const BasicRay<double>& ray, double nm, Follow follow) {
  return drawn_rays(scene, follow_ray(scene, ray, nm, follow, {.min_power_fraction = kMinDrawnFraction}), nm);
}

struct Line {
  double nm, x0, y0, x1, y1;
  std::string color;
};
std::vector<Line> rays_in(const std::string& svg) {
  static const std::regex kRay(
      R"re(<line x1="([-\d.]+)" y1="([-\d.]+)" x2="([-\d.]+)" y2="([-\d.]+)" class="ray" data-nm="(\d+\.?\d*)" stroke="(#\w+)")re");
  std::vector<Line> lines;
  for (std::sregex_iterator at(svg.begin(), svg.end(), kRay), end; at != end; ++at)
    lines.push_back({std::stod((*at)[5]), std::stod((*at)[1]), std::stod((*at)[2]), std::stod((*at)[3]),
                     std::stod((*at)[4]), (*at)[6]});
  return lines;
}

TEST(Draw, RaysLeaveAPrismAtTheDeviationOfItsFormula) {
  const Scene scene = loaded(prism_scene());
  const auto [origin, direction] = across_prism(50);
  for (const double nm : {486.1327, 587.5618, 656.2725}) {
    const DrawnRay ray =
        drawn(scene, {origin * scene.unit_m - scene.origin_m, direction}, nm, Follow::refraction).at(0);
    ASSERT_EQ(ray.points.size(), 4U);
    const double deviation = json_output(cli::query_prism, {"N-BK7", 60, {nm}, 50})["deviation_deg"];
    EXPECT_NEAR(angle_deg(ray.points[1] - ray.points[0], ray.points[3] - ray.points[2]), deviation, 1e-9)
        << nm;
  }
}

// All views have the same pixels per length, so that angles are true.
TEST(Draw, TheDrawingShowsThatDeviationInTheWavelengthsColour) {
  const auto [origin, direction] = across_prism(50);
  const auto path = scratch() / "prism.svg";
  ASSERT_NO_THROW(cli::draw(
      {scratch().write("draw.json", prism_scene()), path, {486.1327, 656.2725}, origin, direction}));
  const std::vector<Line> lines = rays_in(read_file(path));
  ASSERT_EQ(lines.size(), 12U);  // three segments of two rays in two views
  for (const std::size_t first : {6U, 9U}) {
    const Line& in = lines[first];
    const Line& out = lines[first + 2];
    const double turn =
        (std::atan2(out.y1 - out.y0, out.x1 - out.x0) - std::atan2(in.y1 - in.y0, in.x1 - in.x0)) / kDegree;
    EXPECT_NEAR(
        turn, json_output(cli::query_prism, {"N-BK7", 60, {in.nm}, 50})["deviation_deg"].get<double>(), 0.05);
  }
  EXPECT_EQ(wavelength_color(656.2725), lines[9].color);
  EXPECT_EQ(wavelength_color(650).substr(0, 3), "#ff");
  EXPECT_EQ(wavelength_color(450).substr(5), "ff");
  EXPECT_EQ(wavelength_color(1000), "#909090");
  const std::string svg = read_file(path);
  for (const char* there :
       {">prism<", ">camera<", "class=\"field\"", " mm<", "Plan (x, y)", "Elevation (x, z)"})
    EXPECT_NE(svg.find(there), std::string::npos) << there;
}

// d sin(angle) (1 - cos(angle) / (n cos(angle within))) [Born & Wolf].
TEST(Draw, ASlabShiftsRays) {
  constexpr double kThickness = 0.01;
  constexpr double kIndex = 1.5;
  Mesh box;
  for (int i = 0; i < 8; ++i)
    box.vertices.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? kThickness : 0);
  box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  EXPECT_EQ(outline(box, kElevation).size(), 12U);  // edges without the diagonals
  Scene scene{};
  scene.materials.push_back({"glass", DielectricMaterial{"constant", RefractiveIndex(kIndex)}});
  scene.shapes.push_back({"slab", box, 0});
  scene.commit();
  const double angle = 40 * kDegree;
  const V3d direction(std::sin(angle), 0, std::cos(angle));
  const DrawnRay ray =
      drawn(scene, {V3d(0, 0, 0) - 0.5 * direction, direction}, 550, Follow::refraction).at(0);
  ASSERT_EQ(ray.points.size(), 4U);
  EXPECT_NEAR((ray.points[3] - ray.points[2]).normalized().dot(direction), 1, 1e-12);
  const double inside = std::asin(std::sin(angle) / kIndex);
  EXPECT_NEAR((ray.points[2] - ray.points[0]).cross(direction).length(),
              kThickness * std::sin(angle) * (1 - std::cos(angle) / (kIndex * std::cos(inside))), 1e-12);
}

TEST(Draw, BranchesAreFainterTheLessTheyAre) {
  const auto [origin, direction] = across_prism(50);
  cli::DrawOptions options{
      scratch().write("draw.json", prism_scene()), scratch() / "both.svg", {550}, origin, direction};
  options.follow = Follow::both;
  ASSERT_NO_THROW(cli::draw(options));
  const std::string svg = read_file(options.output);
  EXPECT_NE(svg.find("stroke-opacity=\"0.8\""), std::string::npos);
  const std::size_t lines = rays_in(svg).size();
  EXPECT_GT(lines, 6U);  // more than the three segments of the main branch in two views
  const auto rays = drawn(loaded(prism_scene()), {V3d(-0.06, 0, 0), {1, 0, 0.1}}, 550, Follow::both);
  for (const DrawnRay& ray : rays) EXPECT_GE(ray.power_fraction, kMinDrawnFraction);
  EXPECT_LT(rays.back().power_fraction, 0.1);
}

// The table of N-SF66 starts at 390 nm.
TEST(Draw, AnIndexBeyondItsDataIsTold) {
  const auto [origin, direction] = across_prism(50);
  std::string scene = prism_scene();
  scene.replace(scene.find("N-BK7"), 5, "N-SF66");
  const std::string all = R"("observer": "1931")";
  scene.replace(scene.find(all), all.size(), R"("channels": {"a": {"band": [400, 700]}})");
  const auto said = [&](double nm) {
    testing::internal::CaptureStderr();
    EXPECT_NO_THROW(cli::draw(
        {scratch().write("held.json", scene), scratch() / "held.svg", {550, nm}, origin, direction}));
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(said(450), "");
  const std::string held = said(320);
  EXPECT_NE(held.find("warning: the index of material \"glass\" is extrapolated from the end of its data, "
                      "[390, 2500] nm"),
            std::string::npos)
      << held;
}

TEST(Draw, RoundShapesHaveTheirCircumference) {
  const auto circle = outline(Sphere{{1, 2, 3}, 0.5}, kElevation);
  for (const V3d& p : circle.front()) EXPECT_NEAR(std::hypot(p.x - 1, p.z - 3), 0.5, 1e-12);
  // A sphere sheared by x + y appears as an ellipse along y.
  Imath::M44d sheared;
  sheared[1][0] = 1;
  const Shape placed = PlacedShape{make_prototype(Sphere{{0, 0, 0}, 1}),
                                   std::make_shared<const Placement>(Placement{sheared, sheared.inverse()})};
  double widest = 0;
  const auto ellipse = outline(placed, kElevation);
  for (const V3d& p : ellipse.front()) {
    EXPECT_NEAR(p.x * p.x / 2 + p.z * p.z, 1, 1e-12);
    widest = std::max(widest, p.x);
  }
  EXPECT_NEAR(widest, std::numbers::sqrt2, 1e-12);
}

TEST(Draw, LampsSendTheirRaysWhereTheyLight) {
  const Scene scene = loaded(prism_with(
      R"({"name": "spot", "spot": {"at": [-100, 0, 0], "direction": [1, 0, 0], "half_angle_deg": 5}, "emission": {"illuminant": "A", "radiant_flux_W": 1}},
         {"name": "lamp", "quad": {"corner": [-50, -1, -1], "edge_u": [0, 2, 0], "edge_v": [0, 0, 2]}, "emission": {"illuminant": "A", "radiant_flux_W": 1}},
         {"name": "sky", "environment": {}, "emission": {"illuminant": "D65", "radiance": 1}},
         {"name": "beam", "directional": {"towards": [0, 0, 1], "irradiance": 1}})"));
  const Light& spot = light_named(scene, "spot", "--from-light");
  const auto rays = light_rays(scene, spot, 5);
  ASSERT_EQ(rays.size(), 10U);
  EXPECT_NEAR(angle_deg(rays.front().direction, {1, 0, 0}), 5, 1e-5);
  EXPECT_NEAR(angle_deg(rays[2].direction, {1, 0, 0}), 0, 1e-5);
  for (const auto& ray : light_rays(scene, light_named(scene, "lamp", ""), 3))
    EXPECT_GT(ray.direction.x, 0.49);
  for (const auto& ray : light_rays(scene, light_named(scene, "beam", ""), 3))
    EXPECT_EQ(ray.direction, V3d(0, 0, -1));
  EXPECT_TRUE(light_rays(scene, light_named(scene, "sky", ""), 3).empty());
  EXPECT_EQ(fault([&] { (void)light_named(scene, "sun", "--from-light"); },
                  "--from-light: no such light (got \"sun\", allowed spot, lamp, sky, beam)"),
            ErrorCode::usage);
}

TEST(Draw, WhatIsFarLeavesNoTrace) {
  const std::string near =
      R"({"name": "near", "point": {"at": [-100, 0, 30]}, "emission": {"illuminant": "A", "luminous_intensity": 1}})";
  const auto drawing = [](const std::string& lights) {
    const auto path = scratch() / "far.svg";
    EXPECT_NO_THROW(cli::draw({scratch().write("draw.json", prism_with(lights)), path, {550}, {}}));
    return read_file(path);
  };
  const std::string expected = drawing(near);
  EXPECT_FALSE(rays_in(expected).empty());
  for (
      const char* far :
      {R"({"name": "far", "point": {"at": [0, 1e12, 0]}, "emission": {"illuminant": "A", "luminous_intensity": 1}})",
       R"({"name": "far", "spot": {"at": [-1e12, 0, 0], "direction": [1, 0, 0], "half_angle_deg": 5}, "emission": {"illuminant": "A", "radiant_flux_W": 1}})",
       R"({"name": "far", "quad": {"corner": [-1e12, -1, -1], "edge_u": [0, 2, 0], "edge_v": [0, 0, 2]}, "emission": {"illuminant": "A", "radiant_flux_W": 1}})"})
    EXPECT_TRUE(drawing(near + ", " + far) == expected) << far;
}

TEST(Draw, ACameraAloneStandsInARoomOfAMetre) {
  const std::string alone =
      R"({"abbe": 1, "camera": {"pinhole": {"fov_deg": 40}, "from": [0, 0, 5], "to": [0, 0, 0], "up": [0, 1, 0]},
          "sensor": {"resolution": [8, 8], "observer": "1931"}, "lights": [)";
  for (const std::string light :
       {R"({"name": "sun", "directional": {"towards": [1, 0, 0], "irradiance": 1}})",
        R"({"name": "sky", "environment": {}, "emission": {"illuminant": "D65", "luminance": 3}})", ""}) {
    const auto path = scratch() / "alone.svg";
    ASSERT_NO_THROW(cli::draw({scratch().write("draw.json", alone + light + "]}"), path, {550}, {}}))
        << light;
    const std::string svg = read_file(path);
    EXPECT_NE(svg.find(">0.5 m<"), std::string::npos) << svg;
    EXPECT_NE(svg.find("class=\"field\""), std::string::npos) << svg;
    EXPECT_EQ(rays_in(svg).empty(), light.find("sun") == std::string::npos) << svg;
  }
}

TEST(TraceFromLight, StartsOnTheSurfaceInDouble) {
  const std::string emission = R"("emission": {"illuminant": "A", "radiant_flux_W": 1}})";
  const Scene scene = loaded(prism_with(
      R"({"name": "quad", "quad": {"corner": [-50.1, -1.3, -0.7], "edge_u": [0, 2.2, 0], "edge_v": [0, 0, 1.9]}, )" +
      emission +
      R"(, {"name": "disc", "disc": {"center": [-40.3, 0.1, 0.7], "normal": [1, 2, 3], "radius": 0.3}, )" +
      emission + R"(, {"name": "ball", "sphere": {"center": [-30.7, 0.1, 5.3], "radius": 0.37}, )" +
      emission));
  const auto start = [&scene](const std::string& name) {
    const V3d origin = central_ray(scene, light_named(scene, name, "")).value().origin;
    return (origin + scene.origin_m) / scene.unit_m;  // in the file's millimetres
  };
  EXPECT_LT((start("quad") - V3d(-50.1, -0.2, 0.25)).length(), 1e-9);
  EXPECT_LT((start("disc") - V3d(-40.3, 0.1, 0.7)).length(), 1e-9);
  EXPECT_NEAR((start("ball") - V3d(-30.7, 0.1, 5.3)).length(), 0.37, 1e-9);
}

TEST(TraceFromLight, StartsInTheMiddleOfWhatItLights) {
  const auto scene = scratch().write(
      "lit.json",
      prism_with(
          R"({"name": "lamp", "quad": {"corner": [-50, -1, -1], "edge_u": [0, 2, 0], "edge_v": [0, 0, 2]}, "emission": {"illuminant": "A", "radiant_flux_W": 1}},
             {"name": "sky", "environment": {}, "emission": {"illuminant": "D65", "radiance": 1}})"));
  cli::TraceOptions options{scene, 587.5618, {}, {}};
  options.light = "lamp";
  const json found = json_output(cli::trace, options);
  ASSERT_EQ(found["events"].size(), 3U);
  EXPECT_EQ(found["events"][0]["shape"], "prism");
  EXPECT_NEAR(found["events"][0]["angle_in_deg"].get<double>(), 30, 1e-5);
  // The rays of a lamp must not hit the lamp itself, even if floats do not represent its position exactly.
  cli::TraceOptions cornell{data_directory() / "scenes" / "cornell.json", 550, {}, {}};
  cornell.light = "lamp";
  EXPECT_NE(json_output(cli::trace, cornell)["events"][0]["shape"], "lamp");
  options.direction = V3d(-1, 0, 0);
  EXPECT_EQ(json_output(cli::trace, options)["events"][0]["kind"], "hit");  // the lamp itself
  options.light = "sky";
  options.direction = {};
  EXPECT_EQ(fault([&] { (void)cli::trace(options); }, "no central ray"), ErrorCode::usage);
  options.light = "";
  EXPECT_EQ(fault([&] { (void)cli::trace(options); }, "needs --origin and --dir"), ErrorCode::usage);
}

}  // namespace
}  // namespace abbe::test
