#include "spectral/wavelength_distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <string>

#include "spectral/colorimetry.h"
#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

Curve load(const char* folder, const std::string& name) {
  Diagnostics diagnostics;
  const auto curve = load_curve(folder, name, {}, diagnostics);
  EXPECT_TRUE(curve) << diagnostics.text();
  return curve ? curve->curve : Curve();
}

std::vector<Curve> xyz() {
  const ColorMatching& cmf = color_matching(Observer::cie1931);
  return {cmf.x, cmf.y, cmf.z};
}

Curve mercury(double width_nm) {
  const std::vector<SpectralLine> all = {
      {404.6561, width_nm, 1}, {435.8343, width_nm, 2}, {546.0740, width_nm, 3}, {578.0132, width_nm, 1.5}};
  return lines(all);
}

struct Case {
  std::string name;
  std::vector<Curve> emissions;
  std::vector<Curve> responses;
  double largest_variance;  ///< relative variance of one packet, by its wavelengths only
};

std::vector<Case> cases() {
  const Curve e = load("illuminant", "E");
  const std::vector<Curve> ten = {band(445, 455), band(545, 555), band(645, 655)};
  const std::vector<Curve> boxes = {band(400, 500), band(500, 600), band(600, 700)};
  const Curve qe = load("camera", "kodak_kaf-3200me");
  return {{"XYZ, E", {e}, xyz(), 0.01},
          {"XYZ, FL11", {load("illuminant", "FL11")}, xyz(), 0.01},
          {"XYZ, 1 nm lines", {mercury(1)}, xyz(), 0.03},
          {"XYZ, 1 pm lines", {mercury(1e-3)}, xyz(), 0.03},
          {"3 x 10 nm, E", {e}, ten, 0.04},
          {"1 x 10 nm, E", {e}, {ten[1]}, 1e-3},
          {"3 x 100 nm boxes, A", {load("illuminant", "A")}, boxes, 0.05},
          {"CCD, E and a 1 pm line", {e, mercury(1e-3)}, {qe}, 0.15},
          {"dim E beside strong lines", {scaled(e, 1e-6), scaled(mercury(0.1), 1e6)}, xyz(), 0.1}};
}

TEST(WavelengthDistribution, integrates_to_one_over_its_support) {
  for (const Case& c : cases()) {
    const WavelengthDistribution distribution(c.emissions, c.responses);
    // Midpoints of 1e-4 nm resolve every cell of these cases, except the edges of the lines, which contribute
    // at most 1e-4/1e-3.
    double total = 0;
    for (double nm = 300 + 5e-5; nm < 1100; nm += 1e-4) total += distribution.pdf(nm) * 1e-4;
    EXPECT_NEAR(total, 1, c.name.find("pm") == std::string::npos ? 1e-3 : 0.1) << c.name;
    EXPECT_EQ(distribution.pdf(distribution.low_nm() - 1e-6), 0);
    EXPECT_EQ(distribution.pdf(distribution.high_nm()), 0);
  }
}

TEST(WavelengthDistribution, lanes_carry_the_density_of_their_wavelength) {
  for (const Case& c : cases()) {
    const WavelengthDistribution distribution(c.emissions, c.responses);
    for (int i = 0; i < 20000; ++i) {
      const SampledWavelengths packet = distribution.sample((static_cast<float>(i) + 0.5F) / 20000);
      for (int lane = 0; lane < kLanes; ++lane) {
        const double pdf = distribution.pdf(packet.lambda_nm[lane]);
        ASSERT_NEAR(packet.pdf[lane], pdf, 1e-6 * pdf) << c.name << " at " << packet.lambda_nm[lane];
        ASSERT_GT(pdf, 0);
      }
    }
  }
}

