#include <filesystem>
#include <fstream>
#include <tuple>

#include <gtest/gtest.h>
#include <unistd.h>

#include "sensor/response/channel.h"
#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

TEST(Response, AQuantumChannelCountsElectrons) {
  // One joule of 500 nm light is lambda/(hc) photons, and a quantum efficiency of 0.6 converts 60 % of them
  // to electrons.
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

// A user's table of a camera.
class CameraTable : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  std::string table(const std::string& unit, const std::string& columns, const std::string& row) {
    std::ofstream(path_) << "# unit: " << unit << "\n# outside: clamp\nwavelength_nm," << columns << "\n400,"
                         << row << "\n700," << row << '\n';
    return path_.string();
  }
  std::string complaint(const std::string& name, std::optional<ResponseKind> kind = {}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(load_camera(name, {}, diagnostics, kind)) << name;
    return diagnostics.text();
  }

  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / ("abbe_camera_" + std::to_string(::getpid()) + ".csv");
};

TEST_F(CameraTable, QuantumEfficienciesAreElectronsPerPhotonUnlessTheirRatiosAloneCount) {
  EXPECT_NE(complaint(table("%", "QE", "5")).find("(got \"%\", allowed fractions of 1)"), std::string::npos);
  EXPECT_NE(complaint(table("1", "QE", "50")).find("(got 50, allowed [-10, 10])"), std::string::npos);
  const std::string colours = table("quantum efficiency [%]", "R,G,B", "5,6,7");
  EXPECT_NE(complaint(colours, ResponseKind::quantum).find("has the wrong unit"), std::string::npos);
  Diagnostics diagnostics;
  EXPECT_TRUE(load_camera(colours, {}, diagnostics, ResponseKind::energy)) << "of no unit";
  EXPECT_TRUE(load_camera(colours, {}, diagnostics, ResponseKind::quantum, ResponseScale::relative));
  EXPECT_TRUE(diagnostics.all().empty()) << diagnostics.text();
}

TEST_F(CameraTable, WavelengthsAreTheFirstColumnAndNoChannel) {
  const auto named = [&](const std::string& columns, const std::string& rows) {
    std::ofstream(path_) << "# unit: 1\n# outside: clamp\n" << columns << '\n' << rows;
    return path_.string();
  };
  for (const auto& [columns, rows, fault] :
       {std::tuple{"R,G,B,wavelength_nm", "1,2,3,400\n1,2,3,700\n",
                   "first column \"R\" (allowed wavelength_nm"},
        std::tuple{"R,wavelength_nm", "1,400\n1,700\n", "first column \"R\" (allowed wavelength_nm"},
        std::tuple{"index,wavelength_nm,R,G,B", "0,400,1,2,3\n1,700,1,2,3\n",
                   "first column \"index\" (allowed"},
        std::tuple{"wavelength_nm,wavelength_um", "400,0.4\n700,0.7\n", "has no channel column"}})
    EXPECT_NE(complaint(named(columns, rows)).find(fault), std::string::npos) << complaint(path_.string());
  Diagnostics diagnostics;
  const auto twice = load_camera(named("wavelength_nm,wavelength_um,R,G", "400,0.4,1,2\n700,0.7,1,2\n"), {},
                                 diagnostics, ResponseKind::energy);
  ASSERT_TRUE(twice) << diagnostics.text();
  ASSERT_EQ(twice->size(), 2U);
  EXPECT_EQ((*twice)[0].name, "R");
  EXPECT_EQ((*twice)[1].weight(550), 2);
}

TEST_F(CameraTable, CurvesWhoseUnitSpeaksOfPhotonsAreWarnedOfUntilTheirResponseIsSaid) {
  const auto warnings = [](const std::string& name, std::optional<ResponseKind> kind) {
    Diagnostics diagnostics;
    EXPECT_TRUE(load_camera(name, {}, diagnostics, kind));
    return diagnostics.all().size();
  };
  for (const char* unit : {"Quantum efficiency", "electrons per photon"}) {
    const std::string colours = table(unit, "R,G,B", "0.5,0.6,0.7");
    EXPECT_EQ(warnings(colours, {}), 1U) << unit;
    EXPECT_EQ(warnings(colours, ResponseKind::energy), 0U) << unit;
    EXPECT_EQ(warnings(colours, ResponseKind::quantum), 0U) << unit;
    EXPECT_EQ(warnings(table(unit, "QE", "0.5"), {}), 0U) << unit;
  }
  EXPECT_EQ(warnings("Nikon_D5100", {}), 0U);
}

TEST(Response, AnUnknownCameraIsReportedWithTheNearestName) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_camera("Nikon_D5101", {}, diagnostics).has_value());
  EXPECT_NE(diagnostics.text().find("Nikon_D5100"), std::string::npos) << diagnostics.text();
}

TEST(Response, TheObserverMeasuresLux) {
  // 1 W/m^2 at 555 nm is nearly 683 lx.
  EXPECT_NEAR(observer_channels(Observer::cie1931)[1].weight(555), 683.002, 0.01);
}

TEST(Response, AnObserverIsNoSensorWithItsNames) {
  for (const Observer which : {Observer::cie1931, Observer::cie1964})
    EXPECT_EQ(standard_observer(observer_channels(which)), which);
  std::vector<Channel> filtered = observer_channels(Observer::cie1931);
  for (Channel& channel : filtered) channel = exposed(behind(channel, FilterStack{Curve(0.5)}), 2);
  EXPECT_EQ(standard_observer(filtered), Observer::cie1931);
  const std::vector<Channel> own{energy_channel("X", band(580, 650)), energy_channel("Y", band(500, 600)),
                                 energy_channel("Z", band(420, 490))};
  EXPECT_EQ(standard_observer(own), std::nullopt);
  EXPECT_EQ(standard_observer(with_peak_efficiency(own, 0.5)), std::nullopt);
}

}  // namespace
}  // namespace abbe
