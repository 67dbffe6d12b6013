#include <gtest/gtest.h>

#include <vector>

#include "materials/bsdf.h"
#include "materials/interface/fresnel.h"
#include "spectral/sources.h"
#include "spectral/wavelength_distribution.h"
#include "transport/path/film_response.h"
#include "transport/path/path_state.h"
#include "transport/path/roulette.h"
#include "transport/path/vertex.h"

namespace abbe {
namespace {

// Strongly uneven distribution of wavelengths: a line over a weak continuum.
WavelengthDistribution uneven_wavelengths() {
  const std::vector<SpectralLine> line{{546, 2, 30}};
  const std::vector<Curve> emission{sum(lines(line), band(400, 700, 1))};
  const std::vector<Curve> response{band(400, 700)};
  return {emission, response};
}

constexpr int kSamples = 1 << 16;

// Mean of an estimator over evenly spaced packets and lobe choices.
template <typename F>
double mean_over(const WavelengthDistribution& distribution, F estimate) {
  double total = 0;
  for (int i = 0; i < kSamples; ++i) {
    const float u = (static_cast<float>(i) + 0.5F) / kSamples;
    const float lobe =
        static_cast<float>(static_cast<unsigned>(i) * 2654435769U >> 8) * 0x1p-24F;  // golden-ratio sequence
    total += estimate(draw_packet(distribution, u), lobe);
  }
  return total / kSamples;
}

struct Found {
  double reflected = 0;
  double transmitted = 0;
};

// Result of one event at a glass surface (index 1.4 to 1.9 over the visible range) for unit spectral
// radiance, integrated over 400 to 700 nm.
Found glass_event(const PathPacket& drawn, float lobe) {
  const SampledSpectrum n =
      SampledSpectrum::map(drawn.wavelengths.lambda_nm, [](float l) { return 1.4F + (700 - l) / 600; });
  const Bsdf glass = DielectricBsdf{n, true};
  const std::optional<BsdfSample> event =
      sample(glass, Imath::V3f(0.8F, 0, 0.6F), {lobe, {0.5F, 0.5F}}, drawn.hero, TransportMode::power);
  PathPacket packet = drawn;
  advance(packet, *event);
  const std::vector<Channel> channels{energy_channel("flat", band(400, 700))};
  double value = 0;
  FilmResponse(channels).expose({}, packet.wavelengths, packet.throughput * (1 / packet.lane_pdf.sum()),
                                [&](const FilmPoint&, std::span<const double> values) { value = values[0]; });
  return event->transmitted ? Found{0, value} : Found{value, 0};
}

TEST(Lanes, ReflectionAndRefractionTogetherKeepAllLightOfAllWavelengths) {
  const double total = mean_over(uneven_wavelengths(), [](const PathPacket& w, float lobe) {
    const Found found = glass_event(w, lobe);
    return found.reflected + found.transmitted;
  });
  EXPECT_NEAR(total, 300, 0.3);
}

TEST(Lanes, ReflectedShareIsTheIntegralOfFresnel) {
  double expected = 0;
  for (double l = 400.5; l < 700; ++l) expected += fresnel_dielectric(0.6, 1.4 + (700 - l) / 600).R();
  const double reflected = mean_over(
      uneven_wavelengths(), [](const PathPacket& w, float lobe) { return glass_event(w, lobe).reflected; });
  EXPECT_NEAR(reflected, expected, expected * 3e-3);
}

TEST(Lanes, ADenominatorWithWavelengthDensitiesWouldBeBiased) {
  // sum_j f_j / sum_k p(lambda_k) P_k is biased: the pdf of wavelengths belongs in the numerator only.
  const double biased = mean_over(uneven_wavelengths(), [](const PathPacket& w, float lobe) {
    const SampledSpectrum n =
        SampledSpectrum::map(w.wavelengths.lambda_nm, [](float l) { return 1.4F + (700 - l) / 600; });
    const auto event = sample(Bsdf(DielectricBsdf{n, true}), Imath::V3f(0.8F, 0, 0.6F), {lobe, {0.5F, 0.5F}},
                              w.hero, TransportMode::power);
    return static_cast<double>(event->weight.sum() / (w.wavelengths.pdf * event->lane_pdf).sum());
  });
  EXPECT_GT(std::abs(biased - 300), 10);
}

TEST(Lanes, SurvivalIsTheSameWhicheverLaneIsTheHero) {
  // With another hero, throughputs and lane pdfs are divided by a common factor.
  PathPacket packet;
  packet.throughput = SampledSpectrum(0.3F) + SampledSpectrum::only(2, 0.2F);
  packet.lane_pdf = SampledSpectrum(0.8F);
  const float q = survival(packet.throughput_estimate(), 1, kPathRouletteExponent);
  packet.throughput *= 1.7F;
  packet.lane_pdf *= 1.7F;
  EXPECT_FLOAT_EQ(survival(packet.throughput_estimate(), 1, kPathRouletteExponent), q);
  EXPECT_FLOAT_EQ(q, 0.5F / 0.8F);
}

}  // namespace
}  // namespace abbe
