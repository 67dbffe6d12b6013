#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>

#include <fmt/format.h>

#include "calibration/chart/exposure_series.h"
#include "io/exr.h"
#include "tests/calibration/response_fixture.h"
#include "tests/tier.h"

// Bias due to noise in simulated photographs: noise of the light before the response, as in a camera, or of
// the codes.

namespace abbe::test {
namespace {

namespace fs = std::filesystem;

constexpr int kEdge = 10;
constexpr int kPatches = 24;

enum class Noise { of_light, of_codes };

/// A camera of 20 000 electrons at full scale, with 12 bits.
struct Photographer {
  PlantedResponse response;
  double read = 0.001;  ///< Deviation in the dark, of full scale.
  Noise noise = Noise::of_light;
  std::optional<double> defect = {};  ///< The code of one pixel of each region.
  double electrons = 20000;           ///< At full scale.
  int bits = 12;

  [[nodiscard]] double pixel(double light, double normal) const {
    const double deviation = std::sqrt(light / electrons + read * read);
    double code = response.code(light + deviation * normal);
    if (noise == Noise::of_codes) {
      const double slope = (response.code(light + 1e-6) - response.code(light)) / 1e-6;
      code = std::clamp(response.code(light) + std::min(0.05, slope * deviation) * normal, 0.0, 1.0);
    }
    const double highest = std::exp2(bits) - 1;
    return std::round(code * highest) / highest;
  }
};

class PhotographedNoise : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  // Patches between 0.5 and 90 % of full scale in one second, each of kEdge x kEdge pixels, in a row.
  ExposureSeries photograph(const Photographer& camera, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> level(std::log(0.005), std::log(0.9));
    std::vector<double> values(kPatches);
    for (double& value : values) value = std::exp(level(random));
    std::string exposures;
    for (const double time : stops(-6, 3, 1)) {
      Image image{kPatches * kEdge, kEdge, {{"Y", {}}}, {}};
      for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kPatches * kEdge; ++x) {
          const double code =
              camera.pixel(values[static_cast<std::size_t>(x / kEdge)] * time, normal(random));
          const bool is_defective = camera.defect && x % kEdge == 5 && y == 5;
          image.channels[0].values.push_back(static_cast<float>(is_defective ? *camera.defect : code));
        }
      const std::string name = fmt::format("{}.exr", time);
      write_exr(folder_ / name, image);
      exposures += fmt::format("{{\"file\": \"{}\", \"exposure_s\": {}}},", name, time);
    }
    std::string regions;
    for (int i = 0; i < kPatches; ++i)
      regions += fmt::format("[{}, 0, {}, {}],", i * kEdge, (i + 1) * kEdge, kEdge);
    std::ofstream(folder_ / "series.json") << "{\"bits\": " << camera.bits << ", \"exposures\": ["
                                           << exposures << "], \"regions\": [" << regions << "]}";
    Diagnostics diagnostics;
    auto all = read_series(folder_ / "series.json", diagnostics);
    EXPECT_TRUE(all) << diagnostics.text();
    return all ? all->series.at(0) : ExposureSeries{};
  }

  // Fraction of dark codes at which the interval contains the planted exposure.
  static double dark_coverage(const ResponseFit& fit, const PlantedResponse& planted) {
    int inside = 0;
    for (int i = 100; i < 300; ++i) {
      const double error = std::abs(std::log(exposure_ratio(fit, planted, i / 1000.0)));
      inside += error <= 1.96 * linearise(fit.log_deviation, i / 1000.0) ? 1 : 0;
    }
    return inside / 200.0;
  }

