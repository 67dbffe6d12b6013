#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace abbe::test {
namespace {

TEST(Lens, JsonHasEveryFigure) {
  const Outcome run = abbe("lens double_gauss --json --frequencies 10,30");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto answer = run.json();
  EXPECT_EQ(answer["wavelength_nm"], nlohmann::json({656.3, 587.6, 486.1}));
  EXPECT_NEAR(answer["focal_length_mm"][1].get<double>(), 100.0038, 6e-5);
  EXPECT_NEAR(answer["back_focus_mm"][1].get<double>(), 61.4875, 6e-5);
  EXPECT_NEAR(answer["seidel_mm"]["S_I"].back().get<double>(), 0.153471, 1e-5);
  ASSERT_EQ(answer["fields"].size(), 3U);
  const auto& field = answer["fields"][1];
  EXPECT_EQ(field["field_deg"], 10);
  EXPECT_NEAR(field["spots"][1]["chief_mm"].get<double>(), 17.485856, 5e-6);
  EXPECT_NEAR(field["spots"][1]["distortion_percent"].get<double>(), -0.4976, 5e-5);
  EXPECT_EQ(field["mtf"]["per_mm"], nlohmann::json({10, 30}));
  EXPECT_EQ(field["fans"][2]["tangential_um"].size(), 41U);
  EXPECT_GT(answer["t_stop"][1].get<double>(), answer["f_number"][1].get<double>());
}

// A thin lens with n = 1.5 and f = 100 mm has one ghost, which is focused at f/7 and spreads over six times
// the beam.
TEST(Lens, TellsItsGhosts) {
  const auto file = scratch().write("thin.json", R"({"f_number": 10, "wavelengths_nm": [550], "surfaces": [
    {"radius": 100, "thickness": 1e-6, "glass": 1.5, "stop": true}, [-100, 100]]})");
  const Outcome run = abbe("lens " + file.string() + " --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto ghosts = run.json()["ghosts"];
  ASSERT_EQ(ghosts["surface"], nlohmann::json({2}));
  EXPECT_EQ(ghosts["then"], nlohmann::json({1}));
  EXPECT_NEAR(ghosts["reflectance"][0].get<double>(), 0.0016, 1e-9);
  EXPECT_NEAR(ghosts["focus_mm"][0].get<double>(), 100 / 7.0 - 100, 1e-3);
  EXPECT_NEAR(ghosts["diameter_mm"][0].get<double>(), 60, 0.2);

  const auto all = abbe("lens double_gauss --json").json()["ghosts"];
  EXPECT_EQ(all["surface"].size(), 45U);
  const auto brightness = [&](std::size_t i) {
    const double diameter = all["diameter_mm"][i].get<double>();
    return all["reflectance"][i].get<double>() / diameter / diameter;
  };
  for (std::size_t i = 1; i < 45; ++i) EXPECT_GE(brightness(i - 1), brightness(i));
}

TEST(Lens, TablesTellWavelengthsSurfacesAndFields) {
  const Outcome run = abbe("lens achromat --lambda 500,550,600");
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* line :
       {"title  Cemented achromat", "wavelength_nm                    500           550           600",
        "focal_length_mm", "surface ", "    sum ", "field_deg  image_mm", "brightest ghosts",
        "surface  then"})
    EXPECT_NE(run.out.find(line), std::string::npos) << line << '\n' << run.out;
}

// The stop is set at the wavelength of the file for any requested wavelengths.
TEST(Lens, OtherWavelengthsKeepTheStop) {
  const auto own = abbe("lens double_gauss --json").json();
  const auto other = abbe("lens double_gauss --lambda 450 --json").json();
  EXPECT_EQ(own["stop_radius_mm"], other["stop_radius_mm"]);
  EXPECT_EQ(own["set_at_nm"], other["set_at_nm"]);
  EXPECT_EQ(other["set_at_nm"], 587.6);
  EXPECT_EQ(other["primary_nm"], 450);
  EXPECT_NE(own["entrance_diameter_mm"][1], other["entrance_diameter_mm"][0]);
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

TEST(Lens, PageAndDrawingShowTheLens) {
  const auto svg = scratch() / "lens.svg";
  const auto html = scratch() / "lens.html";
  const Outcome run = abbe("lens double_gauss -o " + svg.string() + " --html " + html.string());
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string drawing = read_file(svg);
  EXPECT_EQ(count(drawing, "class=\"glass\""), 6U);
  EXPECT_EQ(count(drawing, "class=\"stop\""), 2U);
  EXPECT_EQ(count(drawing, "class=\"ray\""), 15U);  // five per field
  const std::string page = read_file(html);
  EXPECT_EQ(count(page, "<svg"), 7U);  // drawing, focal shift, spots, modulation, and a fan per field
  EXPECT_EQ(count(page, "</svg>"), 7U);
  EXPECT_EQ(page.find("<?xml"), std::string::npos);
  EXPECT_NE(page.find("<td>focal_length_mm</td>"), std::string::npos);
  if (shell("command -v xmllint").code == 0) {
    EXPECT_EQ(shell("xmllint --noout " + svg.string()).code, 0);
  }
}

TEST(Lens, FaultsAreToldWithTheirPlace) {
  const auto file = scratch().write("bad.json", R"({"entrance_pupil": 5,
  "surfaces": [{"radius": 50, "thickness": 4, "glass": "N-BK8", "stop": true}, [-50, 40]]})");
  const Outcome run = abbe("lens " + file.string());
  EXPECT_EQ(run.code, 3);
  EXPECT_TRUE(run.out.empty());
  EXPECT_NE(run.err.find("bad.json:2:56: /surfaces/0/glass: error: unknown material \"N-BK8\"; did you mean"),
            std::string::npos)
      << run.err;
  EXPECT_EQ(abbe("lens no_such_lens").code, 4);
  EXPECT_EQ(abbe("lens " + (scratch() / "none.zmx").string()).code, 4);
  EXPECT_EQ(abbe("lens double_gauss -o lens.png").code, 2);
}

