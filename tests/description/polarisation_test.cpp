#include <gtest/gtest.h>

#include <fmt/format.h>

#include "description.h"
#include "sensor/response/polarised_channels.h"

namespace abbe {
namespace {

using test::Fault;
using test::lit;
using test::Loaded;
using test::sensed;
using PolarisationTest = test::DescriptionTest;

constexpr const char* kPixel = R"("resolution": [1, 1], )";

TEST_F(PolarisationTest, PolarisersStandBeforeOneChannelOrAll) {
  const Loaded own = load(sensed(
      std::string(kPixel) +
      R"("quantum_efficiency": 0.5, "channels": {"up": {"polariser": {"angle_deg": 90, "transmittance": 0.8}},
         "leaky": {"filters": [0.5], "polariser": {"angle_deg": 0, "extinction_ratio": 3}}, "clear": {"filters": []}})"));
  ASSERT_TRUE(own.scene) << own.text();
  const Channel& up = own->channels.at(0);
  ASSERT_TRUE(up.analyser && own->channels[1].analyser);
  EXPECT_FALSE(own->channels[2].analyser);
  EXPECT_NEAR(up.analyser->q, -1, 1e-6F);
  EXPECT_NEAR(up.weight(600) / own->channels[2].weight(600), 0.4, 1e-12);
  EXPECT_NEAR(own->channels[1].weight(600) / own->channels[2].weight(600), 0.5 * (1 + 1.0 / 3) / 2, 1e-12);
  EXPECT_NEAR(own->channels[1].analyser->contrast(600), 0.5, 1e-12);

  const Loaded all =
      load(sensed(std::string(kPixel) + R"("observer": "1931", "polariser": {"angle_deg": 45})"));
  ASSERT_TRUE(all.scene) << all.text();
  for (const Channel& channel : all->channels) {
    ASSERT_TRUE(channel.analyser);
    EXPECT_NEAR(channel.analyser->u, 1, 1e-6F);
  }
  EXPECT_NEAR(all->channels.at(1).weight(555), 683.002 / 2, 0.01);
  EXPECT_NE(all->sensor_text.find(R"("polariser":{"angle_deg":45})"), std::string::npos) << all->sensor_text;
}

TEST_F(PolarisationTest, StokesMakesFourOfEachChannel) {
  const Loaded loaded = load(sensed(std::string(kPixel) + R"("observer": "1931", "stokes": true)"));
  ASSERT_TRUE(loaded.scene) << loaded.text();
  EXPECT_EQ(loaded->film_planes(), (std::vector<std::string>{"X", "Y", "Z", "S1.X", "S1.Y", "S1.Z", "S2.X",
                                                             "S2.Y", "S2.Z", "S3.X", "S3.Y", "S3.Z"}));
  EXPECT_NE(loaded->sensor_text.find(R"("stokes":true)"), std::string::npos) << loaded->sensor_text;
  const Loaded off = load(sensed(std::string(kPixel) + R"("observer": "1931", "stokes": false)"));
  ASSERT_TRUE(off.scene) << off.text();
  EXPECT_FALSE(any_analyser(off->channels));
  const Loaded bins =
      load(sensed(std::string(kPixel) + R"("spectral": {"from_nm": 400, "to_nm": 600, "step_nm": 100},
                                           "stokes": true)"));
  ASSERT_TRUE(bins.scene) << bins.text();
  EXPECT_EQ(bins->channels.size(), 8U);
}

TEST_F(PolarisationTest, LampsSayTheirs) {
  const auto polarisation = [this](const std::string& light) {
    const Loaded loaded = load(fmt::format(R"({{"lights": [{}]}})", light));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    return loaded->lights.at(0).polarisation;
  };
  const std::string linear =
      R"("emission": {"radiance": 1, "spectrum": 1, "polarised": {"axis": [0, 0, -2]}})";
  for (const std::string& kind :
       {std::string(R"("quad": {"corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0]})"),
        std::string(R"("sphere": {"center": [0, 0, 0], "radius": 1})"), std::string(R"("environment": {})"),
        std::string(R"("sun": {"towards": [0, 0, 1]})")}) {
    const auto told = polarisation(fmt::format("{{{}, {}}}", kind, linear));
    ASSERT_TRUE(told) << kind;
    EXPECT_EQ(told->degree, 1);
    EXPECT_EQ(std::get<LinearPolarisation>(told->kind).axis, Imath::V3f(0, 0, -1));
  }
  const auto circular = polarisation(
      R"({"point": {"at": [0, 0, 1]}, "emission": {"spectrum": 1, "polarised": {"circular": "left", "degree": 0.25}}})");
  ASSERT_TRUE(circular);
  EXPECT_EQ(circular->degree, 0.25F);
  EXPECT_FALSE(std::get<CircularPolarisation>(circular->kind).right);
  EXPECT_FALSE(polarisation(R"({"point": {"at": [0, 0, 1]}, "emission": {"spectrum": 1}})"));
}

TEST_F(PolarisationTest, RefusesAndExplainsWhatIsWrong) {
  const auto sensor = [](const std::string& members) { return sensed(kPixel + members); };
  const std::vector<Fault> faults{
      {"no angle", sensor(R"("observer": "1931", "polariser": {})"), ErrorCode::scene,
       "missing key \"angle_deg\""},
      {"a ratio below 1",
       sensor(R"("observer": "1931", "polariser": {"angle_deg": 0, "extinction_ratio": 0.5})"),
       ErrorCode::scene, "/sensor/polariser/extinction_ratio: error: curve out of range"},
      {"percent", sensor(R"("observer": "1931", "polariser": {"angle_deg": 0, "transmittance": 92})"),
       ErrorCode::scene, "(got 92, allowed [0, 1.05])"},
      {"two polarisers",
       sensor(R"("polariser": {"angle_deg": 0}, "channels": {"a": {"polariser": {"angle_deg": 0}}})"),
       ErrorCode::scene,
       "/sensor/channels/a/polariser: error: a channel cannot have a second polariser: the sensor already "
       "has one in front of all channels"},
      {"bins behind a polariser",
       sensor(R"("polariser": {"angle_deg": 0}, "spectral": {"from_nm": 400, "to_nm": 600, "step_nm": 100})"),
       ErrorCode::scene, "polariser is used with channels only (got spectral)"},
      {"stokes behind a polariser",
       sensor(R"("polariser": {"angle_deg": 0}, "observer": "1931", "stokes": true)"), ErrorCode::scene,
       "/sensor/stokes: error: stokes cannot be combined with polarisers"},
      {"a mosaic", sensor(R"("stokes": true, "channels": {"a": 1, "b": 1}, "mosaic": [["a", "b"]])"),
       ErrorCode::scene, "stokes cannot be combined with a mosaic"},
      {"a read-out",
       sensor(
           R"("stokes": true, "quantum_efficiency": 1, "channels": {"a": 1},
              "readout": {"gain_e_per_dn": 1, "full_well_e": 1000, "bits": 8})"),
       ErrorCode::scene, "stokes cannot be combined with a readout"},
      {"a meter",
       R"({"camera": {"irradiance_probe": {"at": [0, 0, 0], "normal": [0, 0, 1]}},
           "sensor": {"observer": "1931", "stokes": true}})",
       ErrorCode::scene, "an irradiance probe does not record polarisation"},
      {"no kind", lit(R"({"spectrum": 1, "polarised": {"degree": 1}})"), ErrorCode::scene,
       "expected exactly one key (got none, allowed axis, circular)"},
      {"more than all", lit(R"({"spectrum": 1, "polarised": {"axis": [1, 0, 0], "degree": 2}})"),
       ErrorCode::scene,
       "/lights/0/emission/polarised/degree: error: expected a number (got 2, allowed [0, 1])"},
      {"no axis", lit(R"({"spectrum": 1, "polarised": {"axis": [0, 0, 0]}})"), ErrorCode::scene,
       "/lights/0/emission/polarised/axis"},
  };
  expect_refused(faults);
}

}  // namespace
}  // namespace abbe
