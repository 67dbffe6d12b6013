#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include "cli/query.h"
#include "materials/interface/fresnel.h"
#include "tests/cli/json_output.h"
#include "tests/materials/fresnel_amplitudes.h"

namespace abbe::test {
namespace {

TEST(QueryReflectance, TellsThePhasesOfBothFields) {
  const auto phase = [](const std::complex<double>& amplitude) {
    return std::fmod(std::arg(amplitude) * 180 / std::numbers::pi + 360, 360);
  };
  const json silver = json_output(cli::query_reflectance, {"Ag_Johnson", {550}, {0, 70}});
  const json index = json_output(cli::query_ior, {"Ag_Johnson", {550}});
  const std::complex<double> n(index["n"].get<double>(), index["k"].get<double>());
  for (std::size_t i = 0; i < 2; ++i) {
    const FresnelAmplitudes f = fresnel_amplitudes(std::cos(i == 0 ? 0 : 70 * std::numbers::pi / 180), n);
    EXPECT_NEAR(silver["phase_s_deg"][i].get<double>(), phase(f.rs), 1e-9);
    EXPECT_NEAR(silver["phase_p_deg"][i].get<double>(), phase(f.rp), 1e-9);
  }
  // The phase for glass changes by half a turn at Brewster's angle, 56.7 degrees.
  const json glass = json_output(cli::query_reflectance, {"N-BK7", {550}, {0, 56, 57}});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(glass["phase_s_deg"][i].get<double>(), 180, 1e-4);
    EXPECT_NEAR(glass["phase_p_deg"][i].get<double>(), i < 2 ? 0 : 180, 1e-4);
  }
  const json coated =
      json_output(cli::query_reflectance, {"Ag_Johnson", {550}, {70}, false, "Ag_Johnson:50"});
  EXPECT_NEAR(coated["phase_p_deg"].get<double>(), silver["phase_p_deg"][1].get<double>(), 1e-9)
      << "silver on silver is silver";
}

}  // namespace
}  // namespace abbe::test
