#include "sensor/response/channel.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "sensor/response/polarised_channels.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

// Linearly polarised light of intensity 1 whose field oscillates at this angle.
StokesSpectrum swinging_at(double angle_deg) {
  const double twice = angle_deg * std::numbers::pi / 90;
  return {SampledSpectrum(1.0F), SampledSpectrum(static_cast<float>(std::cos(twice))),
          SampledSpectrum(static_cast<float>(std::sin(twice))), SampledSpectrum(0.0F)};
}

double passed(const Polariser& polariser, const StokesSpectrum& light, double nm) {
  const SampledSpectrum at(static_cast<float>(nm));
  const double told = static_cast<double>(measured(row_of(analyser_of(polariser), at), light)[3]);
  return mean_transmittance(polariser)(nm) * told;
}

TEST(Polariser, PassesByTheSquareOfTheCosine) {
  for (const double axis : {0.0, 30.0, 90.0, 135.0})
    for (const double field : {0.0, 20.0, 75.0, 120.0})
      EXPECT_NEAR(passed({axis, Curve(0.8)}, swinging_at(field), 500),
                  0.8 * std::pow(std::cos((field - axis) * std::numbers::pi / 180), 2), 1e-6)
          << axis << ' ' << field;
  EXPECT_NEAR(passed({40, Curve(0.8)}, {SampledSpectrum(1.0F)}, 500), 0.4, 1e-7) << "unpolarised";
  StokesSpectrum circular{SampledSpectrum(1.0F)};
  circular.v = SampledSpectrum(1.0F);
  EXPECT_NEAR(passed({40, Curve(0.8)}, circular, 500), 0.4, 1e-7);
}

// Across the axis the extinction ratio counts, at every wavelength, also between the samples of its table.
TEST(Polariser, LeaksByItsExtinctionRatio) {
  const Curve transmittance({{400, 0.6}, {800, 0.9}});
  const Polariser polariser{25, transmittance, Curve({{400, 10}, {800, 1000}})};
  for (const double nm : {400.0, 437.0, 600.0, 800.0}) {
    const double ratio = 10 + 990 * (nm - 400) / 400;
    EXPECT_NEAR(passed(polariser, swinging_at(25), nm), transmittance(nm), 1e-6) << nm;
    EXPECT_NEAR(passed(polariser, swinging_at(115), nm), transmittance(nm) / ratio, 1e-6) << nm;
    EXPECT_NEAR(passed(polariser, {SampledSpectrum(1.0F)}, nm), transmittance(nm) * (1 + 1 / ratio) / 2, 1e-6)
        << nm;
  }
}

TEST(Polariser, StandsBeforeAChannelAndItsFilters) {
  const Polariser polariser{0, Curve(0.5)};
  const FilterStack line{Curve(1.0), {{band(645, 655), 2.0}}};
  const Channel channel = behind(behind(energy_channel("a", Curve(0.8)), line), polariser);
  ASSERT_TRUE(channel.analyser);
  EXPECT_EQ(channel.analyser->q, 1);
  EXPECT_NEAR(channel.weight(650), 0.8 * 0.25, 1e-12);
  EXPECT_NEAR(static_cast<double>(weight_at(channel, SampledSpectrum(650.0F), 1)[0]), 0.8 * 0.25, 1e-7);
  EXPECT_EQ(scaled(exposed(channel, 2), 3).analyser->q, 1);
}

TEST(PolariserRows, TellWhatChannelsOfOneResponseCount) {
  const Channel flat = energy_channel("a", Curve(0.5));
  Channel other = energy_channel("b", band(400, 500));
  std::vector<Channel> channels{flat, behind(flat, Polariser{0}), behind(scaled(flat, 3), Polariser{45}),
                                behind(other, Polariser{0, Curve(0.8), Curve(3.0)})};
  channels[1].name = "a0";
  channels[2].name = "a45";
  const auto rows = polariser_rows(channels);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_FALSE(rows[0]) << "it lies behind none";
  EXPECT_EQ(rows[1]->group, "a0");
  EXPECT_NEAR(rows[1]->weight, 1, 1e-12);
  EXPECT_NEAR(rows[1]->q, 1, 1e-7);
  EXPECT_EQ(rows[2]->group, "a0");
  EXPECT_NEAR(rows[2]->weight, 3, 1e-9);
  EXPECT_NEAR(rows[2]->u, 1, 1e-7);
  EXPECT_EQ(rows[3]->group, "b") << "of another response";
  EXPECT_NEAR(rows[3]->q, 0.5, 1e-7);
  const auto read = parse_polariser_row(to_text(*rows[2]));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->group, "a0");
  EXPECT_EQ(read->weight, rows[2]->weight);
  EXPECT_EQ(read->q, rows[2]->q);
  EXPECT_EQ(read->u, rows[2]->u);
  for (const char* words : {"", "a 1 0", "a x 0 0", "a 0 1 0", "a 1 0 0 0"})
    EXPECT_FALSE(parse_polariser_row(words)) << words;
  EXPECT_FALSE(polariser_rows(with_stokes({flat})).back());
}

TEST(StokesChannels, MeasureEachComponentByTheSameResponse) {
  const std::vector<Channel> two{energy_channel("a", Curve(2.0)), energy_channel("b", Curve(3.0))};
  EXPECT_FALSE(any_analyser(two));
  const std::vector<Channel> all = with_stokes(two);
  EXPECT_TRUE(any_analyser(all));
  ASSERT_EQ(all.size(), 8U);
  const StokesSpectrum light{SampledSpectrum(7.0F), SampledSpectrum(0.5F), SampledSpectrum(-0.25F),
                             SampledSpectrum(0.125F)};
  const std::array names{"a", "b", "S1.a", "S1.b", "S2.a", "S2.b", "S3.a", "S3.b"};
  const std::array expected{7.0F, 7.0F, 0.5F, 0.5F, -0.25F, -0.25F, 0.125F, 0.125F};
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(all[k].name, names.at(k));
    EXPECT_EQ(all[k].weight(500), k % 2 == 0 ? 2 : 3);
    EXPECT_EQ(count_intensities({&all[k], 1}), k < 2 ? 1U : 0U);
    EXPECT_EQ(intensities(std::vector<std::string>{all[k].name}).size(), k < 2 ? 1U : 0U);
    if (k < 2) continue;
    EXPECT_EQ(measured(row_of(*all[k].analyser, SampledSpectrum(500.0F)), light)[0], expected.at(k));
  }
  EXPECT_EQ(intensities(all).size(), 2U);
  EXPECT_EQ(count_intensities(all), 2U);
  EXPECT_EQ(intensities(std::vector<std::string>{"a", "S1.a", "S9.a"}),
            (std::vector<std::string>{"a", "S9.a"}));
}

}  // namespace
}  // namespace abbe
