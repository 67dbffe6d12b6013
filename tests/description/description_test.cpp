#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "description.h"
#include "scene/camera/lens_optics.h"
#include "spectral/library.h"
#include "spectral/sources.h"
#include "tests/angles.h"

namespace abbe {
namespace {

using Imath::V3d;
using test::DescriptionTest;
using test::kSquare;
using test::lit;
using test::Loaded;
using test::ply;
using test::shaped;
using test::write;

void expect_near(const V3d& a, const V3d& b, double tolerance = 1e-12) {
  EXPECT_LE((a - b).length(), tolerance) << a << " and " << b;
}

TEST_F(DescriptionTest, ConvertsToMetresAndRecentres) {
  const Loaded loaded = load(R"({"units": "mm",
    "camera": {"pinhole": {"focal_length": 50, "f_number": 8}, "from": [1000, 0, 0], "to": [2000, 0, 0], "up": [0, 0, 2]},
    "materials": {"m": {"diffuse": {"reflectance": 0}}},
    "shapes": [{"sphere": {"center": [2000, 0, 0], "radius": 10}, "material": "m"}],
    "lights": [{"point": {"at": [2000, 0, 100]}, "emission": {"spectrum": 1}}]})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  EXPECT_EQ(loaded->unit_m, 1e-3);
  expect_near(loaded->origin_m, {2, 0, 0});
  const auto& sphere = std::get<Sphere>(loaded->shapes[0].shape);
  expect_near(sphere.center, {0, 0, 0});
  EXPECT_DOUBLE_EQ(sphere.radius, 0.01);
  expect_near(V3d(std::get<PointLight>(loaded->lights[0].kind).position), {0, 0, 0.1}, 1e-8);
  const auto& lens = std::get<Pinhole>(loaded->camera.kind);
  expect_near(lens.frame.position, {-1, 0, 0});
  EXPECT_DOUBLE_EQ(lens.image_distance, 0.05);
  EXPECT_DOUBLE_EQ(lens.aperture_radius, 0.05 / 16);

  const Loaded inches = load(shaped(R"("sphere": {"center": [0, 0, 0], "radius": 2})"), {{"/units", "in"}});
  EXPECT_DOUBLE_EQ(std::get<Sphere>(inches->shapes.at(0).shape).radius, 0.0508);
  const Loaded bench = load(shaped(R"("mesh": "bench.ply")"), {{"/units", "cm"}});
  EXPECT_NEAR(area(bench->shapes.at(0).shape), 1e-4, 1e-10);
}

// Covers short forms of surfaces and glass files. A prescription within the scene needs no file of its own.
TEST_F(DescriptionTest, LensesStandInTheScene) {
  write(folder_ / "own.csv", "# unit: index, nm\nwavelength_nm,n\n300,1.625\n1100,1.625\n");
  const Loaded loaded = load(R"({"camera": {"lens_system": {"prescription": {"title": "mine", "f_number": 8,
    "surfaces": [{"stop": true, "thickness": 2}, [60, 5, "own.csv", 20], [-60, 48]]}, "blades": 6},
    "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]}})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  const lens::System& lens = std::get<LensSystem>(loaded->camera.kind).optics->system.system();
  EXPECT_EQ(lens.title, "mine");
  EXPECT_EQ(lens.surfaces[1].profile.curvature, 1.0 / 60);
  EXPECT_EQ(lens.surfaces[1].behind->index.n(550), 1.625);
  EXPECT_EQ(lens.surfaces[1].semi_aperture_mm, 20);
  EXPECT_FALSE(lens.surfaces[2].behind);
  EXPECT_DOUBLE_EQ(lens.surfaces[0].iris.value().area_fraction(), lens::Iris(6, 0).area_fraction());
  EXPECT_FALSE(lens.surfaces[1].iris);
}

