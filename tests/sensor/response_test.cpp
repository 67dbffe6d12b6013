#include <gtest/gtest.h>

#include "sensor/response/channel.h"
#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

TEST(Response, AQuantumChannelCountsElectrons) {
  // One joule of 500 nm light is lambda/(hc) photons; a quantum efficiency of 0.6 turns 60 % of them into
  // electrons.
  const Channel channel = quantum_channel("G", Curve(0.6));
  EXPECT_EQ(channel.kind, ResponseKind::quantum);
  EXPECT_NEAR(channel.weight(500) * photon_energy(500), 0.6, 1e-12);
}

TEST(Response, EnergyChannelsAreTheirResponse) {
  EXPECT_DOUBLE_EQ(energy_channel("R", band(600, 700)).weight(650), 1);
  EXPECT_DOUBLE_EQ(energy_channel("R", band(600, 700)).weight(599.999), 0);
}

TEST(Response, ACameraHasOneChannelPerColumn) {
  Diagnostics diagnostics;
  const auto camera = load_camera("Nikon_D5100", {}, diagnostics);
  ASSERT_TRUE(camera.has_value()) << diagnostics.text();
  ASSERT_EQ(camera->size(), 3U);
  EXPECT_EQ((*camera)[0].name, "R");
  EXPECT_EQ((*camera)[2].name, "B");
  EXPECT_DOUBLE_EQ((*camera)[0].weight(380), 0.001563843);
  EXPECT_EQ((*camera)[1].kind, ResponseKind::energy);
}

TEST(Response, ADetectorIsAQuantumEfficiency) {
  Diagnostics diagnostics;
  const auto detector = load_camera("kodak_kaf-3200me", {}, diagnostics);
  ASSERT_TRUE(detector.has_value()) << diagnostics.text();
  ASSERT_EQ(detector->size(), 1U);
  EXPECT_EQ(detector->front().kind, ResponseKind::quantum);
}

TEST(Response, ACamerasCurvesAreReadAsAsked) {
  Diagnostics diagnostics;
  const auto read = [&](const char* name, std::optional<ResponseKind> kind) {
    return load_camera(name, {}, diagnostics, kind).value().front();
  };
  const Channel counts = read("Nikon_D5100", ResponseKind::quantum);
  EXPECT_EQ(counts.kind, ResponseKind::quantum);
  EXPECT_NEAR(counts.weight(380) * photon_energy(380), 0.001563843, 1e-12);
  EXPECT_EQ(read("Nikon_D5100:R", {}).kind, ResponseKind::energy);
  EXPECT_EQ(read("kodak_kaf-3200me", ResponseKind::energy).weight(300), 0.05);
}

TEST(Response, AnUnknownCameraIsReportedWithTheNearestName) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_camera("Nikon_D5101", {}, diagnostics).has_value());
  EXPECT_NE(diagnostics.text().find("Nikon_D5100"), std::string::npos) << diagnostics.text();
}

TEST(Response, TheObserverMeasuresLux) {
  // 1 W/m^2 at 555 nm is 683 lx, nearly.
  EXPECT_NEAR(observer_channels(Observer::cie1931)[1].weight(555), 683.002, 0.01);
}

}  // namespace
}  // namespace abbe
