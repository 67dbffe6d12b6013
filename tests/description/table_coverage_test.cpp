// Tables that do not cover the range that a sensor records.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "description.h"

namespace abbe {
namespace {

using test::lit;
using test::Loaded;
using test::painted;

/// Scenes that use a constant table, `t.csv:a`.
class TableEndsTest : public test::DescriptionTest {
 protected:
  // Diagnostics of a scene whose table declares no extrapolation, or `outside`.
  std::string complaint(const std::string& fragment, const std::string& outside = "", int low_nm = 380,
                        int high_nm = 780) {
    write_table(outside, low_nm, high_nm);
    const Loaded loaded = load(fragment);
    EXPECT_EQ(loaded.scene.has_value(), !loaded.diagnostics.has_errors());
    return loaded.text();
  }
  void write_table(const std::string& outside, int low_nm, int high_nm) {
    const std::string line = outside.empty() ? "" : "# outside: " + outside + "\n";
    test::write(folder_ / "t.csv",
                fmt::format("# unit: 1\n{}wavelength_nm,a\n{},0.5\n{},0.5\n", line, low_nm, high_nm));
  }
};

constexpr const char* kDark = "\"t.csv:a\" is 0 outside its table";

// A scene with a light and a sensor of constant response on [300, 1100] nm, so that no other warning appears.
std::string with_lamp(const std::string& sensor) {
  return fmt::format(
      R"({{"lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}], "sensor": {{"resolution": [1, 1], {}}}}})",
      sensor);
}
// Fraction of the photons of a spectrum with constant power on [300, 1100] nm that is within the range.
constexpr double share_of_photons(double low_nm, double high_nm) {
  return (high_nm * high_nm - low_nm * low_nm) / (1100.0 * 1100.0 - 300.0 * 300.0);
}
std::string percent_beyond(double low_nm, double high_nm) {
  return fmt::format("{:.3g} %", 100 * (1 - share_of_photons(low_nm, high_nm)));
}

TEST_F(TableEndsTest, AFilterTellsAllThatTheDetectorBehindItSees) {
  const std::string beyond = percent_beyond(380, 780);
  EXPECT_EQ(beyond, "58.6 %");
  for (const char* filtered :
       {R"("quantum_efficiency": 0.5, "channels": {"mono": {"filters": ["t.csv:a"]}})",
        R"("quantum_efficiency": 0.5, "channels": {"mono": "t.csv:a"})",
        R"("quantum_efficiency": 0.5, "channels": {"mono": 1}, "lens_transmission": "t.csv:a")",
        R"("quantum_efficiency": 0.5, "channels": {"mono": 1}, "filters": [0.9, "t.csv:a"])"}) {
    const std::string scene = with_lamp(filtered);
    EXPECT_NE(complaint(scene).find("error: \"t.csv:a\" covers only 380 to 780 nm, but " + beyond +
                                    " of the integral for channel \"mono\" lies outside"),
              std::string::npos)
        << complaint(scene);
    EXPECT_NE(complaint(scene, "zero")
                  .find("warning: \"t.csv:a\" is 0 outside its table, 380 to 780 nm: " + beyond),
              std::string::npos)
        << complaint(scene, "zero");
    EXPECT_EQ(complaint(scene, "clamp"), "");
  }
}

// A table must cover the range that the other factors of a channel transmit, and each channel only needs its
// own tables.
TEST_F(TableEndsTest, WhatOthersKeepAwayNeedNotBeTold) {
  for (const char* filters :
       {R"("t.csv:a", {"band": [400, 700]})", R"({"product": ["t.csv:a", {"band": [400, 700]}]})"})
    for (const char* outside : {"", "zero"}) {
      const std::string scene = with_lamp(
          fmt::format(R"("quantum_efficiency": 0.5, "channels": {{"mono": {{"filters": [{}]}}}})", filters));
      EXPECT_EQ(complaint(scene, outside), "") << filters;
    }
  const std::string two = with_lamp(
      R"("quantum_efficiency": 0.5, "channels": {"a": {"filters": ["t.csv:a", {"band": [400, 700]}]}, "b": {"band": [800, 900]}})");
  EXPECT_EQ(complaint(two, "zero"), "");
}

