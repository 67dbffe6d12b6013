#include "description.h"

namespace abbe {
namespace {

using LensSystemTest = test::DescriptionTest;

// One warning for a glass that two surfaces use.
TEST_F(LensSystemTest, TellsGlassesThatDoNotHoldForAllThatTheSensorSees) {
  const auto through = [&](const std::string& band) {
    return load(R"({"camera": {"lens_system": {"prescription": {"entrance_pupil": 4, "surfaces": [
          {"stop": true, "thickness": 2}, [60, 5, "N-SF11"], [-60, 1], [60, 5, "N-SF11"], [-60, 15]]}},
          "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
        "lights": [{"environment": {}, "emission": {"spectrum": 1}}],
        "sensor": {"resolution": [1, 1], "channels": {"a": {"band": )" +
                band + "}}}}")
        .text();
  };
  EXPECT_EQ(through("[400, 500]"), "");
  const std::string told = through("[350, 500]");
  const std::string warning =
      "/camera/lens_system/prescription: warning: N-SF11 has data on [370, 2500] nm, but the sensor responds "
      "on [350, 500] nm: ";
  EXPECT_NE(told.find(warning), std::string::npos) << told;
  EXPECT_EQ(told.find("N-SF11 has data"), told.rfind("N-SF11 has data")) << told;
}

TEST_F(LensSystemTest, TellsTheRangeOfEachTable) {
  const std::string told =
      load(R"({"camera": {"lens_system": {"prescription": {"entrance_pupil": 4, "surfaces": [
          {"stop": true, "thickness": 2}, [60, 5, {"wavelength_nm": [400, 800], "n": [1.6, 1.5]}], [-60, 1],
          [60, 5, {"wavelength_nm": [450, 800], "n": [1.7, 1.6]}], [-60, 15]]}},
          "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
        "lights": [{"environment": {}, "emission": {"spectrum": 1}}],
        "sensor": {"resolution": [1, 1], "channels": {"a": {"band": [380, 500]}}}})")
          .text();
  for (const char* range : {"[400, 800] nm", "[450, 800] nm"})
    EXPECT_NE(told.find(fmt::format("has data on {}, but the sensor responds on [380, 500] nm", range)),
              std::string::npos)
        << told;
}

TEST_F(LensSystemTest, TellsAFocusOfAFilmThatNothingMoves) {
  const auto told = [&](const std::string& beside) {
    return load(R"({"camera": {"lens_system": {"prescription": "achromat", )" + beside + R"(},
        "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]}, "sensor": {"resolution": [1, 1],
        "channels": {"a": {"band": [500, 600]}}}, "lights": [{"environment": {}, "emission": {"spectrum": 1}}]})")
        .text();
  };
  const std::string alone = told(R"("focus": "paraxial")");
  EXPECT_NE(alone.find("/camera/lens_system/focus: warning: focus has no effect"), std::string::npos)
      << alone;
  EXPECT_EQ(told(R"("focus": "paraxial", "focus_distance": 3)"), "");
  EXPECT_EQ(told(R"("focus_distance": 3)"), "");
}

TEST_F(LensSystemTest, TellsADefocusThatAFocusDistanceLoses) {
  const auto told = [&](const std::string& focused) {
    return load(
               R"({"camera": {"lens_system": {"prescription": {"f_number": 4, "focus": "paraxial", "defocus": 3,
          "surfaces": [{"stop": true, "thickness": 2}, [60, 5, 1.5], [-60, 1]]})" +
               focused + R"(}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
        "lights": [{"environment": {}, "emission": {"spectrum": 1}}],
        "sensor": {"resolution": [1, 1], "channels": {"a": {"band": [500, 600]}}}})")
        .text();
  };
  EXPECT_EQ(told(""), "");
  const std::string lost = told(R"(, "focus_distance": 3)");
  EXPECT_NE(lost.find("/prescription: warning: defocus has no effect (got 3 mm)"), std::string::npos) << lost;
}