TEST(WavelengthDistribution, samples_follow_the_density) {
  for (const Case& c : cases()) {
    const WavelengthDistribution distribution(c.emissions, c.responses);
    constexpr int kPackets = 100000;
    std::vector<double> counts(800);
    std::vector<double> expected(800);
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
      constexpr int kSteps = 20000;
      for (int i = 0; i < kSteps; ++i) {
        expected[bin] += distribution.pdf(300 + static_cast<double>(bin) + (i + 0.5) / kSteps) / kSteps;
      }
    }
    for (int i = 0; i < kPackets; ++i) {
      const SampledWavelengths packet = distribution.sample((static_cast<float>(i) + 0.5F) / kPackets);
      for (const float nm : packet.lambda_nm.values()) ++counts[static_cast<std::size_t>(nm - 300)];
    }
    // The packets are stratified, so the counts must be much closer than random ones.
    double chi_squared = 0;
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
      const double mean = expected[bin] * kPackets * kLanes;
      if (mean == 0) {
        EXPECT_EQ(counts[bin], 0) << c.name << " " << bin;
        continue;
      }
      chi_squared += (counts[bin] - mean) * (counts[bin] - mean) / mean;
    }
    const boost::math::chi_squared_distribution<> chance(799);
    EXPECT_LT(chi_squared, boost::math::quantile(chance, 0.01)) << c.name;
  }
}

/// Mean and relative variance of the packet estimate of the integral of emission x response.
std::pair<double, double> packet_estimate(const WavelengthDistribution& distribution, const Curve& emission,
                                          const Curve& response) {
  constexpr int kPackets = 1 << 17;
  double sum = 0;
  double sum_of_squares = 0;
  for (int i = 0; i < kPackets; ++i) {
    const SampledWavelengths packet = distribution.sample((static_cast<float>(i) + 0.5F) / kPackets);
    double estimate = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      const double nm = packet.lambda_nm[lane];
      estimate += emission(nm) * response(nm) / packet.pdf[lane] / kLanes;
    }
    sum += estimate;
    sum_of_squares += estimate * estimate;
  }
  const double mean = sum / kPackets;
  return {mean, sum_of_squares / kPackets / (mean * mean) - 1};
}

TEST(WavelengthDistribution, packets_estimate_every_pair_without_bias_and_with_little_noise) {
  for (const Case& c : cases()) {
    const WavelengthDistribution distribution(c.emissions, c.responses);
    double total = 0;
    for (const Curve& emission : c.emissions) {
      for (const Curve& response : c.responses) {
        const auto [mean, variance] = packet_estimate(distribution, emission, response);
        EXPECT_NEAR(mean / integral_of_product(emission, response), 1, 2e-4) << c.name;
        total += variance;
      }
    }
    const double variance = total / static_cast<double>(c.emissions.size() * c.responses.size());
    RecordProperty(c.name, std::to_string(variance));
    EXPECT_LT(variance, c.largest_variance) << c.name;
  }
}

constexpr std::size_t kParts = 16;

// Importance that increases with the wavelength.
std::vector<double> red_importance() {
  std::vector<double> importance;
  for (std::size_t i = 0; i < kParts; ++i) importance.push_back(0.1 + 0.2 * static_cast<double>(i));
  return importance;
}

// Each part of the distribution then has its importance divided by the sum of all, 25.6.
TEST(WavelengthDistribution, parts_are_drawn_as_often_as_they_weigh) {
  const Case smooth = cases().front();
  const WavelengthDistribution plain(smooth.emissions, smooth.responses);
  const WavelengthDistribution weighed = plain.weighted(red_importance());
  EXPECT_EQ(weighed.low_nm(), plain.low_nm());
  EXPECT_EQ(weighed.high_nm(), plain.high_nm());
  std::vector<float> ends;
  for (std::size_t i = 1; i < kParts; ++i)
    ends.push_back(plain.sample(static_cast<float>(i) / kParts).lambda_nm[0]);
  constexpr int kPackets = 1 << 16;
  std::vector<double> counts(kParts);
  for (int i = 0; i < kPackets; ++i) {
    const float nm = weighed.sample((static_cast<float>(i) + 0.5F) / kPackets).lambda_nm[0];
    ++counts[static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), nm) - ends.begin())];
  }
  for (std::size_t i = 0; i < kParts; ++i)
    EXPECT_NEAR(counts[i] / kPackets, red_importance()[i] / 25.6, 1.5e-3) << i;
}

TEST(WavelengthDistribution, weighed_packets_estimate_every_pair_without_bias) {
  for (const Case& c : cases()) {
    const WavelengthDistribution weighed =
        WavelengthDistribution(c.emissions, c.responses).weighted(red_importance());
    for (const Curve& emission : c.emissions)
      for (const Curve& response : c.responses)
        EXPECT_NEAR(
            packet_estimate(weighed, emission, response).first / integral_of_product(emission, response), 1,
            1e-3)
            << c.name;
  }
}