TEST_F(TableEndsTest, AResponseTellsAllOrSaysThatItEnds) {
  const std::string beyond = percent_beyond(350, 1000);
  EXPECT_EQ(beyond, "21.7 %");
  const std::string sensor = with_lamp(R"("quantum_efficiency": "t.csv:a", "channels": {"mono": 1})");
  EXPECT_NE(complaint(sensor, "", 350, 1000).find("covers only 350 to 1000 nm, but " + beyond),
            std::string::npos)
      << complaint(sensor, "", 350, 1000);
  EXPECT_EQ(complaint(sensor, "zero", 350, 1000), "") << "it is what it says";
  EXPECT_EQ(complaint(with_lamp(R"("channels": {"mono": "t.csv:a"})"), "zero", 350, 1000), "");
  const std::string camera = with_lamp(R"("camera": "t.csv")");
  EXPECT_NE(complaint(camera, "", 350, 1050).find("covers only 350 to 1050 nm, but 12.5 %"),
            std::string::npos)
      << complaint(camera, "", 350, 1050);
  EXPECT_EQ(complaint(camera, "zero", 350, 1050), "");
}

TEST_F(TableEndsTest, ALampTellsAllThatTheSensorSees) {
  const std::string seen = lit(R"({"illuminant": "t.csv:a", "luminous_intensity": 1})");
  EXPECT_NE(complaint(seen).find("covers 380 to 780 nm, but 300 to 1100 nm are needed"), std::string::npos)
      << complaint(seen);
  const std::string dark = complaint(seen, "zero", 400, 700);
  EXPECT_NE(dark.find("/lights/0/emission"), std::string::npos) << dark;
  EXPECT_NE(dark.find("warning: \"t.csv:a\" is 0 outside its table, 400 to 700 nm: 62.5 % of the integral "
                      "for channel \"all\" would lie there with constant extrapolation; end the table with a "
                      "row of 0 if it falls to 0"),
            std::string::npos)
      << dark;
  EXPECT_EQ(complaint(seen, "clamp"), "");
  EXPECT_EQ(complaint(lit(R"({"spectrum": {"product": ["t.csv:a", {"band": [400, 700]}]}})"), "zero"), "");
}

TEST_F(TableEndsTest, NamedLightsThatAreDarkWhereTheSensorSeesAreTold) {
  const auto told = [&](const std::string& light, const std::string& counts) {
    return load(
               fmt::format(
                   R"({{"lights": [{{"environment": {{}}, "emission": {{{}, "luminance": 100}}}}], "sensor": {{"resolution": [1, 1], {}}}}})",
                   light, counts))
        .text();
  };
  const std::string ccd = R"("quantum_efficiency": "kodak_kaf-3200me", "channels": {"mono": 1})";
  EXPECT_NE(told(R"("illuminant": "D65")", ccd)
                .find("warning: \"D65\" is 0 outside its table, 300 to 830 nm: 13 % of the integral for "
                      "channel \"mono\" would lie there"),
            std::string::npos);
  EXPECT_NE(
      told(R"("daylight_K": 6504)", ccd).find("\"daylight:6504\" is 0 outside its table, 300 to 830 nm"),
      std::string::npos);
  for (const char* light :
       {R"("illuminant": "A")", R"("illuminant": "E")", R"("blackbody_K": 3000)", R"("spectrum": 1)"})
    EXPECT_EQ(told(light, ccd), "") << light;
  for (const char* light : {R"("illuminant": "D65")", R"("illuminant": "E")", R"("illuminant": "FL11")",
                            R"("illuminant": "LED-B3")", R"("daylight_K": 5000)"})
    for (const char* counts :
         {R"("observer": "1931")", R"("camera": "Nikon_D5100")",
          R"("quantum_efficiency": "kodak_kaf-3200me", "channels": {"R": {"band": [590, 680]}})"})
      EXPECT_EQ(told(light, counts), "") << light << counts;
}

// The detector is constant, so 500 nm of 800 are outside the table, and 400 nm of the 700 that a filter
// transmits.
TEST_F(TableEndsTest, ATableIsToldOnceForEachShareThatIsLost) {
  const std::string lamp = R"({"point": {"at": [0, 0, 1]}, "emission": {"spectrum": )";
  const std::string scaled = lamp + R"({"scale": 2, "of": "t.csv:a"}, )";
  const std::string filtered = lamp + R"({"product": [3, "t.csv:a", {"band": [400, 1100]}]}, )";
  const std::string told =
      complaint(R"({"lights": [)" + scaled + R"("intensity": 1}}, )" + scaled +
                    R"("luminous_intensity": 2}}, )" + lamp + R"({"scale": 5, "of": "t.csv:a"}, )" +
                    R"("intensity": 1}}, )" + filtered + R"("intensity": 1}}]})",
                "zero", 400, 700);
  std::vector<std::size_t> at;
  for (std::size_t i = told.find(kDark); i != std::string::npos; i = told.find(kDark, i + 1)) at.push_back(i);
  ASSERT_EQ(at.size(), 2U) << told;
  EXPECT_NE(told.find("/lights/0/emission"), std::string::npos) << told;
  EXPECT_NE(told.find("62.5 %", at[0]), std::string::npos) << told;
  EXPECT_NE(told.find("57.1 %", at[1]), std::string::npos) << told;
}

