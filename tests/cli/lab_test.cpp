#include "cli/lab.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>

#include "calibration/chart/delta_e.h"
#include "cli/query.h"
#include "io/picture.h"
#include "spectral/library.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"

namespace abbe {
namespace {

using test::fault;
using test::json;
using test::json_output;
using test::scratch;

cli::LabOptions about(const std::string& material) {
  cli::LabOptions options;
  options.material = material;
  options.samples = 1024;
  return options;
}

TEST(Lab, SmoothGlassIsFresnelsToTheLastDigitOfFloat) {
  cli::LabOptions options = about(R"({"dielectric": {"ior": "N-BK7"}})");
  options.at_nm = {450, 550};
  options.angles_deg = {0, 60};
  const json lab = json_output(cli::lab, options);
  const json exact = json_output(cli::query_reflectance, {"N-BK7", options.at_nm, options.angles_deg});
  for (std::size_t angle : {0U, 1U})
    for (std::size_t nm : {0U, 1U}) {
      const double R = lab["angles"][angle]["R"][nm].get<double>();
      EXPECT_NEAR(R, exact["R"][nm][angle].get<double>(), 2e-7);
      EXPECT_NEAR(R + lab["angles"][angle]["T"][nm].get<double>(), 1, 2e-7);
    }
  EXPECT_EQ(lab["single_directions"], true);
  EXPECT_EQ(lab["spread_directions"], false);
  EXPECT_EQ(lab["dispersive"], true);
  EXPECT_NEAR(lab["energy_max"].get<double>(), 1, 2e-7);
}

// The angle of 60 degrees inside is above the critical angle.
TEST(Lab, LooksFromWithinToo) {
  cli::LabOptions options = about(R"({"dielectric": {"ior": 1.5}})");
  options.inside = true;
  options.angles_deg = {0, 60};
  const json lab = json_output(cli::lab, options);
  EXPECT_NEAR(lab["angles"][0]["R"][0].get<double>(), 0.04, 1e-7);
  EXPECT_EQ(lab["angles"][1]["R"][0], 1);
  EXPECT_EQ(lab["angles"][1]["T"][0], 0);
}

TEST(Lab, PaintHasItsReflectanceAndColour) {
  const json lab = json_output(cli::lab, about(R"({"diffuse": {"reflectance": 0.5}})"));
  for (const json& row : lab["angles"]) {
    EXPECT_NEAR(row["R"][1].get<double>(), 0.5, 1e-6);
    EXPECT_EQ(row["T"][1], 0);
    EXPECT_NEAR(row["reflected_Lab"][0].get<double>(), 76.0693, 1e-3);  // 116 cbrt(0.5) - 16
    EXPECT_NEAR(row["reflected_Lab"][1].get<double>(), 0, 1e-4);
    EXPECT_GT(row["sampling_p"].get<double>(), 1e-4);
    EXPECT_NEAR(row["spread"].get<double>(), 1, 1e-4);
  }
  EXPECT_EQ(lab["reciprocity_error_max"], 0);
  EXPECT_NEAR(lab["energy_max"].get<double>(), 0.5, 1e-6);
}

// Interference fringes of 20 nm under the lines of a fluorescent lamp. A sum in steps of 10 nm is wrong by
// 7.7.
TEST(Lab, ColoursAreSumsAtOneNanometre) {
  cli::LabOptions options = about(R"({"film": {"layers": [{"ior": "water", "thickness_nm": 5000}]}})");
  options.illuminant = "FL11";
  options.angles_deg = {0, 30};
  const json lab = json_output(cli::lab, options);
  options.at_nm.clear();
  for (int nm = 380; nm <= 780; ++nm) options.at_nm.push_back(nm);
  const json spectrum = json_output(cli::lab, options);
  Diagnostics diagnostics;
  const Curve light = load_illuminant("FL11", {}, diagnostics)->curve;
  for (std::size_t angle : {0U, 1U})
    for (const char* side : {"reflected", "transmitted"}) {
      std::vector<Knot> knots;
      for (std::size_t i = 0; i < options.at_nm.size(); ++i)
        knots.push_back(
            {options.at_nm[i], spectrum["angles"][angle][*side == 'r' ? "R" : "T"][i].get<double>()});
      const XYZ xyz = tristimulus(light, Curve(std::move(knots)), Observer::cie1931);
      const Lab exact = xyz_to_lab(xyz, tristimulus(light, Curve(1.0), Observer::cie1931));
      const json& row = lab["angles"][angle];
      const std::string name = side;
      EXPECT_LT(delta_e_2000(row[name + "_Lab"].get<Lab>(), exact), 1e-4) << side;
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(row[name + "_XYZ"][k].get<double>(), xyz[k], 1e-4);
    }
}

// The noise does not tint neutral materials, and the error of Y is reported. R has more samples. The
// reference is R at one wavelength, which hardly differs from that at the others.
TEST(Lab, TheErrorOfYIsTold) {
  for (const char* words : {R"({"phong": {"reflectance": 1, "exponent": 10}})",
                            R"({"conductor": {"ior": {"n": 0.2, "k": 3}, "roughness": 0.5}})"}) {
    cli::LabOptions options = about(words);
    options.angles_deg = {60, 80};
    options.samples = 8192;
    const json lab = json_output(cli::lab, options);
    for (const json& row : lab["angles"]) {
      const double error = row["reflected_Y_error"].get<double>();
      const double of_R = 100 * row["R_error"][1].get<double>();
      EXPECT_GT(error, 0);
      EXPECT_LT(error, 2);
      EXPECT_NEAR(row["reflected_XYZ"][1].get<double>(), 100 * row["R"][1].get<double>(),
                  5 * std::hypot(error, of_R))
          << words;
      EXPECT_EQ(row["transmitted_Y_error"], 0);
    }
  }
  const json exact = json_output(cli::lab, about(R"({"mirror": {"reflectance": 0.3}})"));
  for (const json& row : exact["angles"]) EXPECT_EQ(row["reflected_Y_error"], 0);
}

// Lobes of a milliradian, and half spheres that the surface cuts off.
TEST(Lab, NarrowLobesAndEdgesAreDrawnAsTheySay) {
  const auto expect_sound = [](const char* words, double angle_deg, double spread) {
    cli::LabOptions options = about(words);
    options.angles_deg = {angle_deg};
    const json row = json_output(cli::lab, options)["angles"][0];
    EXPECT_NEAR(row["spread"].get<double>(), spread, 1e-4) << words;
    EXPECT_GT(row["sampling_p"].get<double>(), 1e-4) << words;
  };
  expect_sound(
      R"({"conductor": {"ior": "Au_Johnson", "roughness": {"alpha": 0.005, "distribution": "beckmann"}}})",
      85, 1);
  expect_sound(R"({"dielectric": {"ior": "water", "roughness": 0.001}})", 0, 1);
  expect_sound(R"({"phong": {"reflectance": 1, "exponent": 0}})", 75, 105.0 / 180);
  expect_sound(R"({"retroreflector": {"reflectance": 1, "exponent": 0}})", 89.9, 90.1 / 180);
}

TEST(Lab, WhatReflectsAllHasTheXyzOfTheLight) {
  cli::LabOptions options = about(R"({"mirror": {"reflectance": 1}})");
  options.illuminant = "A";
  options.angles_deg = {45};
  const json xyz = json_output(cli::lab, options)["angles"][0]["reflected_XYZ"];
  const json light = json_output(cli::query_color, {"A"})["XYZ"];
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(xyz[k].get<double>(), light[k].get<double>(), 1e-4);
}

TEST(Lab, TakesAMaterialOutOfAScene) {
  const auto scene = scratch().write(
      "two.json",
      R"({"materials": {"a": {"diffuse": {"reflectance": 0.2}}, "b": {"diffuse": {"reflectance": 0.7}}}})");
  const json lab = json_output(cli::lab, about(scene.string() + ":b"));
  EXPECT_EQ(lab["name"], "b");
  EXPECT_NEAR(lab["energy_max"].get<double>(), 0.7, 1e-6);
  const auto one = scratch().write("one.json", R"({"diffuse": {"reflectance": 0.3}})");
  EXPECT_NEAR(json_output(cli::lab, about(one.string()))["energy_max"].get<double>(), 0.3, 1e-6);
}

TEST(Lab, TakesTheUnitsOfItsScene) {
  const std::string pane =
      R"("materials": {"pane": {"thin_glass": {"ior": {"n": 1.52, "k": 4e-7}, "thickness": 4}}}})";
  const auto through = [&](const char* unit) {
    const auto scene = scratch().write("pane.json", fmt::format(R"({{"units": "{}", )", unit) + pane);
    cli::LabOptions options = about(scene.string() + ":pane");
    options.at_nm = {550};
    options.angles_deg = {0};
    return json_output(cli::lab, options)["angles"][0]["T"][0].get<double>();
  };
  const double reflected = std::pow(0.52 / 2.52, 2);
  const auto expected = [&](double metres) {
    const double inner = std::exp(-4 * std::numbers::pi * 4e-7 / 550e-9 * 4 * metres);
    return std::pow(1 - reflected, 2) * inner / (1 - std::pow(reflected * inner, 2));
  };
  EXPECT_NEAR(through("mm"), expected(1e-3), 1e-4);
  EXPECT_NEAR(through("in"), expected(0.0254), 1e-4);
}

// Transparent materials reflect by n alone: 1.5 + 0.3i would reflect 0.0536 along the normal.
TEST(Lab, RefusesWhatIsNotClearAndTellsOfIndicesThatAreHeld) {
  const auto of = [](const std::string& words) {
    return [words] {
      cli::LabOptions options = about(words);
      options.at_nm = {320, 550};
      (void)cli::lab(options);
    };
  };
  for (const char* model : {"dielectric", "thin_glass"})
    EXPECT_EQ(
        fault(of(fmt::format(R"({{"{}": {{"ior": {{"n": 1.5, "k": 0.3}}}}}})", model)),
              "is not clear: with n = 1.5 and k = 0.3 at 320 nm it reflects 0.0536 along the normal, but "
              "dielectrics and thin glass are computed from n alone and reflect 0.0400"),
        ErrorCode::scene);
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  of(R"({"dielectric": {"ior": "N-SF66"}})")();
  (void)testing::internal::GetCapturedStdout();
  EXPECT_NE(
      testing::internal::GetCapturedStderr().find("is extrapolated from the end of its data, [390, 2500] nm"),
      std::string::npos);
}

TEST(Lab, TellsOfAnExtinctionThatIsHeldWhereTheIndexIsMeasured) {
  const auto heard_at = [](std::vector<double> nm) {
    cli::LabOptions options = about(R"({"dielectric": {"ior": "N-LASF31A"}})");
    options.at_nm = std::move(nm);
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    (void)cli::lab(options);
    (void)testing::internal::GetCapturedStdout();
    return testing::internal::GetCapturedStderr();
  };
  const std::string held = heard_at({320, 550});
  EXPECT_NE(held.find("warning: the extinction of material "), std::string::npos) << held;
  EXPECT_NE(held.find("is extrapolated from the end of its data, [334, 2500] nm"), std::string::npos) << held;
  EXPECT_EQ(heard_at({334, 550}).find("is extrapolated"), std::string::npos);
}

// Colours are integrated from 360 to 830 nm for any requested wavelengths.
TEST(Lab, TellsOfIndicesThatColoursAloneAskFor) {
  const auto heard = [](const std::string& material) {
    cli::LabOptions options = about(material);
    options.at_nm = {600};
    options.angles_deg = {0};
    testing::internal::CaptureStderr();
    (void)json_output(cli::lab, options);
    return testing::internal::GetCapturedStderr();
  };
  const std::string held = heard(R"({"dielectric": {"ior": "ZnSe"}})");
  EXPECT_NE(held.find("warning: the index of material "), std::string::npos) << held;
  EXPECT_NE(held.find("is extrapolated from the end of its data, [540, 18200] nm; colours are integrated "
                      "from 360 to 830 nm"),
            std::string::npos)
      << held;
  const auto ruby = scratch().write("ruby.csv",
                                    "# unit: n, k dimensionless\n# outside: clamp\nwavelength_nm,n,k\n"
                                    "300,1.5,0.3\n500,1.5,0.3\n501,1.5,0\n900,1.5,0\n");
  const std::string fault = heard(fmt::format(R"({{"dielectric": {{"ior": "{}"}}}})", ruby.string()));
  EXPECT_NE(fault.find("warning: \"material\" is not clear: with n = 1.5 and k = 0.3 at 360 nm"),
            std::string::npos)
      << fault;
  for (const char* sound :
       {R"({"dielectric": {"ior": "N-BK7"}})", R"({"conductor": {"ior": "Au_Johnson"}})",
        R"({"coated_diffuse": {"ior": "water", "reflectance": 1}})", R"({"diffuse": {"reflectance": 0.5}})"})
    EXPECT_EQ(heard(sound), "") << sound;
}

TEST(Lab, SaysWhatIsWrongWithAMaterial) {
  const auto scene = scratch().write(
      "two.json",
      R"({"materials": {"a": {"diffuse": {"reflectance": 0.2}}, "b": {"diffuse": {"reflectance": 0.7}}}})");
  const auto of = [](const std::string& words) { return [words] { (void)cli::lab(about(words)); }; };
  EXPECT_EQ(fault(of(scene.string()), "several materials: add :NAME, one of a, b"), ErrorCode::scene);
  EXPECT_EQ(fault(of(scene.string() + ":c"), "unknown material \"c\""), ErrorCode::scene);
  EXPECT_EQ(fault(of(R"({"diffuse": {"reflectance": 1.5}})"), "MATERIAL:1:29: /diffuse/reflectance"),
            ErrorCode::scene);
  EXPECT_EQ(fault(of("nowhere.json"), "nowhere.json"), ErrorCode::input);
  EXPECT_EQ(fault(of(R"({"diffuse": )"), "MATERIAL:1"), ErrorCode::scene);
}

TEST(Lab, DrawsLobesAsSvgAlone) {
  cli::LabOptions options = about(R"({"diffuse": {"reflectance": 0.5}})");
  options.plot = scratch() / "plot_of_lobes.png";
  EXPECT_EQ(fault([&options] { (void)cli::lab(options); }, "plot_of_lobes.png"), ErrorCode::usage);
  EXPECT_FALSE(std::filesystem::exists(options.plot));
}

TEST(Lab, DrawsLobesAndHemispheres) {
  cli::LabOptions options = about(R"({"diffuse": {"reflectance": 0.5}})");
  options.angles_deg = {0, 45};
  options.plot = scratch() / "lobes.svg";
  options.map = scratch() / "lobes.png";
  (void)json_output(cli::lab, options);
  const std::string svg = test::read_file(options.plot);
  std::size_t lines = 0;
  for (std::size_t at = svg.find("<polygon"); at != std::string::npos; at = svg.find("<polygon", at + 1))
    ++lines;
  EXPECT_EQ(lines, 2 * 3);  // angles by wavelengths
  const Image map = read_picture(options.map);
  ASSERT_EQ(map.width, 2 * 96);
  ASSERT_EQ(map.height, 2 * 96);
  const auto green = [&](int x, int y) {
    return map.channels[1].values[static_cast<std::size_t>(y * map.width + x)];
  };
  EXPECT_NEAR(green(48, 48), 1, 0.01);  // cos: brightest along the normal
  EXPECT_LT(green(48, 4), 0.5);         // and dark at the rim
  EXPECT_GT(green(48, 4), 0.05);
  EXPECT_EQ(green(48, 96 + 48), 0);  // nothing passes
}

}  // namespace
}  // namespace abbe
