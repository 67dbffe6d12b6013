#include <regex>

#include <gtest/gtest.h>

#include "io/atomic_file.h"
#include "io/exr.h"
#include "scene/lights/infinite_light.h"
#include "scenes.h"
#include "tests/angles.h"
#include "tests/description/description.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;
using test::Loaded;
using test::Random;
using Texels = std::vector<std::array<float, 3>>;
using EnvironmentFileTest = test::DescriptionTest;

const SampledSpectrum kGreen(550);

EnvironmentImage image_of(int width, int height, Texels texels,
                          const EnvironmentFrame& frame = {{0, 0, 1}, {0, 1, 0}}) {
  const std::vector<Channel> channels{energy_channel("all", Curve(1.0))};
  return {width, height, std::move(texels), frame, Curve(2.0), channels};
}

Texels noise(std::size_t count) {
  Random random(21);
  Texels texels(count);
  for (auto& texel : texels)
    for (float& value : texel)
      value = random.uniform() < 0.3F ? 0 : std::pow(10.0F, 6 * random.uniform() - 4);
  return texels;
}

TEST(EnvironmentImage, FacesWhereItSays) {
  // One row of four columns between a white top row and a black bottom row.
  Texels texels(12, {0, 0, 0});
  for (std::size_t i = 0; i < 4; ++i) texels[i] = {9, 9, 9};
  for (std::size_t i = 0; i < 4; ++i) texels[4 + i] = std::array<float, 3>{};
  for (std::size_t i = 0; i < 4; ++i) texels[4 + i].fill(static_cast<float>(i) + 1);
  const auto seen = [&](const EnvironmentFrame& frame, const V3f& wi) {
    return image_of(4, 3, texels, frame).radiance(wi, kGreen)[0] / 2;
  };
  const EnvironmentFrame upright = environment_frame({0, 0, 1}, 0);
  EXPECT_NEAR(seen(upright, {0.1F, 0.2F, 0.9F}), 9, 1e-5);
  EXPECT_NEAR(seen(upright, {0.1F, 0.2F, -0.9F}), 0, 1e-5);
  // The center, between the second and third columns, is +y; +x is to its right.
  EXPECT_NEAR(seen(upright, {-0.1F, 1, 0}), 2, 1e-5);
  EXPECT_NEAR(seen(upright, {0.1F, 1, 0}), 3, 1e-5);
  EXPECT_NEAR(seen(upright, {1, -0.1F, 0}), 4, 1e-5);
  EXPECT_NEAR(seen(upright, {-1, -0.1F, 0}), 1, 1e-5);
  // Rotated by a quarter turn about up, the center is -x.
  const EnvironmentFrame turned = environment_frame({0, 0, 1}, 90);
  EXPECT_NEAR(seen(turned, {-1, -0.1F, 0}), 2, 1e-5);
  EXPECT_NEAR(seen(turned, {-1, 0.1F, 0}), 3, 1e-5);
  // With y up the center is +x, and +z is to its right.
  const EnvironmentFrame tilted = environment_frame({0, 1, 0}, 0);
  EXPECT_NEAR(seen(tilted, {0.1F, 0.9F, 0}), 9, 1e-5);
  EXPECT_NEAR(seen(tilted, {1, 0, 0.1F}), 3, 1e-5);
  EXPECT_NEAR(seen(tilted, {1, 0, -0.1F}), 2, 1e-5);
}