TEST_F(DescriptionTest, PlacesCameras) {
  const auto lens = [&](const std::string& camera) {
    const Loaded loaded = load(fmt::format(
        R"({{"camera": {{{}, "from": [0, -3, 0], "to": [0, 0, 4], "up": [0, 0, 1]}}, "sensor": {{"resolution": [300, 200],
             "pixel_pitch_um": 10, "observer": "1931"}}}})",
        camera));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    return loaded.scene ? loaded->camera.kind : decltype(Camera::kind){};
  };
  const auto pinhole = std::get<Pinhole>(lens(R"("pinhole": {"fov_deg": 90})"));
  EXPECT_DOUBLE_EQ(pinhole.image_distance, 1e-3) << "half of 200 pixels of 10 um, at 45 degrees";
  EXPECT_DOUBLE_EQ(pinhole.aperture_radius, 1e-3 / 8);
  expect_near(pinhole.frame.forward, V3d(0, 0.6, 0.8));
  expect_near(pinhole.frame.right, V3d(1, 0, 0));
  expect_near(pinhole.frame.up, V3d(0, -0.8, 0.6));
  const auto rolled = std::get<Pinhole>(lens(R"("roll_deg": 90, "pinhole": {"fov_deg": 90})"));
  expect_near(rolled.frame.right, -pinhole.frame.up);
  expect_near(rolled.frame.up, pinhole.frame.right);

  const auto near =
      std::get<ThinLens>(lens(R"("thin_lens": {"focal_length": 0.5, "f_number": 2, "focus_distance": 1})"));
  EXPECT_DOUBLE_EQ(near.image_distance, 1);
  EXPECT_DOUBLE_EQ(near.aperture_radius, 0.125);
  const auto aimed = std::get<ThinLens>(lens(R"("thin_lens": {"focal_length": 0.5, "f_number": 2})"));
  EXPECT_DOUBLE_EQ(aimed.focus_distance, 5);
  EXPECT_DOUBLE_EQ(1 / aimed.image_distance, 1 / 0.5 - 1 / 5.0);
  const auto far = std::get<ThinLens>(
      lens(R"("thin_lens": {"focal_length": 0.5, "f_number": 2, "focus_distance": "infinity"})"));
  EXPECT_EQ(far.image_distance, 0.5);
  EXPECT_EQ(far.focus_distance, std::numeric_limits<double>::infinity());
}

TEST_F(DescriptionTest, PlacesProbes) {
  const Loaded loaded = load(
      R"({"camera": {"irradiance_probe": {"quad": {"corner": [1, 0, 0], "edge_u": [2, 0, 0], "edge_v": [0, 3, 0]}}},
    "sensor": {"observer": "1964"}})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  ASSERT_TRUE(std::holds_alternative<IrradianceProbe>(loaded->camera.kind));
  EXPECT_EQ(loaded->camera.width * loaded->camera.height, 1);
  const auto& probe = std::get<Quad>(std::get<IrradianceProbe>(loaded->camera.kind).surface);
  expect_near(probe.corner + loaded->origin_m, {1, 0, 0});
  expect_near(probe.edge_u, {2, 0, 0});
  expect_near(probe.edge_v, {0, 3, 0});
  const Loaded point = load(R"({"camera": {"irradiance_probe": {"at": [1, 0, 0], "normal": [0, 0, -2]}}})");
  ASSERT_TRUE(point.scene) << point.text();
  expect_near(std::get<ProbePoint>(std::get<IrradianceProbe>(point->camera.kind).surface).normal, {0, 0, -1});
  EXPECT_EQ(std::get<IrradianceProbe>(point->camera.kind).area(), 0);
}

TEST_F(DescriptionTest, ReadsCurves) {
  EXPECT_EQ(curve("0.3")(777), 0.3);
  const Curve table =
      curve(R"({"table": {"wavelength_nm": [400, 500], "values": [0.2, 0.4], "outside": "clamp"}})");
  EXPECT_NEAR(table(425), 0.25, 1e-12);
  EXPECT_NEAR(table(900), 0.4, 1e-12);
  EXPECT_EQ(
      curve(R"({"table": {"wavelength_nm": [400, 500], "values": [0.2, 0.4], "outside": "zero"}})")(900), 0);
  const Curve band = curve(R"({"band": [500, 600], "value": 0.5})");
  EXPECT_EQ(band(500), 0.5);
  EXPECT_EQ(band(600), 0);
  EXPECT_NEAR(curve(R"({"gaussian": {"center_nm": 550, "fwhm_nm": 20, "peak": 0.8}})")(560), 0.4, 1e-3);
  EXPECT_NEAR(curve(R"({"lines": [{"nm": 546.1, "width_nm": 2, "power": 0.5}]})")(546.5), 0.25, 1e-12);
  EXPECT_NEAR(curve(R"({"product": [0.5, {"band": [500, 600]}]})")(550), 0.5, 1e-12);
  EXPECT_NEAR(curve(R"({"sum": [0.25, {"band": [500, 600], "value": 0.5}]})")(550), 0.75, 1e-12);
  EXPECT_NEAR(curve(R"({"scale": 0.5, "of": 0.5})")(550), 0.25, 1e-12);
  EXPECT_NEAR(curve(R"({"scale": 1e-3, "of": {"daylight_K": 6504}})")(560), 0.1, 1e-9);
  EXPECT_NEAR(curve(R"({"scale": 1e-8, "of": {"blackbody_K": 3000}})")(600),
              1e-8 * planck_radiance(3000, 600), 1e-15);
  EXPECT_NEAR(curve(R"("filter.csv:T")")(550), 0.3, 1e-12) << "a file beside the scene";
  EXPECT_GT(curve(R"("cornell_box_walls:red")")(650), 0.6);
}

