#include <fmt/format.h>
#include <gtest/gtest.h>

#include "description.h"

namespace abbe {
namespace {

using SpectralDescription = test::DescriptionTest;
using test::Loaded;

std::string spectral_sensor(const std::string& members) {
  return fmt::format(R"({{"sensor": {{"resolution": [4, 3], {}}}}})", members);
}

TEST_F(SpectralDescription, BinsAreChannels) {
  const Loaded loaded =
      load(spectral_sensor(R"("spectral": {"from_nm": 380, "to_nm": 381, "step_nm": 0.1}, "exposure_s": 2)"));
  ASSERT_TRUE(loaded.scene) << loaded.text();
  ASSERT_TRUE(loaded->spectral);
  EXPECT_EQ(loaded->spectral->from_nm, 380);
  EXPECT_EQ(loaded->spectral->step_nm, 0.1);
  EXPECT_EQ(loaded->spectral->count, 10);
  ASSERT_EQ(loaded->channels.size(), 10U);
  EXPECT_EQ(loaded->channels[9].name, "380.95nm");
  EXPECT_NE(loaded->sensor_text.find(R"("exposure_s":2)"), std::string::npos) << loaded->sensor_text;
  EXPECT_FALSE(load("{}")->spectral);
}

TEST_F(SpectralDescription, FaultsAreNamed) {
  const std::string bins = R"("spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 10})";
  for (const auto& [members, message] : std::vector<std::pair<std::string, std::string>>{
           {R"("spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 7})", "the bins do not fill the range"},
           {R"("spectral": {"from_nm": 700, "to_nm": 400, "step_nm": 10})", "allowed 2 to 1000"},
           {R"("spectral": {"from_nm": 400, "to_nm": 410, "step_nm": 10})", "the bins do not fill the range"},
           {R"("spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 0.1})",
            "the bins do not fill the range"},
           {R"("spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 0})", "(got 0, allowed [0.01, 800])"},
           {R"("spectral": {"from_nm": 200, "to_nm": 700, "step_nm": 10})", "(got 200, allowed [300, 1100])"},
           {R"("spectral": {"to_nm": 700, "step_nm": 10})", "missing key \"from_nm\""},
           {bins + R"(, "observer": "1931")",
            "a sensor has one of channels, camera, observer and spectral (got"},
           {bins + R"(, "quantum_efficiency": 0.5)", "quantum_efficiency is used with channels only"},
           {bins + R"(, "response": "energy")", "response is used with channels only"},
           {bins + R"(, "filters": [0.5])", "filters is used with channels only"},
           {bins + R"(, "lens_transmission": 0.5)", "lens_transmission is used with channels only"},
           {bins + R"(, "mosaic": [["405nm"]])", "mosaic is used with channels only"},
           {bins + R"(, "readout": {"gain_e_per_dn": 1, "bits": 8})", "channels that count electrons"}}) {
    const Loaded loaded = load(spectral_sensor(members));
    EXPECT_FALSE(loaded.scene) << members;
    EXPECT_NE(loaded.text().find(message), std::string::npos) << members << '\n' << loaded.text();
  }
}

}  // namespace
}  // namespace abbe
