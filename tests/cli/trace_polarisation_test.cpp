// Polarisation in `abbe trace`, compared with chained Fresnel amplitudes and textbook elements.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/rays.h"
#include "materials/interface/fresnel.h"
#include "sampling/angle.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"
#include "tests/materials/fresnel_amplitudes.h"
#include "transport/path/ray_trace.h"

namespace abbe::test {
namespace {

using Imath::V3d;
constexpr double kDLineNm = 587.5618;

json traced(const std::string& scene, const V3d& origin, const V3d& direction,
            const StokesVector& stokes = {1, 0, 0, 0}, Follow follow = Follow::refraction) {
  cli::TraceOptions options{scratch().write("polarised.json", scene), kDLineNm, origin, direction};
  options.stokes = stokes;
  options.follow = follow;
  return json_output(cli::trace, options);
}
double number(const json& value) {
  return value.get<double>();
}
// Thin sheets across z, the first at 0 and the others one unit apart below it. The axis u is along x.
std::string sheets(const std::vector<std::string>& materials) {
  std::string matter;
  std::string shapes;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::string name = fmt::format("\"m{}\"", i);
    matter += (i > 0 ? "," : "") + name + ": " + materials[i];
    shapes += fmt::format(
        R"({}{{"name": {}, "quad": {{"corner": [-5,-5,{}], "edge_u": [10,0,0], "edge_v": [0,10,0]}}, "material": {}}})",
        i > 0 ? "," : "", name, -static_cast<double>(i), name);
  }
  return scene_text(matter, shapes);
}
const V3d kAbove(0, 0, 1);
const V3d kDown(0, 0, -1);
// The first axis of light along z is x.

// Both faces of a prism transmit s and p separately. The product of their means would be smaller.
TEST(TracePolarisation, OfAPrismIsThatOfBothFacesInTurn) {
  const double elevation = 20 * kDegree;
  const V3d direction(std::cos(elevation), 0, std::sin(elevation));
  const V3d origin = V3d(-7.5, 1.25, 4.330127018922193) - 100.0 * direction;
  const json found = traced(prism_scene(), origin, direction);
  double s = 1;
  double p = 1;
  for (int i = 0; i < 2; ++i) {
    s *= 1 - number(found["events"][i]["Rs"]);
    p *= 1 - number(found["events"][i]["Rp"]);
  }
  const json shares = traced(prism_scene(), origin, direction, {1, 0, 0, 0}, Follow::both);
  const double glass = number(shares["events"][1]["share"]) / number(shares["events"][0]["T"]);
  EXPECT_NEAR(glass, 0.997, 1e-3) << "which takes its share between the faces";
  EXPECT_NEAR(number(found["mueller"][0][0]), glass * (s + p) / 2, 1e-9);
  EXPECT_NEAR(number(found["stokes"][0]), glass * (s + p) / 2, 1e-9);
  EXPECT_NEAR(number(found["stokes"][1]), glass * (s - p) / 2, 1e-9) << "the first axis is across the plane";
  EXPECT_NEAR(number(shares["events"][2]["share"]), glass * (s + p) / 2, 1e-9);
  EXPECT_NEAR(std::abs(number(found["first_axis"][1])), 1, 1e-12);
  EXPECT_NEAR(std::abs(number(found["last_axis"][1])), 1, 1e-12);
  const double first = (1 - number(found["events"][0]["Rs"]) + 1 - number(found["events"][0]["Rp"])) / 2;
  EXPECT_NEAR(number(found["events"][0]["mueller"][0][0]), first, 1e-12);
  EXPECT_NEAR(number(found["events"][0]["stokes"][0]), first, 1e-12);
  const json s_alone = traced(prism_scene(), origin, direction, {1, 1, 0, 0});
  EXPECT_NEAR(number(s_alone["stokes"][0]), glass * s, 1e-9);
  const json p_alone = traced(prism_scene(), origin, direction, {1, -1, 0, 0}, Follow::both);
  EXPECT_NEAR(number(p_alone["events"][2]["share"]), glass * p, 1e-9);
  EXPECT_NEAR(number(p_alone["events"][0]["T"]), 1 - number(found["events"][0]["Rp"]), 1e-9);
}

// Fresnel rhomb: glass of index 1.51, cut so that light is totally reflected twice inside at 54 degrees 37
// minutes [Born1999, sec. 1.5.4].
TEST(TracePolarisation, OfFresnelsRhombIsAQuarterWave) {
  const double angle = (54 + 37 / 60.0) * kDegree;
  const V3d along(std::sin(angle), 0, -std::cos(angle));
  Scene scene{};
  scene.materials.push_back({"glass", DielectricMaterial{"constant", RefractiveIndex(1.51)}});
  scene.shapes.push_back({"below", Quad{{-50, -5, 0}, {0, 10, 0}, {100, 0, 0}}, 0});
  scene.shapes.push_back({"above", Quad{{-50, -5, 1}, {100, 0, 0}, {0, 10, 0}}, 0});
  scene.commit();
  const RayTrace trace = trace_ray(scene, {V3d(0, 0, 0.5), along}, kDLineNm, 2);
  ASSERT_EQ(trace.events.size(), 2U);
  for (const TraceEvent& event : trace.events) EXPECT_EQ(event.kind, TraceEvent::Kind::total_reflection);
  const auto& m = trace.polarisation.mueller.rows;
  EXPECT_NEAR(std::atan2(m[3][2], m[2][2]), std::numbers::pi / 2, 1e-3);
  EXPECT_NEAR(m[0][0], 1, 1e-12);
  EXPECT_NEAR(m[1][1], 1, 1e-12);
}

TEST(TracePolarisation, OfPolarisersIsMalusLaw) {
  const std::string upright = R"({"polariser": {"angle_deg": 90}})";
  const std::string turned = R"({"polariser": {"angle_deg": 60}})";
  const json found = traced(sheets({upright, turned}), kAbove, kDown);
  EXPECT_NEAR(number(found["stokes"][0]), 0.5 * 0.75, 1e-12);
  EXPECT_NEAR(std::abs(number(found["last_axis"][0])), 0.5, 1e-6);
  EXPECT_NEAR(std::abs(number(found["last_axis"][1])), std::sqrt(0.75), 1e-6);
  const json back = traced(sheets({upright, turned}), V3d(0, 0, -3), V3d(0, 0, 1));
  EXPECT_NEAR(number(back["stokes"][0]), 0.5 * 0.75, 1e-12);
}

// A quarter-wave plate at 45 degrees makes horizontal light circular. A second one makes it linear again, and
// crossed.
TEST(TracePolarisation, OfWavePlatesIsCircularAndBack) {
  const std::string quarter = R"({"wave_plate": {"retardance_deg": 90, "angle_deg": 45}})";
  const json once = traced(sheets({quarter}), kAbove, kDown, {1, 1, 0, 0});
  // The axes are y = k x f, with f the fast axis. With k downwards y leans to +x: light along x has U > 0
  // there, and a quarter wave makes V < 0. From below, y leans to -x.
  EXPECT_NEAR(number(once["stokes"][3]), -1, 1e-12);
  const json from_below = traced(sheets({quarter}), -kAbove, -kDown, {1, 1, 0, 0});
  EXPECT_NEAR(number(from_below["stokes"][3]), 1, 1e-12);
  const json twice = traced(sheets({quarter, quarter, R"({"polariser": {}})"}), kAbove, kDown, {1, 1, 0, 0});
  EXPECT_NEAR(number(twice["stokes"][0]), 0, 1e-12);
}

TEST(TracePolarisation, IsLostInDepolarisers) {
  const json found = traced(
      sheets({R"({"polariser": {}})", R"({"depolariser": {}})", R"({"polariser": {"angle_deg": 90}})"}),
      kAbove, kDown);
  EXPECT_NEAR(number(found["stokes"][0]), 0.25, 1e-12);
}

TEST(TracePolarisation, OfMetalsHasTheirPhases) {
  const json found =
      traced(sheets({R"({"conductor": {"ior": {"n": 0.2, "k": 3}}})"}), V3d(-1, 0, 1), V3d(1, 0, -1));
  const FresnelAmplitudes f = fresnel_amplitudes(std::sqrt(0.5), {0.2, 3});
  const auto sp = f.rs * std::conj(f.rp);
  EXPECT_NEAR(number(found["mueller"][2][2]), sp.real(), 1e-9);
  EXPECT_NEAR(number(found["mueller"][3][2]), sp.imag(), 1e-9);
  EXPECT_NEAR(number(found["mueller"][0][1]), (std::norm(f.rs) - std::norm(f.rp)) / 2, 1e-9);
}

}  // namespace
}  // namespace abbe::test