// Seidel sums of a field at a right angle, and of a beam that misses the image, are null.
TEST(Lens, SeidelSumsThatAreNoneAreNull) {
  const auto sums_of = [](const std::string& text) {
    const auto file = scratch().write("none.json", text);
    const Outcome run = abbe("lens " + file.string() + " --json");
    EXPECT_EQ(run.code, 0) << run.err;
    return run.json()["seidel_mm"];
  };
  const auto wide = sums_of(R"({"entrance_pupil": 5, "fields_deg": [0, 95],
    "surfaces": [{"radius": 50, "thickness": 4, "glass": 1.5, "stop": true}, [-50, 40]]})");
  EXPECT_TRUE(wide["S_I"].back().is_number());
  EXPECT_TRUE(wide["S_III"].back().is_null());
  const auto telecentric = sums_of(R"({"fields_deg": [0, 5], "focus": "given", "surfaces": [
    [50, 3, 1.5], [-50, 49.494949494949495], {"stop": true, "aperture": 0.5, "thickness": 50}]})");
  EXPECT_EQ(telecentric["surface"].size(), 4U);
  for (const auto& sum : telecentric["S_I"]) EXPECT_TRUE(sum.is_null());
}

// A lens that is telecentric before the stop, and an erect relay without power.
TEST(Lens, WithoutFNumberIsLookedThroughAndDeveloped) {
  const std::string objective = "[100, 5, 1.5], [-100, 99.15966386554621], ";
  const std::string stop = R"({"stop": true, "thickness": 99.15966386554621, "aperture": 4})";
  const std::string relays = ", [100, 5, 1.5], [-100, 198.31932773109242]";
  const auto told = [](const std::string& surfaces) {
    const auto scene = scratch()
                           .write("unnumbered.json", R"({"abbe": 1, "camera": {"lens_system": {
        "prescription": {"title": "unnumbered", "object_distance": 100, "object_heights": [0, 2], "focus": "paraxial",
          "surfaces": [)" + surfaces + R"(]}}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
      "lights": [{"environment": {}, "emission": {"illuminant": "D65", "radiance": 1}}],
      "sensor": {"resolution": [4, 4], "pixel_pitch_um": 500,
        "channels": {"R": {"band": [600, 700]}, "G": {"band": [500, 600]}, "B": {"band": [400, 500]}}},
      "render": {"integrator": "path", "samples": 1}})")
                           .string();
    const std::string film = (scratch() / "unnumbered.exr").string();
    const std::string picture = (scratch() / "unnumbered.png").string();
    EXPECT_EQ(abbe("render " + scene + " -o " + film).code, 0);
    const Outcome developed = abbe("develop " + film + " --display " + picture);
    EXPECT_EQ(developed.code, 0) << developed.err;
    EXPECT_TRUE(abbe("info " + scene + " --json").json()["lens"]["f_number"].is_null());
    const std::string info = abbe("info " + scene).out;
    const auto from = info.find("unnumbered: ");
    return info.substr(from, info.find(" um at 5", from) - from);
  };
  const std::string telecentric = told(objective + R"({"stop": true, "thickness": 50, "aperture": 4})");
  EXPECT_TRUE(telecentric.starts_with("unnumbered: focal length 100.84 mm, film ")) << telecentric;
  EXPECT_NE(telecentric.find(" mm behind it, Airy radius "), std::string::npos) << telecentric;
  const std::string afocal = told(objective + stop + relays + relays + ", [100, 5, 1.5], [-100, 50]");
  EXPECT_TRUE(afocal.starts_with("unnumbered: afocal, film 98.319 mm behind it, Airy radius ")) << afocal;
}

// Figures are omitted for a stop that no ray fills, and for a field outside the view of the lens.
TEST(Lens, WhatDoesNotGetThroughHasNoFigures) {
  const auto dark = scratch().write("dark.json", R"({"entrance_pupil": 5, "fields_deg": [0, 100],
  "surfaces": [{"radius": 50, "thickness": 4, "glass": "N-BK7", "stop": true, "aperture": 10}, [-50, 40, null, 10]]})");
  const Outcome run = abbe("lens " + dark.string() + " --json --html " + (scratch() / "dark.html").string());
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(run.json()["fields"][1]["rms_um"].is_null());
  EXPECT_TRUE(run.json()["fields"][1]["spots"][0]["vignetting_percent"].is_null());
  const auto cut = scratch().write("cut.json", R"({"entrance_pupil": 5, "fields_deg": [0, 30],
  "surfaces": [{"radius": 50, "thickness": 4, "glass": "N-BK7", "stop": true, "aperture": 10}, [-50, 40],
    {"thickness": 10, "aperture": 5}]})");
  const auto fields = abbe("lens " + cut.string() + " --json").json()["fields"];
  EXPECT_EQ(fields[0]["spots"][0]["vignetting_percent"], 0);
  EXPECT_EQ(fields[1]["spots"][0]["vignetting_percent"], 100) << "beside the last aperture";
  const auto wide = scratch().write("wide.json", R"({"entrance_pupil": 500,
  "surfaces": [{"thickness": 1, "stop": false}, [50, 4, "N-BK7"], {"radius": -50, "thickness": 4, "stop": true}]})");
  const Outcome refused = abbe("lens " + wide.string());
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("the axial ray of an entrance pupil of 500 mm misses surface 2"),
            std::string::npos)
      << refused.err;
}

}  // namespace
}  // namespace abbe::test
