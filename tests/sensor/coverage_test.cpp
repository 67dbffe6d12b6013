#include "sensor/response/table_range.h"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "spectral/sources.h"

namespace abbe {
namespace {

TEST(ResponseCoverage, TablesMustCoverWhatChannelsRespondTo) {
  const NeededRange eye = needed_by(observer_channels(Observer::cie1931));
  EXPECT_EQ(eye.low_nm, 380);
  EXPECT_EQ(eye.high_nm, 780);
  const std::array channels{energy_channel("a", band(450, 500)), energy_channel("b", band(600, 1000))};
  EXPECT_EQ(needed_by(channels).low_nm, 380) << "of colour";
  EXPECT_EQ(needed_by(channels).high_nm, 1000);
}

NamedCurve flat_lamp(Outside outside) {
  constexpr std::array kNm{400.0, 700.0};
  constexpr std::array kValues{2.0, 2.0};
  return {"lamp", "", "", kNm.front(), kNm.back(), table_curve(kNm, kValues, outside), outside};
}

// With constant light on [300, 1100] nm, a channel with constant response has 500/800 of its integral outside
// [400, 700] nm. One that transmits only [400, 750] nm has 50/350 there.
TEST(ResponseCoverage, ALightThatEndsWithinWhatChannelsCountIsTold) {
  const std::array channels{energy_channel("red", band(400, 750)), energy_channel("all", Curve(1.0))};
  const auto told = [&](Outside outside, std::span<const Channel> seen) {
    Diagnostics diagnostics;
    const bool covers = check_light_range(flat_lamp(outside), seen, {}, diagnostics);
    EXPECT_EQ(covers, !diagnostics.has_errors());
    return diagnostics.text();
  };
  EXPECT_EQ(told(Outside::zero, channels),
            "warning: \"lamp\" is 0 outside its table, 400 to 700 nm: 62.5 % of the integral for channel "
            "\"all\" would lie there with constant extrapolation; end the table with a row of 0 if it falls "
            "to 0\n");
  EXPECT_NE(
      told(Outside::zero, std::span(channels).first(1)).find("14.3 % of the integral for channel \"red\""),
      std::string::npos);
  EXPECT_NE(told(Outside::error, channels)
                .find("\"lamp\" covers only 400 to 700 nm, but 62.5 % of the integral for channel \"all\" "
                      "lies outside"),
            std::string::npos);
  EXPECT_EQ(told(Outside::clamp, channels), "");
  const std::array within{energy_channel("green", band(500, 600))};
  for (const Outside outside : {Outside::zero, Outside::error}) EXPECT_EQ(told(outside, within), "");
}

// Of 800 bins of 1 nm, those from 830 nm on lie outside. Light and response have no knot there, so each needs
// one piece, and the others none.
TEST(ResponseCoverage, OfABinOnlyWhatItCountsIsLookedAt) {
  const Curve efficiency({{300, 0.2}, {1100, 0.8}});
  const Curve light = planck(5000);
  std::size_t pieces = 0;
  for (int nm = 300; nm < 1100; ++nm) {
    const Channel bin = behind(energy_channel("bin", band(nm, nm + 1)), FilterStack{efficiency});
    const FractionOutside beyond = fraction_outside(bin.weight, light, 300, 830);
    EXPECT_EQ(beyond.fraction, nm < 830 ? 0 : 1) << nm;
    pieces += beyond.pieces;
  }
  EXPECT_EQ(pieces, 270U);
}

/// A user's camera table whose curves are constant from its first row to its last.
class EndedCamera : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  std::string complaint(const std::string& outside, double last) {
    std::ofstream(path_) << "# unit: relative\n"
                         << outside << "wavelength_nm,R\n350,0\n360,1\n1000,1\n1050," << last << '\n';
    Diagnostics diagnostics;
    const auto channels = load_camera(path_.string(), {}, diagnostics);
    EXPECT_EQ(channels.has_value(), !diagnostics.has_errors());
    return diagnostics.text();
  }

  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / ("abbe_ended_" + std::to_string(::getpid()) + ".csv");
};

// 5 + 640 + 50 nm inside, and 50 nm outside.
TEST_F(EndedCamera, SaysWhatHoldsBeyondItsRowsUnlessItHasFallenThere) {
  const std::string told = complaint("", 1);
  EXPECT_NE(
      told.find(":R\" covers only 350 to 1050 nm, but 6.71 % of the integral for channel \"R\" lies outside"),
      std::string::npos)
      << told;
  for (const char* outside : {"# outside: zero\n", "# outside: clamp\n"})
    EXPECT_EQ(complaint(outside, 1), "");
  EXPECT_EQ(complaint("", 0), "");
}

}  // namespace
}  // namespace abbe