TEST(EnvironmentImage, DensityIsThatOfItsSamples) {
  constexpr int kWidth = 12;
  constexpr int kHeight = 7;
  const EnvironmentImage image =
      image_of(kWidth, kHeight, noise(kWidth * kHeight), environment_frame(V3d(1, 2, -1).normalized(), 35));
  // The density integrates to 1. The mean of f/pdf over samples is the integral of f for any f.
  Random random(22);
  double total = 0;
  double moment = 0;
  constexpr int kPoints = 400000;
  for (int i = 0; i < kPoints; ++i) {
    const V3f wi(random.direction());
    const double pdf = static_cast<double>(image.pdf(wi)) * 4 * kPi / kPoints;
    total += pdf;
    moment += pdf * std::pow(static_cast<double>(wi.x) + 0.5 * static_cast<double>(wi.z), 2);
  }
  EXPECT_NEAR(total, 1, 0.03);
  double drawn = 0;
  int strange = 0;
  for (int i = 0; i < kPoints; ++i) {
    const auto wi = image.sample(random.pair());
    ASSERT_TRUE(wi);
    EXPECT_NEAR(wi->length(), 1, 1e-6);
    strange += !(image.pdf(*wi) > 0) || !(image.radiance(*wi, kGreen).max() > 0);
    drawn += std::pow(static_cast<double>(wi->x) + 0.5 * static_cast<double>(wi->z), 2) / kPoints;
  }
  EXPECT_NEAR(drawn / moment, 1, 0.03);
  EXPECT_LE(strange, kPoints / 10000) << "a black texel next to the one drawn, by rounding";
  EXPECT_FALSE(image_of(2, 1, Texels(2, {0, 0, 0})).sample({0.5F, 0.5F}));
  EXPECT_EQ(image_of(2, 1, Texels(2, {0, 0, 0})).pdf({1, 0, 0}), 0);
}

TEST(EnvironmentImage, TexelsAreSampledByTheirSolidAngle) {
  // A white upper half in one texel: cos theta is uniform in [0, 1], with mean 1/2 and variance 1/12.
  const EnvironmentImage half = image_of(1, 2, {{1, 1, 1}, {0, 0, 0}});
  Random random(25);
  double sum = 0;
  double squares = 0;
  constexpr int kSamples = 40000;
  for (int i = 0; i < kSamples; ++i) {
    const double z = static_cast<double>(half.sample(random.pair())->z);
    sum += z / kSamples;
    squares += z * z / kSamples;
  }
  EXPECT_NEAR(sum, 0.5, 0.01);
  EXPECT_NEAR(squares, 1.0 / 3, 0.01);
  EXPECT_NEAR(half.pdf({0, 0.6F, 0.8F}) * 2 * static_cast<float>(kPi), 1, 1e-6);
}

TEST(EnvironmentImage, WhiteIsTheConstantEnvironment) {
  Scene scene{};
  scene.camera = test::pinhole();
  const Curve emission(std::vector<Knot>{{400, 1}, {700, 3}});
  const std::vector<Channel> channels = observer_channels(Observer::cie1931);
  const Light plain{"sky", EnvironmentLight{}, emission};
  const Light white{"sky",
                    EnvironmentLight{std::make_shared<const EnvironmentImage>(
                        16, 8, Texels(128, {1, 1, 1}), environment_frame({0, 0, 1}, 0), emission, channels)},
                    emission};
  Random random(23);
  for (int i = 0; i < 1000; ++i) {
    const V3f wi(random.direction());
    const SampledSpectrum nm(static_cast<float>(random.between(300, 1100)));
    EXPECT_NEAR(emission_from(white, wi, nm)[0] / emission_from(plain, wi, nm)[0], 1, 1e-6);
    EXPECT_NEAR(
        light_pdf(white, {}, {}, wi, V3f(0), V3f(0), 0) / light_pdf(plain, {}, {}, wi, V3f(0), V3f(0), 0), 1,
        1e-5);
    const auto sample = sample_light(white, {}, {}, random.pair(), 0);
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->pdf * 4 * static_cast<float>(kPi), 1, 1e-5);
  }
  EXPECT_NEAR(power(white, 2).integral() / power(plain, 2).integral(), 1, 1e-12);
}