// Relays without power, inverted and upright, with gaps to the last bit of doubles and to the digits of a
// listing. Each images its object, 100 mm in front of it, at unit magnification, so a pixel sees its pitch
// over 100 mm.
TEST_F(LensSystemTest, RelaysAreLookedThroughWithPixelsThatFloatsTellApart) {
  const auto told = [&](const std::string& gap, bool upright, double pitch_um) {
    const std::string more =
        upright ? ", [100, 5, 1.5], [-100, 198.31932773109242], [100, 5, 1.5], [-100, 198.31932773109242]"
                : "";
    return load(R"({"camera": {"lens_system": {"prescription": {"object_distance": 100, "focus": "paraxial",
          "surfaces": [[100, 5, 1.5], [-100, 99.15966386554621],
            {"stop": true, "aperture": 4, "thickness": )" +
                gap + "}" + more + R"(, [100, 5, 1.5], [-100, 50]]}},
          "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
        "lights": [{"environment": {}, "emission": {"spectrum": 1}}],
        "sensor": {"resolution": [8, 8], "pixel_pitch_um": )" +
                fmt::format("{}", pitch_um) + R"(, "channels": {"a": {"band": [500, 600]}}}})")
        .text();
  };
  for (const char* gap : {"99.15966386554621", "99.1597"})
    for (const bool upright : {false, true}) {
      EXPECT_EQ(told(gap, upright, 500), "") << gap << upright;
      EXPECT_EQ(told(gap, upright, 0.05), "") << gap << upright;
      const std::string small = told(gap, upright, 0.04);
      EXPECT_NE(small.find("a pixel covers 4e-07 rad"), std::string::npos) << gap << upright << small;
    }
}

// The stop is close to the focus of the group in front of it, and the requested aperture is far too wide.
TEST_F(LensSystemTest, OpeningsOfTelecentricLensesAreRefusedInWords) {
  const auto told = [&](const std::string& opening, const std::string& camera) {
    return load(R"({"camera": {"lens_system": {"prescription": {"object_distance": 120, )" + opening +
                R"("focus": "paraxial", "surfaces": [[100, 5, 1.5], [-100, 99.155],
            {"stop": true, "aperture": 4, "thickness": 50}]})" +
                camera + R"(}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
        "lights": [{"environment": {}, "emission": {"spectrum": 1}}],
        "sensor": {"resolution": [8, 8], "pixel_pitch_um": 500, "channels": {"a": {"band": [500, 600]}}}})")
        .text();
  };
  for (const auto& [said, words] :
       {std::pair(told("", R"(, "f_number": 0.0004)"),
                  "(got f/0.0004, allowed the aperture of its prescription)"),
        {told(R"("f_number": 0.0004, )", ""), "(got f/0.0004, allowed the aperture of its stop)"},
        {told(R"("entrance_pupil": 2.5e5, )", ""),
         "(got an entrance pupil of 2.5e+05 mm, allowed the aperture of its stop)"}})
    EXPECT_NE(said.find(words), std::string::npos) << said;
}

// At oblique incidence an interference filter transmits shorter wavelengths than along its normal.
TEST_F(LensSystemTest, WhatTheSensorSeesIsSeenAtAnyAngle) {
  const auto told = [&](double line_nm) {
    return load(
               fmt::format(
                   R"({{"camera": {{"pinhole": {{"fov_deg": 60}}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]}},
        "sensor": {{"resolution": [16, 16], "channels": {{"a": {{"filters": [
          {{"transmittance": {{"band": [560, 700]}}, "effective_index": 1.8}}]}}}}}},
        "materials": {{"g": {{"dielectric": {{"ior": {{"wavelength_nm": [557, 720], "n": [1.6, 1.5]}}}}}}}},
        "lights": [{{"name": "na", "environment": {{}},
                    "emission": {{"lines": [{{"nm": {}, "width_nm": 1, "power": 1}}], "radiance": 1}}}}]}})",
                   line_nm))
        .text();
  };
  const std::string lit = told(545);
  EXPECT_EQ(lit.find("emits nothing"), std::string::npos) << lit;
  EXPECT_NE(lit.find("has data on [557, 720] nm, but the sensor responds on [5"), std::string::npos) << lit;
  EXPECT_NE(told(515).find("emits nothing that the sensor records"), std::string::npos);
}

}  // namespace
}  // namespace abbe