TEST_F(DescriptionTest, ReadsSensors) {
  const Loaded ccd = load(
      R"({"sensor": {"resolution": [4, 3], "pixel_pitch_um": 9, "exposure_s": 0.5, "quantum_efficiency": "kodak_kaf-3200me",
      "channels": {"R": {"band": [600, 700], "value": 0.5}}}})");
  ASSERT_TRUE(ccd.scene) << ccd.text();
  EXPECT_EQ(ccd->camera.width, 4);
  EXPECT_EQ(ccd->camera.height, 3);
  EXPECT_DOUBLE_EQ(ccd->camera.pixel_pitch, 9e-6);
  EXPECT_EQ(ccd->exposure_s, 0.5);
  Diagnostics diagnostics;
  const auto efficiency = load_curve("camera", "kodak_kaf-3200me", {}, diagnostics);
  ASSERT_TRUE(efficiency);
  ASSERT_EQ(ccd->channels.size(), 1U);
  EXPECT_EQ(ccd->channels[0].kind, ResponseKind::quantum);
  EXPECT_NEAR(ccd->channels[0].weight(650), 0.5 * efficiency->curve(650) / photon_energy(650),
              1e-6 / photon_energy(650));
  EXPECT_EQ(ccd->channels[0].weight(550), 0);

  const Loaded energy =
      load(R"({"sensor": {"resolution": [1, 1], "channels": {"a": {"band": [400, 500]}, "b": -0.5}}})");
  ASSERT_TRUE(energy.scene) << energy.text();
  EXPECT_EQ(energy->channels[0].kind, ResponseKind::energy);
  EXPECT_EQ(energy->channels[0].weight(450), 1);
  EXPECT_EQ(energy->channels[1].weight(450), -0.5) << "signed responses are kept";
  const Loaded quantum =
      load(R"({"sensor": {"resolution": [1, 1], "response": "quantum", "channels": {"a": 1}}})");
  EXPECT_NEAR(quantum->channels.at(0).weight(500) * photon_energy(500), 1, 1e-6);

  const Loaded observer = load(R"({"sensor": {"resolution": [1, 1], "observer": "1931"}})");
  ASSERT_EQ(observer->channels.size(), 3U);
  EXPECT_EQ(observer->channels[1].name, "Y");
  const Loaded camera = load(R"({"sensor": {"resolution": [1, 1], "camera": "Canon_EOS_5D_Mark_II"}})");
  ASSERT_EQ(camera->channels.size(), 3U);
  EXPECT_EQ(camera->channels[0].name, "R");
}