TEST(WavelengthDistribution, starves_no_pair) {
  // Each of the six pairs has at least 0.95/6 of its own density, however weak its light.
  const Curve e = load("illuminant", "E");
  const std::vector<Curve> emissions = {scaled(e, 1e-6), scaled(mercury(0.1), 1e6)};
  const std::vector<Curve> responses = xyz();
  const WavelengthDistribution distribution(emissions, responses);
  for (const Curve& emission : emissions) {
    for (const Curve& response : responses) {
      const double integral = integral_of_product(emission, response);
      for (double nm = 400.5; nm < 700; ++nm) {
        EXPECT_GE(distribution.pdf(nm), 0.95 / 6 * emission(nm) * response(nm) / integral * 0.999) << nm;
      }
    }
  }
}

TEST(WavelengthDistribution, equal_lamps_count_once) {
  const Curve e = load("illuminant", "E");
  const Curve hg = mercury(1);
  const std::vector<Curve> responses = {xyz()[1]};
  const std::vector<Curve> two = {e, hg};
  const std::vector<Curve> many = {e, scaled(e, 3), e, scaled(e, 1e-3), hg};
  const WavelengthDistribution few(two, responses);
  const WavelengthDistribution crowd(many, responses);
  for (const double nm : {450.5, 546.0, 546.3, 600.5}) EXPECT_NEAR(crowd.pdf(nm), few.pdf(nm), 1e-12);
}

TEST(WavelengthDistribution, narrow_lines_hand_out_wavelengths_inside) {
  const std::vector<SpectralLine> line = {{546.0740, 1e-3, 1}};
  const std::vector<Curve> emissions = {lines(line)};
  const std::vector<Curve> responses = {Curve(1)};
  const WavelengthDistribution distribution(emissions, responses);
  int inside = 0;
  for (int i = 0; i < 4096; ++i) {
    const SampledWavelengths packet = distribution.sample((static_cast<float>(i) + 0.5F) / 4096);
    for (const float nm : packet.lambda_nm.values()) inside += emissions[0](nm) > 0 ? 1 : 0;
  }
  EXPECT_NEAR(inside / 32768.0, 0.95, 1e-3);
}

TEST(WavelengthDistribution, support_is_that_of_the_channels) {
  const std::vector<Curve> emissions = {Curve(1)};
  const std::vector<Curve> responses = {band(410.5, 420), band(690, 701.25)};
  const WavelengthDistribution distribution(emissions, responses);
  EXPECT_EQ(distribution.low_nm(), 410.5);
  EXPECT_EQ(distribution.high_nm(), 701.25);
  EXPECT_EQ(distribution.pdf(500), 0);
  EXPECT_GT(distribution.pdf(410.5), 0);
  EXPECT_GT(distribution.pdf(701.2), 0);
}

TEST(WavelengthDistribution, without_overlap_is_uniform_over_the_channels) {
  const std::vector<Curve> emissions = {band(900, 950)};
  const std::vector<Curve> responses = {band(400, 450), band(600, 650)};
  const WavelengthDistribution distribution(emissions, responses);
  EXPECT_NEAR(distribution.pdf(425), 0.01, 1e-12);
  EXPECT_NEAR(distribution.pdf(625), 0.01, 1e-12);
  EXPECT_EQ(distribution.pdf(500), 0);
  const WavelengthDistribution nothing({}, {});
  EXPECT_NEAR(nothing.pdf(700), 1.0 / 800, 1e-15);
}

TEST(WavelengthDistribution, signed_responses_count_by_magnitude) {
  const std::vector<Curve> emissions = {Curve(1)};
  const std::vector<Curve> responses = {sum(band(500, 600), band(600, 700, -1))};
  const WavelengthDistribution distribution(emissions, responses);
  EXPECT_NEAR(distribution.pdf(550), 0.005, 1e-12);
  EXPECT_NEAR(distribution.pdf(650), 0.005, 1e-12);
}

}  // namespace
}  // namespace abbe