  // Expects the mean relative error of a code's exposure over many series to agree with its scatter. The
  // intervals must contain the planted curve as often as they state.
  void expect_unbiased(const char* name, double read, Noise noise) {
    const Photographer camera{PlantedResponse(name), read, noise};
    const int seeds = nightly() ? 80 : 8;
    const std::array codes{0.1, 0.15, 0.2, 0.3};
    std::array<double, codes.size()> sums{};
    std::array<double, codes.size()> squares{};
    double covered = 0;
    double dark = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const ResponseFit fit = recover_response(photograph(camera, static_cast<std::uint64_t>(seed)));
      covered += coverage(fit, camera.response) / seeds;
      dark += dark_coverage(fit, camera.response) / seeds;
      for (std::size_t i = 0; i < codes.size(); ++i) {
        const double error = std::log(exposure_ratio(fit, camera.response, codes[i]));
        sums[i] += error / seeds;
        squares[i] += error * error / seeds;
      }
    }
    for (std::size_t i = 0; i < codes.size(); ++i) {
      const double scatter = std::sqrt(std::max(0.0, squares[i] - sums[i] * sums[i]) / (seeds - 1));
      EXPECT_LT(std::abs(sums[i]), 4.5 * scatter) << name << " at code " << codes[i];
    }
    const std::string told =
        fmt::format("{} {} {}", name, read, noise == Noise::of_light ? "light" : "codes");
    RecordProperty("coverage of " + told, std::to_string(covered));
    RecordProperty("coverage in the dark of " + told, std::to_string(dark));
    EXPECT_GE(covered, nightly() ? 0.90 : 0.85) << told;
    EXPECT_GE(dark, nightly() ? 0.90 : 0.85) << told;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("abbe_noise_" + std::to_string(::getpid()));
};

// The mean of codes after a response curve is not the code of the mean light.
TEST_F(PhotographedNoise, OfLightBeforeTheCurveLeavesNoBias) {
  expect_unbiased("gamma:2.2", 0.001, Noise::of_light);
  expect_unbiased("gamma:2.2", 0.0003, Noise::of_light);
  expect_unbiased("s-curve", 0.001, Noise::of_light);
}

TEST_F(PhotographedNoise, OfCodesBehindTheCurveLeavesNoBias) {
  expect_unbiased("gamma:2.2", 0.001, Noise::of_codes);
  expect_unbiased("linear", 0.001, Noise::of_codes);
}

// In quiet regions, codes scatter by less than a step and take one or two values. One hot or warm pixel in a
// hundred does not count as the other value of a step.
TEST_F(PhotographedNoise, DefectivePixelsOfQuietRegionsAreNoSteps) {
  Photographer camera{PlantedResponse("linear"), 4e-5};
  camera.electrons = 5e5;
  camera.bits = 8;
  for (const std::optional<double>& defect : {std::optional<double>(), {0.0}, {60.0 / 255}, {1.0}}) {
    camera.defect = defect;
    constexpr std::uint64_t kSeeds = 8;
    const std::array codes{5.0, 10.0, 20.0};
    std::array<double, codes.size()> errors{};
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const ResponseFit fit = recover_response(photograph(camera, seed));
      for (std::size_t i = 0; i < codes.size(); ++i)
        errors[i] += std::log(exposure_ratio(fit, camera.response, codes[i] / 255)) / kSeeds;
    }
    for (std::size_t i = 0; i < codes.size(); ++i)
      EXPECT_NEAR(errors[i], 0, 0.02) << "code " << codes[i] << ", a pixel of " << defect.value_or(-1);
  }
}

// One defective pixel of the hundred in each region, at either end of the scale.
TEST_F(PhotographedNoise, OneDefectivePixelOfARegionIsNoFault) {
  Photographer camera{PlantedResponse("gamma:2.2")};
  const ExposureSeries sound = photograph(camera, 1);
  const double worst = worst_error(recover_response(sound), camera.response);
  for (const double defect : {0.0, 1.0}) {
    camera.defect = defect;
    const ExposureSeries series = photograph(camera, 1);
    double shift = 0;
    double samples = 0;
    for (std::size_t i = 0; i < series.codes.size(); ++i)
      for (std::size_t j = 0; j < series.times_s.size(); ++j) {
        const double deviation = sound.deviations[i][j];
        if (!(sound.codes[i][j] > 0.1 && sound.codes[i][j] < 0.95)) continue;  // beside what noise does
        shift += (series.codes[i][j] - sound.codes[i][j]) / deviation;
        samples += 1;
        EXPECT_NEAR(series.deviations[i][j], deviation, 0.1 * deviation) << defect;
      }
    EXPECT_NEAR(shift / samples, 0, 0.05) << defect;
    EXPECT_LT(worst_error(recover_response(series), camera.response), worst + 5e-4) << defect;
  }
}

}  // namespace
}  // namespace abbe::test