TEST_F(DescriptionTest, TransformsShapes) {
  const auto sphere = std::get<Sphere>(shape(R"("sphere": {"center": [1, 0, 0], "radius": 1}, "transform":
      {"translate": [0, 0, 5], "rotate": {"axis": [0, 0, 3], "deg": 90}, "scale": 2})"));
  expect_near(sphere.center, {0, 2, 5});
  EXPECT_DOUBLE_EQ(sphere.radius, 2);
  const auto steps = std::get<Sphere>(shape(R"("sphere": {"center": [1, 0, 0], "radius": 1}, "transform":
      [{"translate": [0, 0, 5]}, {"rotate": {"axis": [1, 0, 0], "deg": 90}}, {"scale": 2}])"));
  expect_near(steps.center, {2, -10, 0});
  const auto quad = std::get<Quad>(
      shape(R"("quad": {"corner": [1, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0]}, "transform":
      {"rotate": {"axis": [0, 0, 1], "deg": 90}, "translate": [1, 1, 1]})"));
  expect_near(quad.corner, {1, 2, 1});
  expect_near(quad.edge_u, {0, 1, 0});
  expect_near(quad.edge_v, {-1, 0, 0});
  const auto disc =
      std::get<Disc>(shape(R"("disc": {"center": [1, 0, 0], "normal": [5, 0, 0], "radius": 1}, "transform":
      {"rotate": {"axis": [0, 1, 0], "deg": 90}, "scale": 3})"));
  expect_near(disc.center, {0, 0, -3});
  expect_near(disc.normal, {0, 0, -1});
  EXPECT_DOUBLE_EQ(disc.radius, 3);
  const auto mesh =
      std::get<Mesh>(shape(R"("mesh": "bench.ply", "transform": {"scale": 2, "translate": [0, 0, 1]})"));
  expect_near(mesh.vertices.at(2), {2, 2, 1});
}

TEST_F(DescriptionTest, MakesPrisms) {
  const Mesh prism = make_prism(40, 3, 5);
  double volume = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : prism.triangles) {
    const V3d &a = prism.vertices[t[0]], &b = prism.vertices[t[1]], &c = prism.vertices[t[2]];
    volume += a.dot(b.cross(c)) / 6;
    EXPECT_GT((b - a).cross(c - a).dot(a), 0) << "outward, the origin being inside";
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges)
    EXPECT_EQ(count, edges.count({edge.second, edge.first})) << "closed";
  EXPECT_NEAR(volume, 0.5 * 9 * std::sin(40 * kPi / 180) * 5, 1e-12);
  V3d mean(0, 0, 0);
  for (const V3d& v : prism.vertices) mean += v / 6;
  expect_near(mean, {0, 0, 0});
  const V3d apex = *std::ranges::max_element(prism.vertices, {}, [](const V3d& v) { return v.z; });
  expect_near(apex, {0, apex.y, 2 * std::cos(20 * kPi / 180)});
  EXPECT_DOUBLE_EQ(std::abs(apex.y), 2.5);
}

TEST_F(DescriptionTest, TablesAreInTheUnitThatIsAskedFor) {
  const auto complaint = [&](const std::string& fragment, const std::string& unit) {
    write(folder_ / "t.csv", "# unit: " + unit + "\n# outside: clamp\nwavelength_nm,a\n400,0.5\n700,0.5\n");
    const Loaded loaded = load(fragment);
    return loaded.scene ? "" : loaded.text();
  };
  const std::string fog = R"({"materials": {"m": {"medium": {"absorption_per_m": "t.csv:a"}}}})";
  const std::string paint = R"({"materials": {"m": {"diffuse": {"reflectance": "t.csv:a"}}}})";
  const std::string lamp = R"({"lights": [{"environment": {}, "emission": {"spectrum": "t.csv:a"}}]})";
  const std::string scaled =
      R"({"materials": {"m": {"medium": {"absorption_per_m": {"scale": 100, "of": "t.csv:a"}}}}})";
  for (const char* unit : {"1/cm", "mm^-1", "furlongs", "1/mm; in air"})
    EXPECT_NE(complaint(fog, unit).find("\"t.csv:a\" has the wrong unit (got \"" + std::string(unit) +
                                        "\", allowed 1/m;"),
              std::string::npos);
  for (const char* unit : {"1/m", "m^-1 (power)", "per metre; wavelength in nm"})
    EXPECT_EQ(complaint(fog, unit), "");
  EXPECT_EQ(complaint(scaled, "1/cm"), "");
  EXPECT_NE(complaint(paint, "%").find("allowed fractions of 1"), std::string::npos);
  EXPECT_EQ(complaint(paint, "reflectance factor (0-1)"), "");
  for (const char* unit : {"mW/(m2 sr nm)", "W/(m2 sr um)", "W/(cm2 sr nm)"})
    EXPECT_NE(complaint(lamp, unit).find("allowed W/(m^2 sr nm)"), std::string::npos) << unit;
  for (const char* unit : {"W/(m2 sr nm)", "relative spectrum"}) EXPECT_EQ(complaint(lamp, unit), "") << unit;
  const auto from_infinity = [](const std::string& scale) {
    return R"({"lights": [{"directional": {"towards": [0, 0, 1]}, "emission": {"spectrum": "t.csv:a")" +
           scale + "}}]}";
  };
  const std::string point = lit(R"({"spectrum": "t.csv:a"})");
  for (const char* unit : {"W/(m^2 nm)", "spectral irradiance, W/m2/nm"}) {
    EXPECT_NE(complaint(lamp, unit).find("allowed W/(m^2 sr nm);"), std::string::npos) << unit;
    EXPECT_EQ(complaint(from_infinity(""), unit), "") << unit;
    EXPECT_NE(complaint(point, unit).find("allowed W/(sr nm);"), std::string::npos) << unit;
  }
  EXPECT_NE(complaint(from_infinity(""), "W/(m2 sr nm)").find("allowed W/(m^2 nm);"), std::string::npos);
  EXPECT_EQ(complaint(from_infinity(R"(, "irradiance": 1)"), "W/(m2 sr nm)"), "") << "of any scale";
  for (const std::string& seen : {lamp, point, from_infinity(R"(, "illuminance": 1)"),
                                  lit(R"({"illuminant": "t.csv:a", "luminous_intensity": 1})"),
                                  lit(R"({"spectral_flux_W_per_nm": "t.csv:a"})")})
    EXPECT_NE(complaint(seen, "photons/(s m^2 sr nm)").find("allowed power per nm: hc/lambda"),
              std::string::npos)
        << seen;
  const std::string behind_a_scaled_one =
      R"({"lights": [{"sun": {"towards": [0, 0, 1]}, "emission": {"spectrum": "t.csv:a", "irradiance": 1}},
                     {"environment": {}, "emission": {"spectrum": "t.csv:a"}}]})";
  EXPECT_NE(complaint(behind_a_scaled_one, "mW/(m2 sr nm)").find("/lights/1/emission"), std::string::npos);
}

