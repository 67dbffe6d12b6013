#include "materials/interface/microfacet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/angles.h"
#include "tests/materials/facet_shapes.h"

namespace abbe {
namespace {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

// 20 widths from 1e-3 to 1; every second one is anisotropic.
std::vector<Microfacets<double>> all_facets() {
  std::vector<Microfacets<double>> facets;
  for (const FacetShape shape : kFacetShapes)
    for (int i = 0; i < 20; ++i) {
      const double alpha = std::pow(10.0, -3 + 3.0 * i / 19);
      facets.push_back({shape, alpha, i % 2 == 0 ? alpha : std::min(1.0, 4 * alpha)});
    }
  return facets;
}

V3d unit_vector(double cos, double phi) {
  const double sin = std::sqrt((1 - cos) * (1 + cos));
  return {sin * std::cos(phi), sin * std::sin(phi), cos};
}

// Integral of f over all h, in polar coordinates of the slopes scaled by alpha. Narrow peaks are then
// resolved like wide ones.
template <typename F>
double over_facets(const Microfacets<double>& facets, F f) {
  constexpr int kRadii = 600;
  constexpr int kAngles = 96;
  double sum = 0;
  for (int i = 0; i < kRadii; ++i)
    for (int j = 0; j < kAngles; ++j) {
      const double v = (i + 0.5) / kRadii;
      const double r = v / (1 - v);
      const double phi = 2 * kPi * (j + 0.5) / kAngles;
      const V3d h =
          V3d(facets.alpha_x * r * std::cos(phi), facets.alpha_y * r * std::sin(phi), 1).normalized();
      sum += f(h) * h.z * h.z * h.z * r / ((1 - v) * (1 - v));
    }
  return sum * facets.alpha_x * facets.alpha_y * 2 * kPi / (kRadii * kAngles);
}

TEST(Microfacets, CoverTheSurface) {
  for (const auto& facets : all_facets())
    EXPECT_NEAR(over_facets(facets, [&](const V3d& h) { return facets.D(h) * h.z; }), 1, 1e-4);
}

// G1 and D must agree, so this also tests lambda.
TEST(Microfacets, VisibleOnesCoverWhatIsSeen) {
  for (const auto& facets : all_facets())
    for (const double cos : {1.0, 0.9, 0.5, 0.2, 0.03}) {
      const V3d w = unit_vector(cos, 0.7);
      EXPECT_NEAR(over_facets(facets, [&](const V3d& h) { return facets.visible(w, h); }), 1, 1e-3)
          << facets.alpha_x << " " << facets.alpha_y << " cos " << cos;
    }
}

// The formula of the chapter, with the cos^4 and the leading 1 that the print lacks.
TEST(Microfacets, AnisotropicGgxIsTheClosedForm) {
  const Microfacets<double> facets{FacetShape::ggx, 0.2, 0.5};
  for (const double theta : {0.0, 0.3, 1.2})
    for (const double phi : {0.0, 0.5, 2.0}) {
      const double c = std::cos(theta);
      const double t = std::tan(theta);
      const double e = 1 + t * t * (std::pow(std::cos(phi) / 0.2, 2) + std::pow(std::sin(phi) / 0.5, 2));
      EXPECT_NEAR(facets.D(unit_vector(c, phi)), 1 / (kPi * 0.2 * 0.5 * c * c * c * c * e * e), 1e-12);
    }
}

TEST(Microfacets, MostHalfVectorsAreWithinAFewAlpha) {
  const Microfacets<float> facets{FacetShape::ggx, 0.01F, 0.01F};
  std::vector<double> degrees;
  for (int i = 0; i < 10000; ++i) {
    const V3f h = facets.sample_visible(
        {0, 0, 1}, {static_cast<float>(i % 97) / 97, (static_cast<float>(i) + 0.5F) / 10000});
    degrees.push_back(std::asin(std::hypot(h.x, h.y)) * 180 / kPi);
  }
  std::sort(degrees.begin(), degrees.end());
  EXPECT_NEAR(degrees[9000], 1.72, 0.02);
}

TEST(Microfacets, SlopesAreDrawnByTheirShare) {
  for (const double k : {0.0, 0.3, 2.0, 1e3, 1e7}) {
    const double end = k > 0 ? std::min(6.0, 1 / k) : 6;
    const auto below = [&](double s) {
      constexpr int kSteps = 4000;
      double sum = 0;
      for (int i = 0; i < kSteps; ++i) {
        const double t = -6 + (s + 6) * (i + 0.5) / kSteps;
        sum += (1 - k * t) * std::exp(-t * t);
      }
      return sum * (s + 6) / kSteps;
    };
    double last = -7;
    for (const double u : {0.0, 1e-7, 1e-4, 0.1, 0.5, 0.77, 0.999, 1 - 0x1p-24}) {
      const double s = visible_slope(u, k);
      EXPECT_GT(s, last);
      EXPECT_NEAR(below(s) / below(end), u, 1e-6) << "k " << k;
      last = s;
    }
  }
}

// Both use the float directions, since rounding of a direction is not an error of the formulas.
TEST(Microfacets, FloatsKeepTheirDigits) {
  for (const auto& facets : all_facets()) {
    const Microfacets<float> narrow{facets.shape, static_cast<float>(facets.alpha_x),
                                    static_cast<float>(facets.alpha_y)};
    const Microfacets<double> wide{facets.shape, narrow.alpha_x, narrow.alpha_y};
    for (const double cos : {1e-6, 1e-3, 0.3, 0.9999999}) {
      const V3f w(unit_vector(cos, 1.1));
      EXPECT_NEAR(narrow.G1(w) / wide.G1(V3d(w)), 1, 1e-5);
      const V3f h = V3f(narrow.alpha_x * 2, narrow.alpha_y, 1).normalized();
      EXPECT_NEAR(narrow.D(h) / wide.D(V3d(h)), 1, 1e-5);
    }
  }
}

TEST(Microfacets, EveryNumberDrawsAFacet) {
  for (const FacetShape shape : kFacetShapes)
    for (const float alpha : {1e-3F, 0.1F, 1.0F})
      for (const float z : {1e-7F, 1e-3F, 0.5F, 1.0F})
        for (const float u : {0.0F, 0x1p-24F, 0.5F, 0x1.fffffep-1F})
          for (const float v : {0.0F, 0x1p-24F, 0.5F, 0x1.fffffep-1F}) {
            const V3f h = Microfacets<float>{shape, alpha, alpha}.sample_visible(
                V3f(std::sqrt(1 - z * z), 0, z), {u, v});
            EXPECT_TRUE(h.z > 0 && std::abs(h.length() - 1) < 1e-6) << h.x << " " << h.y << " " << h.z;
          }
}

}  // namespace
}  // namespace abbe
