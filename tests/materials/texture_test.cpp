#include <gtest/gtest.h>

#include "io/error.h"
#include "materials/material.h"
#include "materials/texture/spectral_texture.h"
#include "materials/texture/texture_image.h"

namespace abbe {
namespace {

using Imath::V2f;

const SampledSpectrum kWavelengths({400, 450, 500, 550, 600, 650, 700, 750});

// Two rows of three texels: 0 1 2 at the top, 3 4 5 below.
TextureImage counted(const TextureMapping& mapping) {
  return {3, 2, 1, {0, 1, 2, 3, 4, 5}, mapping};
}
float at(const TextureImage& image, float u, float v) {
  return image.value(image.blend({u, v}), 0);
}

TEST(TextureImage, CentresOfTexelsAreExactUpright) {
  for (const TextureFilter filter : {TextureFilter::bilinear, TextureFilter::nearest}) {
    const TextureImage image = counted({.filter = filter});
    for (int row = 0; row < 2; ++row)
      for (int column = 0; column < 3; ++column)
        EXPECT_NEAR(
            at(image, (static_cast<float>(column) + 0.5F) / 3, 1 - (static_cast<float>(row) + 0.5F) / 2),
            static_cast<float>(3 * row + column), 1e-5)
            << row << " " << column;
  }
}

TEST(TextureImage, BilinearIsExactOnRamps) {
  const TextureImage image = counted({});
  for (int i = 0; i <= 20; ++i) {
    const float u = 1.0F / 6 + static_cast<float>(i) / 30;  // from the first column's centre to the last's
    const float v = 0.25F + static_cast<float>(i) / 40;
    EXPECT_NEAR(at(image, u, v), (3 * u - 0.5F) + 3 * (1.5F - 2 * v), 1e-5) << u;
  }
}

TEST(TextureImage, NearestHasSteps) {
  const TextureImage image = counted({.filter = TextureFilter::nearest});
  EXPECT_EQ(at(image, 0.3333F, 0.9F), 0);
  EXPECT_EQ(at(image, 0.3334F, 0.9F), 1);
  EXPECT_EQ(at(image, 0.3334F, 0.4999F), 4);
}

TEST(TextureImage, WrapsOrClamps) {
  const TextureImage repeated = counted({});
  EXPECT_NEAR(at(repeated, 0, 0.75F), 1, 1e-6);  // half way between the last column and the first
  EXPECT_NEAR(at(repeated, 1, 0.75F), 1, 1e-6);
  EXPECT_NEAR(at(repeated, 0.5F, 0), 2.5F, 1e-6);
  for (const float whole : {-7.0F, -1.0F, 3.0F})
    EXPECT_NEAR(at(repeated, 0.4F + whole, 0.3F - whole), at(repeated, 0.4F, 0.3F), 1e-5) << whole;
  const TextureImage clamped = counted({.wrap = TextureWrap::clamp});
  EXPECT_EQ(at(clamped, 0, 1), 0);
  EXPECT_EQ(at(clamped, -4, 1.7F), 0);
  EXPECT_EQ(at(clamped, 9, -2), 5);
}

TEST(TextureImage, ScaleAndOffsetMoveTheImage) {
  const TextureImage moved = counted({.scale = {2, -1}, .offset = {0.25, 0.5}});
  const TextureImage plain = counted({});
  EXPECT_NEAR(at(moved, 0.1F, 0.2F), at(plain, 0.45F, 0.3F), 1e-6);
}

TEST(TextureImage, GradientIsExactOnRamps) {
  const TextureImage wide(8, 8, 2,
                          [] {
                            std::vector<float> texels;
                            for (int row = 0; row < 8; ++row)
                              for (int column = 0; column < 8; ++column) {
                                texels.push_back(7);
                                texels.push_back(static_cast<float>(2 * column - 3 * row));
                              }
                            return texels;
                          }(),
                          {.scale = {0.5, -2}});
  const Imath::V2d slope = wide.gradient({0.9F, -0.3F}, 1);
  EXPECT_NEAR(slope.x, 16 * 0.5, 1e-4);
  EXPECT_NEAR(slope.y, 24 * -2, 1e-4);
  EXPECT_EQ(wide.gradient({0.9F, -0.3F}, 0), Imath::V2d(0, 0));
}

TEST(Relief, NormalsAreDecoded) {
  const NormalMap map{TextureImage(1, 1, 3, {0.5F, 0.8F, 0.9F}, {})};
  EXPECT_LT((map.normal({0.3F, 0.3F}) - Imath::V3d(0, 0.6, 0.8)).length(), 1e-6);
}

TEST(Relief, MaterialsAskForCoordinates) {
  Material mirror{"mirror", ConductorMaterial{"silver", RefractiveIndex(0.1, 4)}};
  EXPECT_FALSE(needs_coordinates(mirror));
  mirror.relief = std::make_shared<const Relief>(BumpMap{TextureImage(1, 1, 1, {0.5F}, {}), 1});
  EXPECT_TRUE(needs_coordinates(mirror));
}

TEST(TextureImage, RefusesTooFewTexels) {
  EXPECT_THROW(TextureImage(2, 2, 3, std::vector<float>(11), {}), Error);
  EXPECT_THROW(TextureImage(0, 0, 1, {}, {}), Error);
  EXPECT_THROW(SpectralTexture(TextureImage(1, 1, 2, {0, 0}, {}), {Curve(1.0)}), Error);
}

TEST(SpectralTexture, AddsSpectraByTheChannels) {
  const Curve rising({{400, 0.0}, {800, 1.0}});
  const SpectralTexture texture(
      TextureImage(2, 1, 2, {0.25F, 0.5F, 1, 0}, {.filter = TextureFilter::nearest}), {Curve(0.4), rising});
  const SampledSpectrum left = texture({kWavelengths, {0.2F, 0.5F}});
  const SampledSpectrum right = texture({kWavelengths, {0.8F, 0.5F}});
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_NEAR(left[lane], 0.1 + 0.5 * rising(static_cast<double>(kWavelengths[lane])), 1e-6);
    EXPECT_NEAR(right[lane], 0.4, 1e-6);
  }
  EXPECT_TRUE(texture.textured());
}

TEST(SpectralTexture, StaysAReflectance) {
  const SpectralTexture texture(TextureImage(2, 1, 1, {-0.001F, 1.001F}, {.filter = TextureFilter::nearest}),
                                {Curve(1.0)});
  EXPECT_EQ(texture({kWavelengths, {0.2F, 0.5F}})[0], 0);
  EXPECT_EQ(texture({kWavelengths, {0.8F, 0.5F}})[0], 1);
}

TEST(SpectralTexture, MaterialsAskForCoordinatesOnlyWithAnImage) {
  const Material plain{"plain", DiffuseMaterial{Curve(0.5)}};
  const Material painted{"painted",
                         DiffuseMaterial{SpectralTexture(TextureImage(1, 1, 1, {0.5F}, {}), {Curve(1.0)})}};
  EXPECT_FALSE(needs_coordinates(plain));
  EXPECT_TRUE(needs_coordinates(painted));
}

}  // namespace
}  // namespace abbe
