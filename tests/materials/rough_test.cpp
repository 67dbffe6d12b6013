#include "materials/bsdf/rough.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "materials/bsdf/warp.h"
#include "materials/interface/fresnel.h"
#include "tests/materials/bsdf_examples.h"
#include "tests/materials/facet_shapes.h"
#include "tests/tier.h"

namespace abbe {
namespace {

using Imath::V2f;
using Imath::V3f;

constexpr float kFullTurn = 2 * std::numbers::pi_v<float>;

// Point i of a uniform sequence in three dimensions: multiples of the powers of a generalised golden ratio.
BsdfRandom event(int i) {
  const auto part = [i](double step) {
    const double x = 0.5 + step * i;
    return std::min(static_cast<float>(x - std::floor(x)), 0x1.fffffep-1F);
  };
  return {part(0.8191725133961645), {part(0.6710436067037893), part(0.5497004779019703)}};
}

// Mean of the light from `wo` at the wavelength `lane`, weighted by `light`, over events sampled by it.
using LightField = std::function<double(const V3f&)>;
double leaving(const Bsdf& bsdf, const V3f& wo, int lane, const LightField& light, int events = 1 << 15) {
  double sum = 0;
  for (int i = 0; i < events; ++i)
    if (const auto s = sample(bsdf, wo, event(i), lane, TransportMode::power))
      sum += static_cast<double>(s->weight[lane]) * light(s->wi);
  return sum / events;
}
double all(const V3f& /*wi*/) {
  return 1;
}

std::vector<Microfacets<float>> furnace_facets() {
  std::vector<Microfacets<float>> facets;
  for (const FacetShape shape : kFacetShapes) {
    for (const float alpha : {1e-3F, 3e-3F, 0.01F, 0.03F, 0.1F, 0.2F, 0.4F, 0.7F, 1.0F})
      facets.push_back({shape, alpha, alpha});
    facets.push_back({shape, 0.1F, 0.4F});
    facets.push_back({shape, 0.8F, 0.04F});
    facets.push_back({shape, 0.05F, 0.5F});
  }
  return facets;
}
const auto kCosines = {1.0, 0.8, 0.5, 0.2, 0.05, 3e-3};

TEST(RoughConductor, PerfectMirrorLosesNothing) {
  double worst = 0;
  const int events = test::nightly() ? 1 << 15 : 1 << 13;
  for (const auto& facets : furnace_facets()) {
    const RoughConductorMaterial mirror("mirror", RefractiveIndex(0, 1), facets);
    const Bsdf bsdf = mirror.bsdf({packet()});
    for (const double cos : kCosines) {
      const double albedo = leaving(bsdf, direction_at(cos, 0.5 + cos), 0, all, events);
      worst = std::max(worst, std::abs(albedo - 1));
      EXPECT_NEAR(albedo, 1, 5e-3) << facets.alpha_x << " " << facets.alpha_y << " cos " << cos;
    }
  }
  std::printf("largest error of a mirror %.2g\n", worst);
}

// Runs that are not nightly use one index for each kind of facets, in turn.
std::vector<float> indices_for(std::size_t facets) {
  const std::vector<float> all{1.33F, 1.5F, 2.4F, 0.7F};
  return test::nightly() ? all : std::vector{all[facets % all.size()]};
}

TEST(RoughDielectric, LosslessMatterLosesNothing) {
  double worst = 0;
  std::size_t count = 0;
  for (const auto& facets : furnace_facets())
    for (const float n : indices_for(count++)) {
      const RoughInterface surface(facets, n, n);
      const Bsdf bsdf = RoughDielectricBsdf{SampledSpectrum(n), &surface};
      for (const double cos : {1.0, 0.6, 0.15, -1.0, -0.7, -0.3, -0.02}) {
        const double albedo = leaving(bsdf, direction_at(cos, 0.5 + cos), 0, all, 1 << 12);
        worst = std::max(worst, std::abs(albedo - 1));
        EXPECT_NEAR(albedo, 1, facets.alpha_x == facets.alpha_y ? 1e-2 : 2e-2)
            << facets.alpha_x << " " << facets.alpha_y << " n " << n << " cos " << cos;
      }
    }
  std::printf("largest error of a dielectric %.2g\n", worst);
}

// Indices between those of the table.
TEST(RoughDielectric, LosesNothingAtAnyIndexOfItsRange) {
  const RoughInterface surface({FacetShape::ggx, 0.8F, 0.8F}, 1.4F, 2.0F);
  const Bsdf bsdf = RoughDielectricBsdf{ramp(1.4F, 2.0F), &surface};
  for (int lane = 0; lane < kLanes; ++lane)
    for (const double cos : {0.7, -0.5}) EXPECT_NEAR(leaving(bsdf, direction_at(cos, 1), lane, all), 1, 4e-3);
}

// Albedo of single and multiple scattering at the wavelength of index n: single scattering by its own
// quadrature, the rest of `eval` over all directions.
double evaluated_albedo(const RoughDielectricBsdf& bsdf, const V3f& wo, int lane) {
  const bool inside = wo.z < 0;
  const float eta = inside ? 1 / bsdf.n[lane] : bsdf.n[lane];
  double single = 0;
  dielectric_energies(bsdf.surface->facets, {wo.x, wo.y, std::abs(wo.z)}, std::array{eta},
                      std::span(&single, 1));
  constexpr int kDirections = 1 << 12;
  double multiple = 0;
  for (int i = 0; i < kDirections; ++i) {
    V3f wi = cosine_hemisphere(event(i).direction);
    for (int side = 0; side < 2; ++side, wi.z = -wi.z)
      multiple += static_cast<double>(bsdf.eval(wo, wi, TransportMode::power)[lane] *
                                      (1 - bsdf.single_fraction(wo, wi)[lane])) *
                  std::numbers::pi / kDirections;
  }
  return single + multiple;
}

constexpr std::array kMediumIndices{1.0, 1.33, 1.7, 2.4};
constexpr std::array kMediumAlphas{0.1F, 0.2F, 0.5F, 1.0F};

// Glass in a medium, and a cavity of that medium in glass.
TEST(RoughDielectric, LosesNothingInAnyMedium) {
  double worst = 0;
  for (const double medium_index : kMediumIndices)
    for (const float alpha : kMediumAlphas)
      for (const bool cavity : {false, true}) {
        const RefractiveIndex glass(1.5);
        const RefractiveIndex medium(medium_index);
        RoughDielectricMaterial material("n", cavity ? medium : glass, {FacetShape::ggx, alpha, alpha});
        material.tabulate_in(cavity ? glass : medium);
        const RoughDielectricBsdf bsdf =
            material.bsdf({.wavelengths_nm = packet(), .outside = cavity ? &glass : &medium});
        for (const double cos : {1.0, 0.6, 0.15, -1.0, -0.6, -0.15}) {
          const double albedo = evaluated_albedo(bsdf, direction_at(cos, 0.5 + cos), 3);
          worst = std::max(worst, std::abs(albedo - 1));
          EXPECT_NEAR(albedo, 1, 1e-2)
              << medium_index << (cavity ? " in" : " around") << " alpha " << alpha << " cos " << cos;
        }
      }
  std::printf("largest error in a medium %.2g\n", worst);
}

// The relative index crosses 1 within the packet, or comes close to it. There the energy of single scattering
// changes within a hundredth of the index, faster for smoother surfaces.
TEST(RoughDielectric, LosesNothingWhereIndicesCross) {
  double worst = 0;
  for (const float alpha : {0.1F, 0.3F, 0.8F})
    for (const auto& [low, high] : {std::pair(0.95F, 1.05F), std::pair(1.002F, 1.04F)}) {
      const RoughInterface surface({FacetShape::ggx, alpha, alpha}, low, high);
      const RoughDielectricBsdf bsdf{ramp(low, high), &surface};
      for (int lane = 0; lane < kLanes; ++lane)
        for (const double cos : {0.7, 0.1, -0.1, -0.5}) {
          const double albedo = evaluated_albedo(bsdf, direction_at(cos, 1), lane);
          worst = std::max(worst, std::abs(albedo - 1));
          EXPECT_NEAR(albedo, 1, 6e-3) << "alpha " << alpha << " n " << bsdf.n[lane] << " cos " << cos;
        }
    }
  std::printf("largest error where indices cross %.2g\n", worst);
}

TEST(RoughDielectric, HasATableForEachRelativeIndex) {
  const RefractiveIndex water(1.33);
  RoughDielectricMaterial glass("n", RefractiveIndex(1.5), {FacetShape::ggx, 0.5F, 0.5F});
  glass.tabulate_in(RefractiveIndex(1));
  EXPECT_TRUE(glass.surfaces_in_media.empty()) << "that of air holds";
  for (int i = 0; i < 2; ++i) glass.tabulate_in(water);
  glass.tabulate_in(RefractiveIndex(2));
  ASSERT_EQ(glass.surfaces_in_media.size(), 2U);
  EXPECT_FLOAT_EQ(glass.surfaces_in_media[1]->low_n, 0.75F);
  const auto in_water = glass.bsdf({.wavelengths_nm = packet(), .outside = &water});
  EXPECT_EQ(in_water.surface, glass.surfaces_in_media[0].get());
  EXPECT_EQ(glass.bsdf({packet()}).surface, glass.surface.get());
}

// The throughput of a path is a product of weights, which must not scatter. Light leaves a ball of index 4
// after about twenty events.
TEST(RoughDielectric, WeightsAreOneHoweverHighTheIndex) {
  double largest = 0;
  for (const float n : {1.33F, 1.5F, 2.4F, 4.0F, 0.7F, 0.25F})
    for (const float alpha : kMediumAlphas) {
      const RoughInterface surface({FacetShape::ggx, alpha, alpha}, n, n);
      const Bsdf bsdf = RoughDielectricBsdf{SampledSpectrum(n), &surface};
      for (const double cos : {1.0, 0.7, 0.3, 0.05, -1.0, -0.7, -0.3, -0.05})
        for (int i = 0; i < 256; ++i) {
          const auto s = sample(bsdf, direction_at(cos, 0.5 + cos), event(i), 3, TransportMode::power);
          ASSERT_TRUE(s) << "n " << n << " alpha " << alpha << " cos " << cos;
          largest = std::max(largest, static_cast<double>(s->weight[3]));
          EXPECT_GT(s->weight[3], 0.9) << "n " << n << " alpha " << alpha << " cos " << cos;
        }
    }
  std::printf("largest weight of a dielectric %.3f\n", largest);
  EXPECT_LT(largest, 1.1);
}

// For facets of small slope, single scattering loses about alpha^2 (1 + tan^2), so the tables may add no
// more. A perfect mirror has an albedo of at most 1.
TEST(RoughConductor, OfLittleRoughnessReflectsNoMoreThanAll) {
  for (const FacetShape shape : kFacetShapes) {
    for (const float alpha : {1e-3F, 5e-3F, 0.02F}) {
      const Microfacets<float> facets{shape, alpha, alpha};
      const EnergyCompensation lost = RoughMetal(facets).lost;
      for (const double cos : {1.0, 0.8, 0.5, 0.2, 0.05}) {
        const double alpha2 = static_cast<double>(alpha * alpha);
        EXPECT_LT(lost.at(EnergyCompensation::table_coordinates(facets, direction_at(cos, 1))),
                  alpha2 * (4 + (1 - cos * cos) / (cos * cos)) + 1e-6)
            << alpha << " cos " << cos;
      }
    }
    const RoughConductorMaterial mirror("mirror", RefractiveIndex(0, 100), {shape, 1e-3F, 1e-3F});
    for (const double cos : {1.0, 0.8, 0.5})
      EXPECT_LT(leaving(mirror.bsdf({packet()}), direction_at(cos, 1), 0, all, 1 << 12), 1 + 2e-6) << cos;
  }
}

// Compares with the quadrature in a few rough directions, elsewhere with the table.
TEST(EnergyCompensation, IsWhatTheTableSays) {
  for (const auto& facets : furnace_facets()) {
    const EnergyCompensation lost = RoughMetal(facets).lost;
    for (const double cos : {0.9, 0.43, 0.11})
      for (const double phi : {0.05, 0.6, 1.5, 2.9, 4.4}) {
        const V3f w = direction_at(cos, phi);
        EXPECT_NEAR(lost.at(EnergyCompensation::table_coordinates(facets, w)), 1 - mirror_energy(facets, w),
                    1e-2)
            << facets.alpha_x << " " << facets.alpha_y << " cos " << cos << " phi " << phi;
      }
  }
}

TEST(EnergyCompensation, IsSoonTabulated) {
  // Counts calls of the quadrature instead of time.
  int calls = 0;
  const auto count = [&](const V3f&, std::span<double> energies) {
    ++calls;
    energies[0] = 1;
  };
  static_cast<void>(EnergyCompensation::tabulate({FacetShape::ggx, 0.3F, 0.3F}, 1, count));
  EXPECT_LE(calls, 50);
  static_cast<void>(EnergyCompensation::tabulate({FacetShape::ggx, 0.3F, 0.4F}, 1, count));
  EXPECT_LE(calls, 650);
}

// The colour of metal from its mean reflectance, with the series of scatterings summed one by one.
TEST(RoughConductor, IsColouredByEveryScattering) {
  const Microfacets<float> facets{FacetShape::ggx, 1, 1};
  const RoughConductorMaterial metal("metal", RefractiveIndex(0.2, 3), facets);
  double mean = 0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double c = (i + 0.5) / kSteps;
    mean += 2 * c * fresnel_conductor(c, 0.2, 3.0).R() / kSteps;
  }
  EXPECT_NEAR(metal.mean_reflectance(550), mean, 1e-6);

