#include "sensor/response/channel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "spectral/sources.h"

namespace abbe {
namespace {

double cosine(double deg) {
  return std::cos(deg * std::numbers::pi / 180);
}

SampledSpectrum at(double nm) {
  return SampledSpectrum(static_cast<float>(nm));
}

TEST(InterferenceFilter, ShiftsByTheRefractedCosine) {
  EXPECT_EQ(blue_shift(1.0, 2.0), 1);
  for (const double deg : {5.0, 20.0, 60.0}) {
    // sqrt(1 - sin^2/n^2) is the cosine inside a layer of that index.
    const double inside = std::asin(std::sin(deg * std::numbers::pi / 180) / 2.05);
    EXPECT_NEAR(blue_shift(cosine(deg), 2.05), std::cos(inside), 1e-14) << deg;
  }
}

TEST(InterferenceFilter, MovesTheBandOfAChannel) {
  const FilterStack stack{Curve(0.5), {{band(645, 655), 2.0}}};
  const Channel channel = behind(energy_channel("line", Curve(0.8)), stack);
  EXPECT_NEAR(channel.weight(650), 0.4, 1e-12);
  const auto cos_film = static_cast<float>(cosine(25));
  const double shift = blue_shift(cosine(25), 2.0);
  EXPECT_EQ(weight_at(channel, at(650), 1)[0], 0.4F);
  EXPECT_EQ(weight_at(channel, at(645 * shift + 0.01), cos_film)[0], 0.4F);
  EXPECT_EQ(weight_at(channel, at(645 * shift - 0.01), cos_film)[0], 0);
  EXPECT_EQ(weight_at(channel, at(655 * shift - 0.01), cos_film)[0], 0.4F);
  EXPECT_EQ(weight_at(channel, at(655 * shift + 0.01), cos_film)[0], 0);
}

// Filters with edges one nanometre wide, stacked: a third of a nanometre remains of each edge of two.
TEST(FilterStack, StackedEdgesLetThroughTheAreaOfTheirProduct) {
  const Curve line({{540, 0}, {541, 1}, {549, 1}, {550, 0}});
  const Channel bare = energy_channel("line", line);
  EXPECT_NEAR(behind(bare, {line, {}}).weight.integral(), 8 + 2.0 / 3, 1e-12);
  EXPECT_NEAR(behind(bare, {Curve(1), {{line, 2.0}}}).weight.integral(), 8 + 2.0 / 3, 1e-12);
  const Curve triangle({{545, 0}, {546, 1}, {547, 0}});
  const Channel counted = behind(quantum_channel("line", triangle), {triangle, {}});
  EXPECT_NEAR(counted.weight.integral() * photon_energy(546), 2.0 / 3, 2e-4 * 2 / 3);
}

// A stack on another filter that shifts too, with an exposure of its own, at up to 40 degrees.
Channel stacked() {
  Channel channel = behind(quantum_channel("a", Curve({{400, 0.2}, {700, 0.7}})),
                           {band(500, 690), {{gaussian(600, 30), 1.6}, {band(560, 640.3), 2.1}}});
  channel = exposed(behind(std::move(channel), {Curve(0.9), {}}), 3);
  limit_angles(channel, cosine(40));
  return channel;
}

TEST(InterferenceFilter, AStackWeighsByTheProductOfAll) {
  const Channel channel = stacked();
  EXPECT_EQ(channel.exposure_ratio, 3);
  for (const double deg : {0.0, 17.0, 40.0})
    for (double nm = 520.3; nm < 680; nm += 7) {
      const double a = nm / blue_shift(cosine(deg), 1.6);
      const double b = nm / blue_shift(cosine(deg), 2.1);
      const double expected = (0.2 + 0.5 * (nm - 400) / 300) / photon_energy(nm) * 0.9 * 3 *
                              gaussian(600, 30)(a) * band(560, 640.3)(b);
      EXPECT_NEAR(static_cast<double>(weight_at(channel, at(nm), static_cast<float>(cosine(deg)))[0]),
                  expected, 1e-4 * expected)
          << nm << ' ' << deg;
      if (deg > 0) continue;
      EXPECT_NEAR(channel.weight(nm), expected, 1e-4 * expected);
    }
}

TEST(InterferenceFilter, NothingExceedsItsReachAndTheReachIsNoWider) {
  const Channel channel = stacked();
  double low = 1100;
  double high = 300;
  for (double deg = 0; deg <= 40; deg += 2.5)
    for (double nm = 400.05; nm < 700; nm += 0.1) {
      const auto weight = static_cast<double>(weight_at(channel, at(nm), static_cast<float>(cosine(deg)))[0]);
      EXPECT_LE(weight, envelope(channel)(nm) * (1 + 1e-4)) << nm << ' ' << deg;
      if (weight == 0) continue;
      low = std::min(low, nm);
      high = std::max(high, nm);
    }
  const double first = 560 * blue_shift(cosine(40), 2.1);
  EXPECT_NEAR(low, first, 0.11);
  EXPECT_EQ(envelope(channel)(first - 0.01), 0);
  EXPECT_GT(envelope(channel)(first + 0.01), 0);
  EXPECT_NEAR(high, 640.3, 0.11);
  EXPECT_EQ(envelope(channel)(640.31), 0);
  EXPECT_GT(envelope(channel)(640.29), 0);
}

// Light that fills a cone of numerical aperture sin u evenly has sin^2(theta) uniform in [0, sin^2 u]. A step
// at 600 nm transmits a wavelength if sin^2(theta) < n^2 (1 - (lambda/600)^2).
TEST(InterferenceFilter, TheMeanOverAConeSmoothsAStep) {
  constexpr double kSine2 = 0.25;
  constexpr int kAngles = 400;
  std::vector<Incidence> cone;
  for (int i = 0; i < kAngles; ++i)
    cone.push_back({std::sqrt(1 - kSine2 * (i + 0.5) / kAngles), 1.0 / kAngles});
  const Curve step({{300, 1}, {600, 1}, {600, 0}, {1100, 0}});
  const Channel channel = exposed(behind(energy_channel("step", Curve(0.8)), {Curve(0.5), {{step, 1.7}}}), 2);
  const Channel mean = averaged(channel, cone);
  EXPECT_FALSE(mean.angular);
  EXPECT_EQ(mean.exposure_ratio, 2);
  for (double nm = 560; nm < 605; nm += 1.3) {
    const double open = 1.7 * 1.7 * (1 - nm * nm / (600 * 600)) / kSine2;
    EXPECT_NEAR(mean.weight(nm), 0.8 * std::clamp(open, 0.0, 1.0), 0.8 * 1.5 / kAngles) << nm;
  }
}

TEST(InterferenceFilter, TheMeanOverAnglesIsThatOfWeightAt) {
  const Channel channel = stacked();
  const std::vector<Incidence> angles{{1, 0.2}, {cosine(17), 0.5}, {cosine(33), 0.3}};
  const Channel mean = averaged(channel, angles);
  for (double nm = 501.3; nm < 690; nm += 3.7) {
    double expected = 0;
    for (const Incidence& angle : angles)
      expected += angle.fraction *
                  static_cast<double>(weight_at(channel, at(nm), static_cast<float>(angle.cos_film))[0]);
    EXPECT_NEAR(mean.weight(nm), expected, 5e-4 * channel.weight.max()) << nm;
  }
}

TEST(InterferenceFilter, ChannelsWithoutOneReachTheirWeight) {
  Channel channel = behind(energy_channel("plain", band(400, 500)), {Curve(0.5), {}});
  limit_angles(channel, 0.5);
  EXPECT_FALSE(channel.angular);
  EXPECT_EQ(&envelope(channel), &channel.weight);
  EXPECT_EQ(weight_at(channel, at(450), 0.1F)[0], 0.5F);
  EXPECT_EQ(averaged(channel, std::vector<Incidence>{{0.5, 1}}).weight(450), channel.weight(450));
}

}  // namespace
}  // namespace abbe