TEST(EnvironmentImage, OneHotTexelLightsAsItShould) {
  constexpr int kWidth = 64;
  constexpr int kHeight = 32;
  Texels texels(kWidth * kHeight, {1e-3F, 1e-3F, 1e-3F});
  constexpr int kRow = 10;
  constexpr int kColumn = 40;
  texels[kRow * kWidth + kColumn] = {1e8F, 1e8F, 1e8F};
  const Light sky{
      "sky", EnvironmentLight{std::make_shared<const EnvironmentImage>(image_of(kWidth, kHeight, texels))},
      Curve(2.0)};
  // On a horizontal surface: the integral of cos theta sin theta over the texel.
  const double top = kPi * kRow / kHeight;
  const double bottom = kPi * (kRow + 1) / kHeight;
  const double irradiance =
      2e8 * (2 * kPi / kWidth) * (std::pow(std::sin(bottom), 2) - std::pow(std::sin(top), 2)) / 2;
  Random random(24);
  double sum = 0;
  constexpr int kSamples = 64;
  for (int i = 0; i < kSamples; ++i) {
    const auto sample = sample_light(sky, {}, {}, random.pair(), 0);
    ASSERT_TRUE(sample);
    sum += static_cast<double>(emission_from(sky, sample->wi, kGreen)[0] * std::max(sample->wi.z, 0.0F) /
                               sample->pdf);
  }
  EXPECT_NEAR(sum / kSamples / irradiance, 1, 0.01);
  EXPECT_NEAR(power(sky, 1).integral() /
                  (2e8 * 800 * 4 * kPi * kPi / (kWidth * kHeight) * 1.5708 * std::sin((top + bottom) / 2)),
              1, 1e-2);
}

TEST_F(EnvironmentFileTest, ReadsImages) {
  Image image{
      4,
      2,
      {{"R", {8, 0, 0, 0, 0, 0, 0, 0}}, {"G", std::vector<float>(8, 1)}, {"B", std::vector<float>(8, 0)}},
      {}};
  write_exr(folder_ / "sky.exr", image);
  const std::string text =
      R"({"lights": [{"environment": {"image": "sky.exr", "up": [0, 1, 0], "rotate_deg": 180}, "emission": {"illuminant": "D65", "radiance": 5}}]})";
  const Loaded loaded = load(text);
  ASSERT_TRUE(loaded.scene) << loaded.text();
  ASSERT_EQ(loaded->background().size(), 1U);
  const Light& sky = loaded->lights[0];
  // The image's left edge is opposite its center, which looks along -x: it is at +x, above.
  EXPECT_NEAR(emission_from(sky, {0.7F, 0.7F, 0.1F}, SampledSpectrum(650))[0] /
                  (8 * static_cast<float>(sky.emission(650.0))),
              1, 0.02);
  EXPECT_LT(emission_from(sky, {-0.7F, 0.7F, 0.1F}, SampledSpectrum(650))[0], 0.02F);
  const auto drawn = sample_light(sky, loaded->shapes, {}, {0.5F, 0.25F}, 0);
  ASSERT_TRUE(drawn) << "by what the sensor of the scene sees";
  EXPECT_GT(drawn->wi.y, 0);
  EXPECT_GT(loaded->memory_bytes(), 8 * (sizeof(float) * 3 + sizeof(double)));
  image.channels[0].values[0] = 7;
  write_exr(folder_ / "sky.exr", image);
  EXPECT_NE(load(text)->sha256, loaded->sha256);
  image.channels[0].values[3] = -1;
  write_exr(folder_ / "sky.exr", image);
  EXPECT_NE(load(text).text().find(
                "/lights/0/environment/image: warning: environment \"sky.exr\": negative values set to 0: 1"),
            std::string::npos);
  write_exr(folder_ / "sky.exr", {2, 1, {{"Y", {1, 2}}}, {}});
  EXPECT_TRUE(load(text).scene) << "grey";
  write_exr(folder_ / "sky.exr", {2, 1, {{"Y", {-1, 2}}}, {}});
  EXPECT_NE(load(text).text().find("negative values set to 0: 1\n"), std::string::npos) << load(text).text();
  write_exr(folder_ / "sky.exr", {2, 1, {{"Y", {1, 2}}}, {}});
  std::filesystem::rename(folder_ / "sky.exr", folder_ / "SKY.EXR");
  EXPECT_TRUE(load(std::regex_replace(text, std::regex("sky.exr"), "SKY.EXR")).scene) << "in capitals";
}

