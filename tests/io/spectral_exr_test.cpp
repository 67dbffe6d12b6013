#include "io/spectral_exr.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "io/error.h"
#include "io/exr.h"
#include "test_files.h"

namespace abbe {
namespace {

SpectralImage sample() {
  SpectralImage image{2, 1, {}, {}, {{"seed", "7"}, {"expTime", "0.02"}}};
  image.bands = {{380, {0, 1e-40F}}, {545.5, {1.5F, -0.0F}}, {1000.25, {3e38F, 4}}};
  image.others = {{"B", {0.25F, 0}}, {"G", {0.5F, 0}}, {"R", {1, 0}}};
  return image;
}

double wavelength(const std::string& name) {
  const auto parsed = parse_spectral_channel(name, "a.exr");
  return parsed ? parsed->center_nm : -1;
}

/// What reading the layout of an image says, after `change`.
template <typename Change>
std::string complaint_of(Change change) {
  Image image = spectral_layout(sample());
  change(image);
  try {
    (void)spectral_image(image, "a.exr");
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::input);
    return error.what();
  }
}
std::string complaint_of_channel(const std::string& name) {
  return complaint_of([&name](Image& image) { image.channels.push_back({name, {1, 1}}); });
}

TEST(SpectralExr, NamesFollowTheGrammar) {
  EXPECT_EQ(spectral_channel(550), "S0.550,000000nm");
  EXPECT_EQ(spectral_channel(1000.25), "S0.1000,250000nm");
  for (const auto& [name, expected] :
       {std::pair{"S0.550,000000nm", 550.0}, std::pair{"S0.550nm", 550.0}, std::pair{"S0.,5um", 500.0},
        std::pair{"S0.0,55um", 550.0}, std::pair{"S3.5,5E2nm", 550.0}, std::pair{"S0.55e+1nm", 550.0},
        std::pair{"T.5,5E-7m", 550.0}, std::pair{"S0.550,nm", 550.0}, std::pair{"S0.5,5e-4mm", 550.0},
        std::pair{"S0.5,5E-8dam", 550.0}, std::pair{"S0.5500E-1nm", 550.0}})
    EXPECT_NEAR(wavelength(name), expected, 1e-9) << name;
  EXPECT_EQ(wavelength("S0.545,500000nm"), 545.5) << "exactly";
  for (const char* name : {"S0.545THz", "S0.545E12Hz", "S0.0,545PHz", "S0.545000GHz"})
    EXPECT_NEAR(wavelength(name), 550.0779, 1e-4) << name;
  EXPECT_EQ(parse_spectral_channel("S2.550nm", "")->kind, '2');
  EXPECT_EQ(parse_spectral_channel("T.550nm", "")->kind, 'T');
}

TEST(SpectralExr, OtherChannelsAreLeftAlone) {
  for (const char* name :
       {"R", "S0.R", "Variance.S0.550,000000nm", "S4.550nm", "T", "T.x", "S0", "albedo.T.5nm"})
    EXPECT_FALSE(parse_spectral_channel(name, "")) << name;
}

TEST(SpectralExr, NamesThatOnlyLookSpectralAreRefused) {
  for (const char* name :
       {"S0.nm", "S0.,nm", "S0.E5nm", "S0.0nm", "S0.0THz", "T.m", "S1.Hz", "S0.0,0E3um", "S0.1E999nm"})
    EXPECT_EQ(complaint_of_channel(name), "a.exr: channel \"" + std::string(name) + "\" names no wavelength");
  for (const char* name : {"S0.550.5nm", "S0.-550nm", "S0.550 nm", "S0.5,5,0nm", "S0.550xm", "S0.fivem"})
    EXPECT_EQ(complaint_of_channel(name),
              "a.exr: channel \"" + std::string(name) +
                  "\" is not a valid spectral name (expected a name like S0.550,5nm)");
}

TEST(SpectralExr, EveryBitComesBackAndBandsAreSortedByNumber) {
  const auto path = test_folder() / "a.exr";
  const SpectralImage image = sample();
  write_exr(path, spectral_layout(image));
  const Image file = read_exr(path);
  EXPECT_EQ(file.channels.front().name, "B") << "channels of a file are sorted as text";
  EXPECT_EQ(file.channels[3].name, "S0.1000,250000nm");
  EXPECT_TRUE(is_spectral(file));
  const SpectralImage read = spectral_image(file, path.string());
  EXPECT_EQ(read.width, 2);
  EXPECT_EQ(read.height, 1);
  ASSERT_EQ(read.bands.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read.bands[i].center_nm, image.bands[i].center_nm);
    for (std::size_t p = 0; p < 2; ++p)
      EXPECT_EQ(std::bit_cast<std::uint32_t>(read.bands[i].radiance[p]),
                std::bit_cast<std::uint32_t>(image.bands[i].radiance[p]))
          << i << p;
  }
  ASSERT_EQ(read.others.size(), 3U);
  EXPECT_EQ(read.others[2].name, "R");
  EXPECT_EQ(read.metadata.at("seed"), "7");
  EXPECT_EQ(read.metadata.at("spectralLayoutVersion"), "1.0");
  EXPECT_EQ(read.metadata.at("emissiveUnits"), "W.m^-2.sr^-1");
}

TEST(SpectralExr, AnImageIsSpectralByItsAttributeOrItsChannels) {
  EXPECT_TRUE(is_spectral({1, 1, {{"R", {1}}}, {{"spectralLayoutVersion", "1.0"}}}));
  EXPECT_TRUE(is_spectral({1, 1, {{"S0.550nm", {1}}}, {}}));
  EXPECT_FALSE(is_spectral({1, 1, {{"R", {1}}, {"Variance.S0.550nm", {1}}}, {{"seed", "7"}}}));
}