TEST_F(DescriptionTest, TablesWithinSumsAndProductsAreInThatUnitToo) {
  const auto complaint = [&](const std::string& fragment, const std::string& curve, const std::string& unit) {
    write(folder_ / "t.csv", "# unit: " + unit + "\n# outside: clamp\nwavelength_nm,a\n400,0.5\n700,0.5\n");
    const Loaded loaded = load(fmt::format(fmt::runtime(fragment), curve));
    return loaded.scene ? "" : loaded.text();
  };
  const std::string fog = R"({{"materials": {{"m": {{"medium": {{"absorption_per_m": {}}}}}}}}})";
  const std::string paint = R"({{"materials": {{"m": {{"diffuse": {{"reflectance": {}}}}}}}}})";
  const std::string lamp = R"({{"lights": [{{"environment": {{}}, "emission": {{"spectrum": {}}}}}]}})";
  for (const char* curve : {R"({"sum": ["t.csv:a", 0]})", R"({"product": ["t.csv:a", 1]})",
                            R"({"product": [{"band": [400, 700]}, {"sum": [0, "t.csv:a"]}]})"}) {
    EXPECT_NE(complaint(fog, curve, "1/cm").find("(got \"1/cm\", allowed 1/m; {\"scale\": S"),
              std::string::npos)
        << curve;
    EXPECT_NE(complaint(paint, curve, "%").find("allowed fractions of 1"), std::string::npos) << curve;
    EXPECT_NE(complaint(lamp, curve, "mW/(m2 sr nm)").find("allowed W/(m^2 sr nm)"), std::string::npos)
        << curve;
    EXPECT_EQ(complaint(fog, curve, "1/m"), "");
    EXPECT_EQ(complaint(paint, curve, "reflectance (0-1)"), "");
    EXPECT_EQ(complaint(lamp, curve, "W/(m2 sr nm)"), "");
  }
  for (const char* curve :
       {R"({"sum": [{"scale": 0.01, "of": "t.csv:a"}, 0]})", R"({"product": ["t.csv:a", 0.01]})",
        R"({"product": ["t.csv:a", {"product": [1, {"product": [0.01]}]}]})",
        R"({"product": [0.01, {"sum": ["t.csv:a", {"product": ["t.csv:a", 1]}]}]})"}) {
    EXPECT_EQ(complaint(fog, curve, "1/cm"), "") << curve;
    EXPECT_EQ(complaint(paint, curve, "%"), "") << curve;
  }
  const std::string converted = R"({"product": ["t.csv:a", {"band": [400, 700]}]})";
  EXPECT_EQ(complaint(lamp, converted, "photons/(s m2 sr nm)"), "") << "by the other factor";
  EXPECT_NE(complaint(lamp, R"({"sum": ["t.csv:a", 0]})", "photons/(s m2 sr nm)").find("hc/lambda"),
            std::string::npos);
}