TEST_F(EnvironmentFileTest, PicturesOfRadianceAreWhatTheirLinesSay) {
  const std::string text =
      R"({"lights": [{"environment": {"image": "sky.hdr"}, "emission": {"spectrum": 1}}]})";
  // Grey texels of 1 and 2 on top of each other.
  const auto load_sky = [&](const std::string& lines, const std::string& resolution) {
    write_atomically(folder_ / "sky.hdr", "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n" + resolution +
                                              "\n\x80\x80\x80\x81\x80\x80\x80\x82");
    return load(text);
  };
  const auto zenith = [&](const std::string& lines, const std::string& resolution) {
    const Loaded loaded = load_sky(lines, resolution);
    EXPECT_TRUE(loaded.scene) << loaded.text();
    return loaded.scene ? emission_from(loaded->lights[0], {0.1F, 0.2F, 0.9F}, kGreen)[0] : 0;
  };
  EXPECT_NEAR(zenith("PRIMARIES=0 0 0 0 0 0 0 0\n", "-Y 2 +X 1"), 1, 1e-3);
  EXPECT_NEAR(zenith("EXPOSURE=2\nEXPOSURE=2.5\n", "-Y 2 +X 1"), 0.2, 1e-3) << "which is taken off";
  EXPECT_NEAR(zenith("", "+Y 2 +X 1"), 2, 1e-3) << "from the bottom";
  const Loaded wide = load_sky("PRIMARIES=.64 .33 .29 .6 .15 .06 .3333 .3333\n", "-Y 2 +X 1");
  EXPECT_FALSE(wide.scene);
  EXPECT_NE(wide.text().find("its chromaticities are not those of Rec.709 (got 0.64 0.33 0.29 0.6"),
            std::string::npos)
      << wide.text();
  EXPECT_THROW((void)load_sky("GAMMA=2.2\n", "-Y 2 +X 1"), Error);
}

TEST_F(EnvironmentFileTest, RefusesWhatIsNoSky) {
  const auto loaded_with = [&](const std::string& members) {
    return load(R"({"lights": [{"environment": {)" + members + R"(}, "emission": {"spectrum": 1}}]})");
  };
  const auto expect_refused = [&](const std::string& members, ErrorCode code, const char* message) {
    const Loaded loaded = loaded_with(members);
    EXPECT_FALSE(loaded.scene);
    EXPECT_EQ(loaded.diagnostics.code(), code);
    EXPECT_NE(loaded.text().find(message), std::string::npos) << loaded.text();
  };
  write_exr(folder_ / "nan.exr", {2, 1, {{"R", {1, NAN}}, {"G", {1, 1}}, {"B", {1, 1}}}, {}});
  write_exr(folder_ / "depth.exr", {2, 1, {{"Z", {1, 1}}}, {}});
  expect_refused(R"("image": "nan.exr")", ErrorCode::input, "texel (1, 0) (got nan, allowed [0, 1e+30])");
  expect_refused(R"("image": "depth.exr")", ErrorCode::input,
                 "the image needs channels R, G and B, or only Y");
  write_exr(folder_ / "xyz.exr", {1, 1, {{"X", {1}}, {"Y", {1}}, {"Z", {1}}}, {}});
  expect_refused(R"("image": "xyz.exr")", ErrorCode::input, "the image needs channels R, G and B, or only Y");
  const std::vector<ImageChannel> rgb{{"R", {1}}, {"G", {1}}, {"B", {1}}};
  write_exr(folder_ / "wide.exr",
            {1, 1, rgb, {{kPrimariesKey, "0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329"}}});
  expect_refused(R"("image": "wide.exr")", ErrorCode::input, "its chromaticities are not those of Rec.709");
  write_exr(folder_ / "rec709.exr",
            {1, 1, rgb, {{kPrimariesKey, "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329"}}});
  EXPECT_TRUE(loaded_with(R"("image": "rec709.exr")").scene);
  write_exr(folder_ / "night.exr", {1, 1, {{"Y", {0}}}, {}});
  EXPECT_NE(
      loaded_with(R"("image": "night.exr")").text().find("environment \"night.exr\" is black everywhere"),
      std::string::npos);
  expect_refused(R"("image": "sky.png")", ErrorCode::input,
                 "linear values are needed (got \".png\", allowed .exr, .hdr)");
  expect_refused(R"("image": "http://x/sky.exr")", ErrorCode::input, "expected a file");
  expect_refused(R"("up": [0, 0, 1])", ErrorCode::scene, "up requires image, which is missing");
  expect_refused(R"("image": "nan.exr", "up": [0, 0, 0])", ErrorCode::scene, "a direction must not be zero");
  EXPECT_THROW((void)loaded_with(R"("image": "gone.exr")"), Error);
}

}  // namespace
}  // namespace abbe
