#include <fmt/format.h>
#include <gtest/gtest.h>

#include "description.h"
#include "sensor/readout/speed.h"

namespace abbe {
namespace {

using ReadoutDescription = test::DescriptionTest;
using test::Loaded;

std::string read_out_sensor(const std::string& readout, const std::string& response = "quantum") {
  return fmt::format(
      R"({{"sensor": {{"resolution": [4, 3], "channels": {{"all": 1}}, "response": "{}", "readout": {}}}}})",
      response, readout);
}

TEST_F(ReadoutDescription, EveryKeyArrives) {
  const Loaded loaded = load(read_out_sensor(
      R"({"gain_e_per_dn": 1.5, "bits": 14, "offset_dn": 200.5, "full_well_e": 20000, "read_noise_e": 9,
          "dark_e_per_s": 2, "prnu_percent": 1.25, "dsnu_e": 3, "serial": 41,
          "response_curve": [[0, 0], [0.5, 0.75], [1, 1]]})"));
  ASSERT_TRUE(loaded.scene) << loaded.text();
  ASSERT_TRUE(loaded->readout);
  const Readout& readout = *loaded->readout;
  EXPECT_EQ(readout.gain_e_per_dn, 1.5);
  EXPECT_EQ(readout.bits, 14);
  EXPECT_EQ(readout.highest_code(), 16383);
  EXPECT_EQ(readout.offset_dn, 200.5);
  EXPECT_EQ(readout.full_well_e, 20000);
  EXPECT_EQ(readout.read_noise_e, 9);
  EXPECT_EQ(readout.dark_e_per_s, 2);
  EXPECT_EQ(readout.prnu_percent, 1.25);
  EXPECT_EQ(readout.dsnu_e, 3);
  EXPECT_EQ(readout.serial, 41U);
  ASSERT_TRUE(readout.response_curve);
  EXPECT_EQ((*readout.response_curve)(0.25), 0.375);
}

TEST_F(ReadoutDescription, WhatIsNotSaidIsIdeal) {
  const Loaded loaded = load(read_out_sensor(R"({"gain_e_per_dn": 2, "bits": 12})"));
  ASSERT_TRUE(loaded.scene) << loaded.text();
  const Readout& readout = *loaded->readout;
  EXPECT_GT(readout.full_well_e, 1e300);
  for (const double zero :
       {readout.offset_dn, readout.read_noise_e, readout.dark_e_per_s, readout.prnu_percent, readout.dsnu_e})
    EXPECT_EQ(zero, 0);
  EXPECT_FALSE(readout.response_curve);
  EXPECT_FALSE(load("{}")->readout);
}

TEST_F(ReadoutDescription, ItNeedsChannelsThatCountElectrons) {
  const Loaded loaded = load(read_out_sensor(R"({"gain_e_per_dn": 2, "bits": 12})", "energy"));
  EXPECT_FALSE(loaded.scene);
  EXPECT_NE(
      loaded.text().find("/sensor/readout: error: a readout needs channels that count electrons (got \"all\" "
                         "with an energy response, allowed quantum; peak_quantum_efficiency converts it)"),
      std::string::npos)
      << loaded.text();
}

TEST_F(ReadoutDescription, FaultsAreNamed) {
  for (const auto& [readout, message] :
       {std::pair{R"({"bits": 12})", "/sensor/readout: error: missing key \"gain_e_per_dn\" or \"iso\""},
        std::pair{R"({"gain_e_per_dn": 1})", "missing key \"bits\""},
        std::pair{R"({"gain_e_per_dn": 0, "bits": 12})",
                  "expected a number (got 0, allowed (0, 1000000000])"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 17})", "expected an integer (got 17, allowed [1, 16])"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "offset_dn": 255})", "(got 255, allowed [0, 255))"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "full_well_e": 0})", "full_well_e: error: expected"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "read_noise_e": -1})", "read_noise_e: error: expected"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "dark_e_per_s": -1})", "dark_e_per_s: error: expected"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "prnu_percent": 101})", "(got 101, allowed [0, 100])"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "dsnu_e": -1})", "dsnu_e: error: expected"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "serial": 1.5})", "serial: error: expected an integer"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "gian": 1})", "unknown key \"gian\""},
        std::pair{
            R"({"gain_e_per_dn": 1, "bits": 8, "response_curve": [[0, 0], [0.5, 0.5], [0.5, 0.7], [1, 1]]})",
            "response_curve: error: expected points [in, out] that increase in both"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "response_curve": [[0, 0], [1, 0.9]]})",
                  "from [0, 0] to [1, 1]"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "response_curve": [[0, 0]]})", "expected points"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "response_curve": 2})",
                  "response_curve: error: expected an array of points [in, out] (got a number)"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "response_curve": [[0, 0], [1, 1, 1]]})",
                  "wrong number of elements"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "saturation_dn": 300})", "no code of 8 bits (got 300"},
        std::pair{R"({"gain_e_per_dn": 1, "bits": 8, "offset_dn": 9, "saturation_dn": 9})",
                  "offset_dn: error: expected a number (got 9, allowed [0, 9))"},
        std::pair{R"({"gain_e_per_dn": 1, "iso": 100, "bits": 8})", "a gain or an ISO speed"},
        std::pair{R"({"iso": 1, "bits": 8, "full_well_e": 10})",
                  "iso: error: the well of 10 electrons is full"},
        std::pair{R"(3)", "/sensor/readout: error: expected an object"}}) {
    const Loaded loaded = load(read_out_sensor(readout));
    EXPECT_FALSE(loaded.scene) << readout;
    EXPECT_NE(loaded.text().find(message), std::string::npos) << readout << '\n' << loaded.text();
  }
}

TEST_F(ReadoutDescription, ASpeedStandsForTheGainThatHasIt) {
  for (const double iso : {100.0, 400.0, 6400.0}) {
    const Loaded loaded =
        load(read_out_sensor(fmt::format(R"({{"iso": {}, "bits": 14, "offset_dn": 600}})", iso)));
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const auto sensitivity = daylight_sensitivity(
        loaded->channels, gathering_area(loaded->camera.pixel_pitch, loaded->fill_factor));
    EXPECT_NEAR(saturation_speed(*loaded->readout, sensitivity.value()), iso, 1e-9 * iso);
  }
}

TEST_F(ReadoutDescription, DaylightThatEndsWithinWhatIsCountedIsToldOnceWhereItIsTheScale) {
  const auto warnings = [this](const std::string& channels) {
    const Loaded loaded = load(fmt::format(R"({{"sensor": {{"resolution": [4, 3], {}}}}})", channels));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    std::size_t told = 0;
    for (std::size_t at = 0;
         (at = loaded.text().find("\"D55\" is 0 outside its table", at)) != std::string::npos; ++at)
      ++told;
    return told;
  };
  const std::string even = R"("response": "quantum", "channels": {"all": 1}, "readout": )";
  EXPECT_EQ(warnings(even + R"({"iso": 100, "bits": 14})"), 1U);
  EXPECT_EQ(warnings(even + R"({"gain_e_per_dn": 2, "bits": 14})"), 0U);
  EXPECT_EQ(
      warnings(R"("electrons_per_lx_s": 5000, "channels": {"all": 1}, "readout": {"iso": 100, "bits": 14})"),
      1U);
  EXPECT_EQ(warnings(R"("response": "quantum", "channels": {"seen": {"band": [400, 800]}},
                        "readout": {"iso": 100, "bits": 14})"),
            0U);
}

}  // namespace
}  // namespace abbe
