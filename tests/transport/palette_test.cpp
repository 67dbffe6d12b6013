#include "transport/path/palette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sampling/sampler.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

Curve ramp(double height) {
  return Curve(std::vector<Knot>{{400, 0}, {700, height}});
}

// Greys of every slope, more than are kept at once.
Scene many_greys(std::uint32_t count) {
  Scene scene{};
  for (std::uint32_t i = 0; i < count; ++i) {
    scene.materials.push_back({"grey", DiffuseMaterial{SpectralTexture(ramp(1.0 / (i + 1)))}});
    scene.lights.push_back({"lamp", PointLight{}, ramp(i + 1.0)});
  }
  return scene;
}

SampledSpectrum reflected(const Bsdf& bsdf) {
  return std::get<DiffuseBsdf>(bsdf).reflectance;
}

TEST(SharedSpectra, AreThoseOfThePacketWhateverWasKeptBefore) {
  constexpr std::uint32_t kCount = 200;
  const Scene scene = many_greys(kCount);
  const std::vector<Curve> flat{band(400, 700)};
  const WavelengthDistribution distribution(flat, flat);
  SharedSpectra spectra(scene);
  for (const float u : {0.1F, 0.7F}) {
    const SampledWavelengths wavelengths = distribution.sample(u);
    spectra.begin(wavelengths);
    for (int twice = 0; twice < 2; ++twice)
      for (std::uint32_t i = 0; i < kCount; ++i) {
        const Bsdf alone = make_bsdf(scene.materials[i], {wavelengths.lambda_nm});
        EXPECT_TRUE((reflected(spectra.bsdf(i)) - reflected(alone)).is_zero()) << i;
        EXPECT_TRUE((spectra.emission(i) - scene.lights[i].emission(wavelengths.lambda_nm)).is_zero()) << i;
      }
  }
}

// Over all blocks a path has the packets it would have drawn for itself, and each lane is the hero as often.
TEST(Palette, IntegratesAsPacketsOfOnesOwnDo) {
  constexpr std::uint32_t kBlocks = 4096;
  const Scene scene = many_greys(1);
  const std::vector<Curve> uneven{sum(lines(std::vector<SpectralLine>{{546, 2, 30}}), band(400, 700, 1))};
  const std::vector<Curve> response{band(400, 700)};
  const WavelengthDistribution distribution(uneven, response);
  Palette palette(scene, 1);
  double mean = 0;
  double hero = 0;
  for (std::uint32_t i = 0; i < kBlocks; ++i) {
    palette.begin(0, distribution, Sampler(1, Purpose::palette, 0, i, 0).group(0)[0]);
    const auto [packet, spectra] = palette.pick(0, Sampler(1, Purpose::camera, 0, 0, i).group(0)[2]);
    const SampledSpectrum f = spectra->emission(0);
    mean += static_cast<double>((f / packet.wavelengths.pdf).mean()) / kBlocks;
    hero += static_cast<double>(f[packet.hero] / packet.wavelengths.pdf[packet.hero]) / kBlocks;
  }
  EXPECT_NEAR(mean, 150, 0.3);
  EXPECT_NEAR(hero, 150, 1.5);
}

TEST(Palette, PacketsOfABlockLieEvenlyBetweenLanes) {
  const Scene scene = many_greys(1);
  const std::vector<Curve> flat{band(400, 720)};
  Palette palette(scene, 1);
  palette.begin(0, WavelengthDistribution(flat, flat), 0.25F);
  std::vector<float> heroes;
  constexpr int kHeroes = Palette::kPackets * kLanes;
  for (int i = 0; i < kHeroes; ++i) {
    const PathPacket packet = palette.pick(0, (static_cast<float>(i) + 0.5F) / kHeroes).packet;
    heroes.push_back(packet.wavelengths.lambda_nm[packet.hero]);
  }
  for (int i = 0; i < kHeroes; ++i)
    EXPECT_NEAR(heroes[static_cast<std::size_t>(i)], 400 + 320.0 / kHeroes * (i + 0.25), 1e-3) << i;
}

}  // namespace
}  // namespace abbe