  const V3f wo = direction_at(0.6, 1);
  const EnergyCompensation& lost = metal.surface->lost;
  const double energy = 1 - lost.total() / std::numbers::pi;
  double often = 0;
  double term = mean * mean * energy;
  for (int bounce = 2; bounce < 100; ++bounce, term *= mean * (1 - energy)) often += term;
  double once = 0;
  constexpr int kFacets = 1 << 14;
  for (int i = 0; i < kFacets; ++i) {
    const V3f h = facets.sample_visible(wo, event(i).direction);
    const V3f wi = h * (2 * wo.dot(h)) - wo;
    if (wi.z > 0)
      once += static_cast<double>(fresnel_conductor(wo.dot(h), 0.2F, 3.0F).R() * (1 + facets.lambda(wo)) /
                                  (1 + facets.lambda(wo) + facets.lambda(wi)));
  }
  const double expected = once / kFacets + lost.at(EnergyCompensation::table_coordinates(facets, wo)) * often;
  EXPECT_NEAR(leaving(metal.bsdf({packet()}), wo, 2, all), expected, 2e-3);
}

// The mean over the hemisphere agrees too.
TEST(RoughConductor, InMatterIsTheRelativeIndexInAir) {
  const RefractiveIndex oil(1.5);
  for (const float alpha : {0.05F, 0.3F, 0.5F, 1.0F}) {
    const Microfacets<float> facets{FacetShape::ggx, alpha, alpha};
    const RoughConductorMaterial metal("metal", RefractiveIndex(3, 3), facets);
    const RoughConductorMaterial relative("relative", RefractiveIndex(2, 2), facets);
    const Bsdf in_oil = metal.bsdf({packet(), {}, &oil});
    const Bsdf in_air = relative.bsdf({packet()});
    for (const double cos : kCosines) {
      const V3f wo = direction_at(cos, 0.5 + cos);
      for (int i = 0; i < 64; ++i) {
        const auto a = sample(in_oil, wo, event(i), 0, TransportMode::power);
        const auto b = sample(in_air, wo, event(i), 0, TransportMode::power);
        ASSERT_EQ(a.has_value(), b.has_value());
        if (!a) continue;
        EXPECT_EQ(a->wi, b->wi);
        EXPECT_EQ(a->pdf, b->pdf);
        EXPECT_EQ(pdf(in_oil, wo, a->wi)[3], pdf(in_air, wo, a->wi)[3]);
        const float f = eval(in_air, wo, a->wi, TransportMode::power)[3];
        EXPECT_NEAR(eval(in_oil, wo, a->wi, TransportMode::power)[3], f, 2e-6F * f)
            << "alpha " << alpha << " cos " << cos;
      }
      const double albedo = leaving(in_air, wo, 3, all, 1 << 10);
      EXPECT_NEAR(leaving(in_oil, wo, 3, all, 1 << 10), albedo, 2e-6 * albedo) << "alpha " << alpha;
    }
  }
}

double uneven(const V3f& wi) {
  return 1 + 0.5 * std::sin(3.0 * wi.x + 1) * std::cos(2.0 * wi.y) + 0.3 * wi.z;
}

TEST(RoughConductor, OfLeastRoughnessIsSmooth) {
  for (const FacetShape shape : kFacetShapes) {
    const RoughConductorMaterial rough("rough", RefractiveIndex(0.2, 3), {shape, 1e-3F, 1e-3F});
    const ConductorBsdf smooth{SampledSpectrum(0.2F), SampledSpectrum(3)};
    for (const double cos : {1.0, 0.5, 0.1}) {
      const V3f wo = direction_at(cos, 0.4);
      EXPECT_NEAR(leaving(rough.bsdf({packet()}), wo, 0, uneven), leaving(smooth, wo, 0, uneven, 4), 5e-4);
    }
  }
}

TEST(RoughDielectric, OfLeastRoughnessIsSmooth) {
  for (const FacetShape shape : kFacetShapes) {
    const RoughInterface surface({shape, 1e-3F, 1e-3F}, 1.5F, 1.5F);
    const Bsdf rough = RoughDielectricBsdf{SampledSpectrum(1.5F), &surface};
    const Bsdf smooth = DielectricBsdf{SampledSpectrum(1.5F), false};
    for (const double cos : {1.0, 0.4, -0.9, -0.5}) {
      const V3f wo = direction_at(cos, 0.4);
      EXPECT_NEAR(leaving(rough, wo, 0, uneven), leaving(smooth, wo, 0, uneven), 1e-3);
    }
  }
}

// Each wavelength by the balance heuristic over eight heroes, against a packet of that index alone.
TEST(RoughDielectric, BalancedLanesAreUnbiased) {
  for (const float alpha : {0.03F, 0.3F}) {
    const RoughInterface surface({FacetShape::ggx, alpha, alpha}, 1.4F, 2.0F);
    const SampledSpectrum n = ramp(1.4F, 2.0F);
    const Bsdf bsdf = RoughDielectricBsdf{n, &surface};
    for (const double cos : {0.5, -0.8}) {
      const V3f wo = direction_at(cos, 0.4);
      constexpr int kEvents = 1 << 15;
      std::array<double, kLanes> balanced{};
      for (int i = 0; i < kEvents; ++i)
        for (int hero = 0; hero < kLanes; ++hero)
          if (const auto s = sample(bsdf, wo, event(i), hero, TransportMode::power))
            for (int j = 0; j < kLanes; ++j)
              balanced[static_cast<std::size_t>(j)] +=
                  static_cast<double>(s->weight[j] / s->lane_pdf.sum()) * uneven(s->wi) / kEvents;
      for (int j = 0; j < kLanes; ++j) {
        const Bsdf alone = RoughDielectricBsdf{SampledSpectrum(n[j]), &surface};
        EXPECT_NEAR(balanced[static_cast<std::size_t>(j)], leaving(alone, wo, j, uneven), 4e-3)
            << "alpha " << alpha << " cos " << cos << " lane " << j;
      }
    }
  }
}

TEST(RoughDielectric, RefractionScalesRadianceLaneByLane) {
  const RoughInterface surface({FacetShape::ggx, 0.3F, 0.3F}, 1.4F, 2.0F);
  const RoughDielectricBsdf bsdf{ramp(1.4F, 2.0F), &surface};
  for (const double cos : {0.5, -0.8}) {
    const V3f wo = direction_at(cos, 0.4);
    const V3f through = direction_at(-cos, 3.4);
    const SampledSpectrum radiance = bsdf.eval(wo, through, TransportMode::radiance);
    const SampledSpectrum power = bsdf.eval(wo, through, TransportMode::power);
    for (int j = 0; j < kLanes; ++j) {
      const float n2 = bsdf.n[j] * bsdf.n[j];
      EXPECT_FLOAT_EQ(radiance[j] * (cos > 0 ? n2 : 1 / n2), power[j]);
      EXPECT_GT(power[j], 0);
    }
    const V3f back = direction_at(cos, 3.4);
    EXPECT_FLOAT_EQ(bsdf.eval(wo, back, TransportMode::radiance)[3],
                    bsdf.eval(wo, back, TransportMode::power)[3]);
  }
}

// Facets of small slope cannot transmit light above the critical angle.
TEST(RoughDielectric, ReflectsTotally) {
  const RoughInterface surface({FacetShape::beckmann, 0.01F, 0.01F}, 1.5F, 1.5F);
  const Bsdf bsdf = RoughDielectricBsdf{SampledSpectrum(1.5F), &surface};
  const auto through = [](const V3f& wi) { return wi.z > 0 ? 1.0 : 0.0; };
  EXPECT_LT(leaving(bsdf, direction_at(-0.6, 0), 0, through), 1e-4);
  EXPECT_NEAR(leaving(bsdf, direction_at(-0.9, 0), 0, through),
              fresnel_dielectric(0.9, 1 / 1.5).transmitted(), 5e-3);
}

// Weights of a perfect mirror differ from 1 by the variation of 1 - E within half a cell of its density. Half
// a cell is 3.4 % of the tangent at the smallest roughness. 1 - E rises with the tangent to the power 2 for
// GGX, and at most 7 for Beckmann, which has few steep facets.
TEST(RoughSurfaces, WeighSamplesEvenly) {
  double largest = 0;
  int single = 0;
  int heavy = 0;
  for (const auto& facets : furnace_facets()) {
    if (facets.alpha_x != facets.alpha_y) continue;
    const RoughConductorMaterial mirror("mirror", RefractiveIndex(0, 1), facets);
    const Bsdf bsdf = mirror.bsdf({packet()});
    for (const double cos : kCosines) {
      const V3f wo = direction_at(cos, 0.5 + cos);
      const float lost = mirror.surface->lost.at(EnergyCompensation::table_coordinates(facets, wo));
      for (int i = 0; i < 2048; ++i) {
        BsdfRandom u = event(i);
        if (const auto s = sample(bsdf, wo, u, 0, TransportMode::power))
          largest = std::max(largest, static_cast<double>(s->weight[0]));
        u.lobe = 0;  // reflection off a facet
        const auto s = sample(bsdf, wo, u, 0, TransportMode::power);
        if (s && lost < 1e-3F) {
          ++single;
          heavy += s->weight[0] > 1.01F ? 1 : 0;
        }
      }
    }
  }
  std::printf("largest weight %.3f\n", largest);
  EXPECT_LT(largest, 1.25);
  EXPECT_LE(heavy, single / 1000) << "the far tails, where the other lobe sends more";
}

TEST(RoughMaterials, TellHowTheySendLight) {
  const Material glass{"glass",
                       RoughDielectricMaterial("n", RefractiveIndex(1.5), {FacetShape::ggx, 0.1F, 0.1F})};
  EXPECT_TRUE(lobes(glass).spread);
  EXPECT_FALSE(lobes(glass).delta);
  EXPECT_NE(interior_index(glass), nullptr);
  EXPECT_FLOAT_EQ(index_inside(make_bsdf(glass, {packet()}), 2), 1.5F);
  const Material metal{"metal",
                       RoughConductorMaterial("n", RefractiveIndex(0.2, 3), {FacetShape::ggx, 0.1F, 0.1F})};
  EXPECT_TRUE(lobes(metal).spread);
  EXPECT_EQ(interior_index(metal), nullptr);
}

TEST(RoughMaterials, AreNeverWithoutContrast) {
  const Material ghost{"ghost",
                       RoughDielectricMaterial("n", RefractiveIndex(1), {FacetShape::ggx, 0.1F, 0.1F})};
  const Bsdf bsdf = make_bsdf(ghost, {packet()});
  EXPECT_FLOAT_EQ(index_inside(bsdf, 0), 1.001F);
  EXPECT_NEAR(leaving(bsdf, direction_at(0.7, 1), 0, all), 1, 1e-2);
}

}  // namespace
}  // namespace abbe