// S1.film and the like are channels of a colour film.
TEST(SpectralExr, ComponentsAloneMakeNoImageSpectral) {
  EXPECT_FALSE(is_spectral({1, 1, {{"film", {1}}, {"S1.film", {1}}}, {}}));
}

SpectralImage polarised_sample() {
  SpectralImage image = sample();
  for (std::size_t i = 0; i < 3; ++i)
    for (const SpectralBand& band : image.bands) {
      const auto value = static_cast<float>(i + 1);
      image.polarised.at(i).push_back({band.center_nm, {value, -value}});
    }
  return image;
}

TEST(SpectralExr, PolarisationComesBackRightHanded) {
  EXPECT_EQ(spectral_channel(550, 2), "S2.550,000000nm");
  EXPECT_FALSE(spectral_layout(sample()).metadata.contains(kHandednessKey));
  Image layout = spectral_layout(polarised_sample());
  EXPECT_EQ(layout.metadata.at(kHandednessKey), "right");
  EXPECT_EQ(layout.find("S3.545,500000nm")->values, (std::vector<float>{3, -3}));
  for (const char* handedness : {"right", "left"}) {
    layout.metadata[kHandednessKey] = handedness;
    const SpectralImage read = spectral_image(layout, "a.exr");
    EXPECT_TRUE(read.is_polarised());
    EXPECT_EQ(read.metadata.at(kHandednessKey), "right");
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(read.polarised.at(i).size(), 3U);
      const float value = static_cast<float>(i + 1) * (i == 2 && *handedness == 'l' ? -1.0F : 1.0F);
      EXPECT_EQ(read.polarised.at(i)[2].center_nm, 1000.25);
      EXPECT_EQ(read.polarised.at(i)[2].radiance, (std::vector<float>{value, -value})) << i << handedness;
    }
  }
}

TEST(SpectralExr, OpenImageIoReadsIt) {
  const auto path = test_folder() / "a.exr";
  write_exr(path, spectral_layout(sample()));
  const auto input = OIIO::ImageInput::open(path.string());
  ASSERT_TRUE(input) << OIIO::geterror();
  const OIIO::ImageSpec& spec = input->spec();
  EXPECT_EQ(spec.nchannels, 6);
  EXPECT_EQ(spec.get_string_attribute("emissiveUnits"), "W.m^-2.sr^-1");
  EXPECT_FLOAT_EQ(spec.get_float_attribute("ExposureTime"), 0.02F);
  std::vector<float> pixels(12);
  ASSERT_TRUE(input->read_image(0, 0, 0, 6, OIIO::TypeDesc::FLOAT, pixels.data()));
  const int line = spec.channelindex("S0.545,500000nm");
  ASSERT_GE(line, 0);
  EXPECT_EQ(pixels[static_cast<std::size_t>(line)], 1.5F);
  EXPECT_EQ(pixels[static_cast<std::size_t>(spec.channelindex("R"))], 1.0F);
}

TEST(SpectralExr, BandsEndHalfwayBetweenTheirCentres) {
  EXPECT_EQ(band_edges({{400, {}}, {410, {}}, {430, {}}}), (std::vector<double>{395, 405, 420, 440}));
}

TEST(SpectralExr, WhatTheLayoutRequiresMustBeThere) {
  const auto without = [](const char* key) {
    return complaint_of([key](Image& image) { image.metadata.erase(key); });
  };
  const auto with = [](const char* key, const char* value) {
    return complaint_of([=](Image& image) { image.metadata[key] = value; });
  };
  EXPECT_EQ(complaint_of([](Image&) {}), "");
  EXPECT_EQ(without("spectralLayoutVersion"),
            "a.exr: missing attribute \"spectralLayoutVersion\" (allowed \"1.0\")");
  EXPECT_EQ(with("spectralLayoutVersion", "2.0"),
            "a.exr: unsupported spectralLayoutVersion (got \"2.0\", allowed \"1.0\")");
  EXPECT_EQ(without("emissiveUnits"),
            "a.exr: missing attribute \"emissiveUnits\" (allowed \"W.m^-2.sr^-1\")");
  EXPECT_EQ(with("emissiveUnits", "cd.m^-2"),
            "a.exr: unsupported emissiveUnits (got \"cd.m^-2\", allowed \"W.m^-2.sr^-1\")");
  EXPECT_EQ(complaint_of([](Image& image) { image.channels.resize(4); }),
            "a.exr: too few bands of radiance to infer their widths (got 1, allowed 2 or more)");
}

TEST(SpectralExr, ReflectancesRepetitionsAndHalfPolarisedImagesAreRefused) {
  EXPECT_EQ(complaint_of_channel("T.600nm"),
            "a.exr: channel \"T.600nm\" is a reflectance (allowed radiances, S0)");
  EXPECT_EQ(complaint_of_channel("S0.0,38um"), "a.exr: two channels at 380 nm");
  const auto polarised = [](const char* third, const char* handedness) {
    return complaint_of([=](Image& image) {
      for (const char* stokes : {"S1", "S2", "S3"})
        for (const char* band : {".380nm", ".545,5nm", third})
          image.channels.push_back({std::string(stokes) + band, {0, 0}});
      if (*handedness) image.metadata["polarisationHandedness"] = handedness;
    });
  };
  EXPECT_EQ(polarised(".1000,25nm", "left"), "");
  EXPECT_EQ(polarised(".1001nm", "right"), "a.exr: S1 has other wavelengths than S0");
  for (const char* handedness : {"", "up"})
    EXPECT_EQ(polarised(".1000,25nm", handedness),
              "a.exr: polarised, but the attribute \"polarisationHandedness\" is missing or invalid (allowed "
              "\"left\", \"right\")");
}

}  // namespace
}  // namespace abbe