TEST_F(DescriptionTest, SharesOfASensorAreNoPercentagesWhereverATableStands) {
  const auto complaint = [&](const std::string& unit, double value, const std::string& sensor) {
    write(folder_ / "t.csv", fmt::format("# unit: {}\n# outside: clamp\nwavelength_nm,QE\n400,{}\n700,{}\n",
                                         unit, value, value));
    const Loaded loaded = load(R"({"sensor": {"resolution": [1, 1], )" + sensor + "}}");
    const std::string text = loaded.text();
    return loaded.scene && text.find("is used as a response") == text.npos ? "" : text;
  };
  const std::string channels = R"("channels": {"a": "t.csv:QE"})";
  const std::string peak = R"(, "peak_quantum_efficiency": 0.5)";
  const std::string quantum = R"(, "response": "quantum")";
  for (const std::string& sensor :
       {std::string(R"("channels": {"a": {"filters": ["t.csv:QE"]}})"),
        std::string(R"("observer": 1931, "lens_transmission": "t.csv:QE")"),
        std::string(R"("observer": 1931, "polariser": {"angle_deg": 0, "transmittance": "t.csv:QE"})"),
        std::string(R"("quantum_efficiency": "t.csv:QE", "channels": {"a": 1})"),
        std::string(R"("camera": "t.csv")"), channels + quantum}) {
    for (const char* unit : {"%", "quantum efficiency [%]"})
      EXPECT_NE(complaint(unit, 0.9, sensor).find("allowed fractions of 1"), std::string::npos) << sensor;
    EXPECT_NE(complaint("1", 50, sensor).find("(got 50, allowed ["), std::string::npos) << sensor;
    EXPECT_EQ(complaint("1", 0.9, sensor), "") << sensor;
  }
  for (const std::string& sensor : {R"("camera": "t.csv")" + peak, channels + quantum + peak})
    EXPECT_EQ(complaint("%", 50, sensor), "") << "scaled: " << sensor;
  EXPECT_EQ(complaint("%", 50, channels), "") << "of no unit";
  EXPECT_NE(complaint("electrons per photon", 0.5, channels).find("warning: \"t.csv:QE\" is used as"),
            std::string::npos);
  EXPECT_NE(complaint("electrons per photon", 0.5,
                      R"("channels": {"a": {"product": ["t.csv:QE", {"band": [400, 700]}]}})")
                .find("warning: \"t.csv:QE\" is used as"),
            std::string::npos);
  EXPECT_EQ(complaint("electrons per photon", 0.5, channels + quantum), "");
}

TEST_F(DescriptionTest, OverridesAndHashes) {
  const std::string text = R"({"materials": {"m": {"diffuse": {"reflectance": "filter.csv:T"}}},
    "shapes": [{"mesh": "bench.ply", "material": "m"}], "render": {"integrator": "path", "samples": 16, "max_depth": 12,
    "roulette_depth": -1, "seed": 7}, "output": {"image": "a.exr", "display": "a.png", "exposure": 0.5}})";
  const Loaded first = load(text);
  ASSERT_TRUE(first.scene) << first.text();
  EXPECT_EQ(first->render.integrator, Integrator::path);
  EXPECT_EQ(first->render.samples, 16);
  EXPECT_EQ(first->render.max_depth, 12);
  EXPECT_EQ(first->render.roulette_depth, -1);
  EXPECT_EQ(first->render.seed, 7U);
  EXPECT_EQ(first->output.image, "a.exr");
  EXPECT_EQ(first->output.display, "a.png");
  EXPECT_EQ(first->output.display_exposure, 0.5);
  EXPECT_EQ(first->sha256, load(text)->sha256);

  const Loaded changed =
      load(text, {{"/render/samples", "4"}, {"/sensor", R"({"resolution": [1, 1], "observer": 1964})"}});
  ASSERT_TRUE(changed.scene) << changed.text();
  EXPECT_EQ(changed->render.samples, 4);
  EXPECT_EQ(changed->channels.size(), 3U);
  EXPECT_NE(first->sha256, changed->sha256);
  std::set<std::string> hashes{first->sha256};
  write(folder_ / "bench.ply", ply(4, 1, kSquare + "3 0 1 2\n"));
  hashes.insert(load(text)->sha256);
  write(folder_ / "filter.csv",
        "# unit: transmittance\n# outside: zero\nwavelength_nm,T\n500,0.2\n600,0.5\n");
  hashes.insert(load(text)->sha256);
  EXPECT_EQ(hashes.size(), 3U) << "the files a scene names are part of it";
}

}  // namespace
}  // namespace abbe
