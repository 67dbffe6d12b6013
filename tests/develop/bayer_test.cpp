#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "develop/develop.h"
#include "develop/linear_image.h"
#include "develop/raw_picture.h"
#include "sensor/readout/demosaic.h"
#include "tests/develop/films.h"
#include "tests/sensor/bayer.h"

// Develops mosaics in all four Bayer phases, from the film and from its raw files.

namespace abbe {
namespace {

const std::vector<std::string> kRgb{"R", "G", "B"};
constexpr std::array<float, 3> kElectrons{4000, 16000, 36000};
constexpr int kBayerWidth = 7;
constexpr int kBayerHeight = 5;

// A uniform film whose red, green and blue pixels expect `kElectrons`; their area is 1e-10 m^2.
Image even_film(const Mosaic& mosaic) {
  Image film = test::counting_film();
  film.width = kBayerWidth;
  film.height = kBayerHeight;
  film.channels = {{"raw", {}}, {"Variance.raw", std::vector<float>(film.pixels(), 0)}};
  for (int y = 0; y < kBayerHeight; ++y)
    for (int x = 0; x < kBayerWidth; ++x)
      film.channels[0].values.push_back(1e10F * kElectrons.at(static_cast<std::size_t>(mosaic.at(x, y))));
  film.metadata["sensor_channels"] = "raw";
  film.metadata["mosaic"] = to_text(mosaic, kRgb);
  film.metadata["mosaic_channels"] = "R,G,B";
  for (const std::string& channel : kRgb) film.metadata["channel." + channel] = film.metadata["channel.V"];
  film.metadata["to_xyz_d65"] = "0.4 0.35 0.2 0.2 0.7 0.1 0.02 0.1 0.9";
  film.metadata["sensor"] = R"({"readout": {"gain_e_per_dn": 1, "bits": 16, "offset_dn": 100}})";
  return film;
}

// Each plane is uniform within 5 standard deviations of the photon noise at its smallest signal (8 %).
void expect_even(const Image& planes, double scale, const std::string& what) {
  ASSERT_EQ(planes.channels.size(), 3U) << what;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    EXPECT_EQ(planes.channels[channel].name, kRgb[channel]);
    const double expected = static_cast<double>(kElectrons.at(channel)) * scale;
    for (std::size_t pixel = 0; pixel < planes.pixels(); ++pixel)
      EXPECT_NEAR(static_cast<double>(planes.channels[channel].values[pixel]) / expected, 1, 0.08)
          << what << ' ' << kRgb[channel] << " at pixel " << pixel;
  }
}

ExposedFilm exposed_film(const Image& film) {
  Diagnostics diagnostics;
  std::optional<FilmSensor> sensor = read_film_sensor(film, "bayer.exr", {}, {}, {}, diagnostics);
  EXPECT_TRUE(sensor) << diagnostics.text();
  return {film, *std::move(sensor)};
}

TEST(BayerPhases, AreDevelopedIntoTheirColours) {
  for (const auto& [name, mosaic] : test::kBayerPhases) {
    const ExposedFilm film = exposed_film(even_film(mosaic));
    expect_even(display_planes(film.sensor, develop(film, 1).calibrated), 1e10, name);
  }
}

TEST(BayerPhases, AreWrittenIntoRawFilesAndReadBack) {
  const auto path = std::filesystem::temp_directory_path() / ("abbe_bayer_" + std::to_string(::getpid()));
  for (const auto& [name, mosaic] : test::kBayerPhases) {
    const ExposedFilm film = exposed_film(even_film(mosaic));
    const RawPicture raw = raw_picture(develop(film, 1), film.sensor);
    for (const auto& [end, write] : {std::pair{".dng", &write_dng}, {".fits", &write_fits}}) {
      const std::filesystem::path file = path.string() + end;
      write(file, raw);
      const LinearImage read = read_linear_image(file);
      std::filesystem::remove(file);
      ASSERT_EQ(read.mosaic, mosaic) << name << end;
      const Image planes =
          demosaic(read.image, read.image.channels.front().name, *read.mosaic, read.channels);
      expect_even(planes, 1, std::string(name) + end);
    }
  }
}

}  // namespace
}  // namespace abbe