TEST_F(TableEndsTest, RowsOfZeroSayThatALampEnds) {
  const auto told = [&](const char* last) {
    test::write(
        folder_ / "t.csv",
        fmt::format("# unit: 1\n# outside: zero\nwavelength_nm,a\n399,0\n400,0.5\n700,0.5\n{}", last));
    return load(lit(R"({"spectrum": "t.csv:a", "luminous_intensity": 1})")).text();
  };
  EXPECT_NE(told("").find(kDark), std::string::npos) << told("");
  EXPECT_EQ(told("701,0\n"), "");
}

// The index is valid at its last row, and not beyond it, where the sensor records nothing.
TEST_F(TableEndsTest, AnIndexNeedsToHoldToTheLastRowOfTheSensorsTable) {
  const auto told = [&](double last_nm, const std::string& sensor) {
    return complaint(
        fmt::format(
            R"({{"lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}], "sensor": {{"resolution": [1, 1], {}}},
          "materials": {{"m": {{"conductor": {{"ior": {{"wavelength_nm": [360, {}], "n": [1, 1], "k": [2, 2]}}}}}}}}}})",
            sensor, last_nm),
        "zero", 380, 780);
  };
  for (const auto& [sensor, last_nm] :
       {std::pair(R"("observer": "1931")", 830.0), std::pair(R"("channels": {"a": "t.csv:a"})", 780.0)}) {
    EXPECT_EQ(told(last_nm, sensor), "") << sensor;
    EXPECT_NE(told(last_nm - 1e-3, sensor).find("the index of the nearer end is used"), std::string::npos)
        << sensor;
  }
}

TEST_F(TableEndsTest, MatterTellsAllThatTheSensorSees) {
  const std::string paint = painted(R"("t.csv:a")");
  const auto seen = [&](const std::string& counts) {
    return fmt::format(R"({{"lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}], {}, {}}})",
                       paint.substr(1, paint.size() - 2),
                       fmt::format(R"("sensor": {{"resolution": [1, 1], {}}})", counts));
  };
  EXPECT_NE(complaint(seen(R"("channels": {"a": {"band": [400, 900]}})"))
                .find("covers 380 to 780 nm, but 380 to 900 nm are needed"),
            std::string::npos);
  EXPECT_EQ(complaint(seen(R"("channels": {"a": {"band": [400, 700]}})")), "");
  EXPECT_EQ(complaint(seen(R"("observer": "1931")")), "");
}

// The whole power of a light scales it, whatever the range of the sensor.
TEST_F(TableEndsTest, ALampThatIsScaledByItsPowerTellsAllOfIt) {
  const auto seen = [](const std::string& scale) {
    return fmt::format(
        R"({{"lights": [{{"environment": {{}}, "emission": {{"spectrum": "t.csv:a", {}}}}}], "sensor": {{"resolution": [1, 1], "observer": "1931"}}}})",
        scale);
  };
  EXPECT_NE(complaint(seen(R"("radiance": 5)")).find("but 300 to 1100 nm are needed"), std::string::npos);
  EXPECT_EQ(complaint(seen(R"("luminance": 5)")), "");
}

// A meter records all light of a source that is declared 0 outside its table. Without a declaration the light
// there is unknown.
TEST_F(TableEndsTest, AMeterNeedsWhatItCountsWithoutAWordOfLampsThatEnd) {
  const auto metered = [&](const std::string& outside) {
    write_table(outside, 380, 780);
    test::write(folder_ / "scene.json",
                R"({"abbe": 1, "meters": {"m": {"at": [0, 0, 0], "normal": [0, 0, 1]}},
        "lights": [{"point": {"at": [0, 0, 1]}, "emission": {"illuminant": "t.csv:a", "luminous_intensity": 1}}]})");
    Diagnostics diagnostics;
    const auto scene = load_meters(folder_ / "scene.json", {}, diagnostics);
    if (scene) (void)scene_of(*scene, scene->meters.at(0), diagnostics);
    return diagnostics.text();
  };
  EXPECT_EQ(metered("zero"), "");
  EXPECT_NE(metered("").find("but 300 to 1100 nm are needed"), std::string::npos) << metered("");
}

}  // namespace
}  // namespace abbe
