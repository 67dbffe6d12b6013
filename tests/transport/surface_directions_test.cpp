#include "transport/path/vertex.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "materials/bsdf/warp.h"
#include "materials/interface/fresnel.h"

namespace abbe {
namespace {

using Imath::V3f;

SurfaceVertex vertex_of(Bsdf bsdf, float cos_o) {
  const V3f normal(0, 0, 1);
  return {{{0, 0, 0}, normal, 0, 0}, Basis<float>(normal), direction_at(cos_o, 0.4), std::move(bsdf)};
}

// A diffuse surface, a coat whose specular probability depends on the wavelength, and ground glass.
std::vector<SurfaceVertex> some_vertices() {
  static const RoughInterface ground({FacetShape::ggx, 0.5F, 0.5F}, 1.45F, 1.9F);
  SampledSpectrum::Values n{};
  for (std::size_t k = 0; k < kLanes; ++k) n[k] = 1.45F + 0.05F * static_cast<float>(k);
  const SampledSpectrum indices(n);
  const SampledSpectrum inner = SampledSpectrum::map(
      indices, [](float index) { return static_cast<float>(diffuse_reflectance_inside(index)); });
  std::vector<SurfaceVertex> vertices;
  for (const float cos_o : {0.9F, -0.3F}) {
    vertices.push_back(vertex_of(DiffuseBsdf{SampledSpectrum(0.5F)}, cos_o));
    vertices.push_back(vertex_of(coated_diffuse(indices, SampledSpectrum(0.7F), inner, true), cos_o));
    vertices.push_back(vertex_of(RoughDielectricBsdf{indices, &ground}, cos_o));
  }
  return vertices;
}

constexpr int kGrid = 128;
constexpr int kHero = 3;

// Calls `use` for each point of a grid over the unit square.
template <typename Use>
void for_grid(Use use) {
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j)
      use(Imath::V2f((static_cast<float>(i) + 0.5F) / kGrid, (static_cast<float>(j) + 0.5F) / kGrid));
}

TEST(SurfaceDirections, HaveTheDensityThatIsTold) {
  for (const SurfaceVertex& vertex : some_vertices())
    for (const DirectionSampling directions : {DirectionSampling::cosine, DirectionSampling::uniform})
      for_grid([&](const Imath::V2f& u) {
        const auto event = sample_directions(directions, vertex, {0.999F, u}, kHero, TransportMode::radiance);
        if (!event) return;
        ASSERT_FALSE(event->delta);
        const SampledSpectrum told = pdf_of_directions(directions, vertex, event->wi);
        const SampledSpectrum f = vertex.f(event->wi, event->wi, TransportMode::radiance);
        EXPECT_EQ(event->transmitted, event->wi.z * vertex.wo.z < 0);
        for (int k = 0; k < kLanes; ++k) {
          EXPECT_NEAR(event->pdf * event->lane_pdf[k], told[k], 1e-5F * told[k]);
          EXPECT_NEAR(event->pdf * event->weight[k], f[k] * std::abs(event->wi.z), 1e-5F * f[k]);
        }
      });
}

TEST(SurfaceDirections, AreWhateverIsNotDelta) {
  for (const SurfaceVertex& vertex : some_vertices())
    for (const DirectionSampling directions : {DirectionSampling::cosine, DirectionSampling::uniform}) {
      std::array<double, kLanes> all{};
      for_grid([&](const Imath::V2f& u) {
        const SampledSpectrum pdf =
            pdf_of_directions(directions, vertex, direction_at(1 - 2 * u.x, 2 * std::numbers::pi * u.y));
        for (std::size_t k = 0; k < all.size(); ++k)
          all.at(k) += static_cast<double>(pdf[static_cast<int>(k)]);
      });
      const SampledSpectrum delta = delta_probability(vertex.bsdf, vertex.wo);
      for (int k = 0; k < kLanes; ++k)
        EXPECT_NEAR(all.at(static_cast<std::size_t>(k)) * 4 * std::numbers::pi / (kGrid * kGrid) +
                        static_cast<double>(delta[k]),
                    1, 1e-4);
    }
}

// Directions on one side, or evenly on both, with a mean cosine of 2/3 or 1/2.
TEST(SurfaceDirections, FollowTheirDensity) {
  for (const SurfaceVertex& vertex : some_vertices())
    for (const DirectionSampling directions : {DirectionSampling::cosine, DirectionSampling::uniform}) {
      const bool both = std::holds_alternative<RoughDielectricBsdf>(vertex.bsdf);
      double cosine = 0;
      double same_side = 0;
      int drawn = 0;
      for_grid([&](const Imath::V2f& u) {
        const auto event = sample_directions(directions, vertex, {0.999F, u}, kHero, TransportMode::radiance);
        if (!event) return;
        ++drawn;
        cosine += std::abs(event->wi.z);
        if (!event->transmitted) ++same_side;
      });
      if (!both) {
        EXPECT_NEAR(cosine / drawn, directions == DirectionSampling::cosine ? 2.0 / 3 : 0.5, 1e-3);
      }
      EXPECT_GE(drawn, both ? kGrid * kGrid / 2 : kGrid * kGrid);
      EXPECT_LE(same_side, both ? kGrid * kGrid / 2 : kGrid * kGrid);
    }
}

// Delta events remain, with the material's own probability.
TEST(SurfaceDirections, LeaveDeltaEventsAlone) {
  const SurfaceVertex coat = some_vertices()[1];
  const auto kept =
      sample_directions(DirectionSampling::uniform, coat, {0, {0.3F, 0.6F}}, kHero, TransportMode::radiance);
  const auto own = coat.scatter({0, {0.3F, 0.6F}}, kHero, TransportMode::radiance);
  ASSERT_TRUE(kept && own && kept->delta);
  EXPECT_EQ(kept->pdf, own->pdf);
  EXPECT_EQ(kept->wi, own->wi);
}

}  // namespace
}  // namespace abbe
