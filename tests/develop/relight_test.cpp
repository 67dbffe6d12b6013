#include "develop/relight.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "io/error.h"
#include "io/spectral_exr.h"
#include "sensor/film/film_planes.h"

namespace abbe {
namespace {

// Two pixels of two planes, illuminated by two lights.
Image film_of_two_lights() {
  return {2,
          1,
          {{"R", {5, 8}},
           {"G", {3, 2}},
           {"Variance.R", {0.04F, 0.25F}},
           {"Variance.G", {0.01F, 0.01F}},
           {"light.key.R", {4, 6}},
           {"light.key.G", {2, 2}},
           {"light.sun.R", {1, 2}},
           {"light.sun.G", {1, 0}},
           {"Variance.light.key.R", {0.01F, 0.16F}},
           {"Variance.light.key.G", {0.01F, 0.01F}},
           {"Variance.light.sun.R", {0.01F, 0.09F}},
           {"Variance.light.sun.G", {0.01F, 0}},
           {"Coverage", {1, 0}}},
          {{kLayersKey, "light.key,light.sun"}, {"frame_mean_error", "0.1"}}};
}

Image relit(const std::vector<LightFactor>& factors) {
  Image image = film_of_two_lights();
  relight(image, factors);
  return image;
}

std::vector<float> values(const Image& image, const char* channel) {
  return image.find(channel)->values;
}

TEST(Relight, LightsCountAsOftenAsTheyAreAskedTo) {
  const Image image = relit({{"key", {0.5}}, {"sun", {3, 2}}});
  EXPECT_EQ(values(image, "R"), (std::vector<float>{5, 9}));
  EXPECT_EQ(values(image, "G"), (std::vector<float>{3, 1}));
  EXPECT_EQ(values(image, "Coverage"), (std::vector<float>{1, 0}));
  EXPECT_EQ(image.find("light.key.R"), nullptr);
  EXPECT_EQ(image.find("Variance.light.key.R"), nullptr);
  EXPECT_FALSE(image.metadata.contains(kLayersKey));
  EXPECT_FALSE(image.metadata.contains("frame_mean_error"));
}

TEST(Relight, WhatIsNotKnownOfAFilmsErrorStaysSo) {
  Image image = film_of_two_lights();
  image.metadata["frame_mean_error"] = "inf";
  relight(image, std::vector<LightFactor>{{"key", {0.5}}});
  EXPECT_EQ(image.metadata.at("frame_mean_error"), "inf");
}

TEST(Relight, AllAlikeTheVarianceIsTheFilms) {
  const Image image = relit({{"key", {2}}, {"sun", {2}}});
  EXPECT_EQ(values(image, "R"), (std::vector<float>{10, 16}));
  EXPECT_NEAR(values(image, "Variance.R")[0], 4 * 0.04, 1e-6);
  EXPECT_NEAR(values(image, "Variance.R")[1], 4 * 0.25, 1e-6);
}

// Deviations of R in the first pixel are 0.2, 0.1 and 0.1 for film, key and sun.
TEST(Relight, ElseItIsTheLeastBound) {
  // The minimum of |w| 0.2 + |1 - w| 0.1 + |0 - w| 0.1 is 0.1 at w = 0: the key alone.
  EXPECT_NEAR(values(relit({{"sun", {0}}}), "Variance.R")[0], 0.01, 1e-6);
  // In the second pixel they are 0.5, 0.4 and 0.3. For key and 1.1 sun: 0.5 + 0.03 at w = 1, 0.55 + 0.04 at
  // 1.1, 0.73 at 0.
  EXPECT_NEAR(values(relit({{"sun", {1.1}}}), "Variance.R")[1], 0.53 * 0.53, 1e-6);
}

TEST(Relight, AnInfiniteVarianceCountsWhereItsLightDoes) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  Image image = film_of_two_lights();
  for (ImageChannel& channel : image.channels)
    if (channel.name == "Variance.R" || channel.name == "Variance.light.sun.R") channel.values[0] = kInfinite;
  Image whole = image;
  relight(image, std::vector<LightFactor>{{"sun", {0}}});
  EXPECT_NEAR(values(image, "Variance.R")[0], 0.01, 1e-6);
  relight(whole, std::vector<LightFactor>{{"sun", {2}}});
  EXPECT_EQ(values(whole, "Variance.R")[0], kInfinite);
}

// Files order channels by name; factors are in the order of the sensor.
TEST(Relight, FactorsAreThoseOfTheSensorsChannels) {
  Image image{
      1,
      1,
      {{"B", {3}}, {"G", {2}}, {"R", {1}}, {"light.key.B", {3}}, {"light.key.G", {2}}, {"light.key.R", {1}}},
      {{kLayersKey, "light.key"}, {"sensor_channels", "R,G,B"}}};
  relight(image, std::vector<LightFactor>{{"key", {10, 1, 0}}});
  EXPECT_EQ(values(image, "R"), (std::vector<float>{10}));
  EXPECT_EQ(values(image, "G"), (std::vector<float>{2}));
  EXPECT_EQ(values(image, "B"), (std::vector<float>{0}));
  EXPECT_EQ(image.metadata.at("relit"), "key=10,1,0");
}

// Bands are in order of wavelength. The preview follows a light with one factor, and is removed for one with
// several.
TEST(Relight, OfSpectralFilmsBandsAreWeighed) {
  const std::string blue = spectral_channel(450);
  const std::string infrared = spectral_channel(1050);
  const Image spectral{1,
                       1,
                       {{infrared, {5}},
                        {blue, {4}},
                        {"R", {1}},
                        {"light.key." + infrared, {5}},
                        {"light.key." + blue, {4}},
                        {"light.key.R", {1}}},
                       {{kLayersKey, "light.key"}}};
  Image dimmed = spectral;
  relight(dimmed, std::vector<LightFactor>{{"key", {0.5}}});
  EXPECT_EQ(values(dimmed, blue.c_str()), (std::vector<float>{2}));
  EXPECT_EQ(values(dimmed, "R"), (std::vector<float>{0.5}));
  Image colored = spectral;
  relight(colored, std::vector<LightFactor>{{"key", {2, 0}}});
  EXPECT_EQ(values(colored, blue.c_str()), (std::vector<float>{8}));
  EXPECT_EQ(values(colored, infrared.c_str()), (std::vector<float>{0}));
  EXPECT_EQ(colored.channels.size(), 2U);
}

std::string relight_refusal(Image image, const std::vector<LightFactor>& factors) {
  try {
    relight(image, factors);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::usage);
    return error.what();
  }
  return "";
}

TEST(Relight, RefusesWhatTheFilmDoesNotHave) {
  EXPECT_EQ(relight_refusal(film_of_two_lights(), {{"moon", {1}}}),
            "--light: the film has no layer of this light (got \"moon\", allowed key, sun)");
  EXPECT_EQ(relight_refusal(film_of_two_lights(), {{"sun", {1, 2, 3}}}),
            "--light: got 3 factors of \"sun\", allowed 1, or 2 for the planes of the film");
  EXPECT_EQ(relight_refusal(film_of_two_lights(), {{"sun", {1}}, {"sun", {2}}}),
            "--light: sun is named twice");
  Image lost = film_of_two_lights();
  std::erase_if(lost.channels,
                [](const ImageChannel& channel) { return channel.name.starts_with("light."); });
  EXPECT_EQ(relight_refusal(lost, {{"sun", {1}}}),
            "--light: the film no longer has its layers of lights: use the rendered film");
  Image bounces = film_of_two_lights();
  bounces.metadata[kLayersKey] = "bounce0,bounce1plus";
  EXPECT_EQ(relight_refusal(bounces, {{"sun", {1}}}),
            "--light: the film has no layers of lights: render it with --layers lights");
}

}  // namespace
}  // namespace abbe
