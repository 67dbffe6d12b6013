#include "preview/viewer_film.h"

#include <gtest/gtest.h>

#include "results/rendered_film.h"
#include "tests/preview/rendered_cornell.h"

namespace abbe {
namespace {

constexpr const char* kSpectral =
    R"({"resolution": [12, 8], "exposure_s": 0.02, "spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 50}})";
constexpr const char* kMosaic =
    R"({"resolution": [12, 8], "mosaic": [["R", "G"], ["G", "B"]], "channels": {"B": {"band": [400, 500]},
    "G": {"band": [500, 600]}, "R": {"band": [600, 700]}}})";
constexpr const char* kFour = R"({"resolution": [12, 8], "channels": {"a": {"band": [400, 500]},
    "b": {"band": [500, 600]}, "c": {"band": [600, 700]}, "d": {"band": [400, 700]}}})";

test::RenderedScene seen_by(const std::string& sensor, std::optional<Crop> crop = {}) {
  return test::rendered_cornell({{"/sensor", sensor}, {"/render/samples", "8"}}, crop);
}

TEST(ViewerFilm, PixelsAreThoseOfTheFilmsFile) {
  for (const char* sensor : {kSpectral, kMosaic, R"({"resolution": [12, 8], "observer": "1931"})"}) {
    const test::RenderedScene made = seen_by(sensor);
    ViewerFilm film(made.scene, {});
    film.replace(take_snapshot(made.scene, made.part.identity, made.part.result, 3));
    const Image file = film_image(made.part);
    for (const int x : {0, 5, 11}) {
      const auto pixel = film.pixel(x, 7);
      ASSERT_TRUE(pixel);
      EXPECT_EQ(pixel->samples, 8U);
      EXPECT_GE(pixel->values.size(), made.scene.film_planes().size());
      for (const auto& value : pixel->values)
        EXPECT_EQ(value.value, file.find(value.channel)->values[static_cast<std::size_t>(7 * 12 + x)])
            << value.channel;
    }
    EXPECT_EQ(film.pixel(5, 7)->values.back().wavelength_nm.has_value(), made.scene.spectral.has_value());
    EXPECT_FALSE(film.pixel(12, 0));
    EXPECT_FALSE(film.pixel(0, -1));
  }
}

TEST(ViewerFilm, HasThePixelsOfItsCropAlone) {
  const test::RenderedScene made = seen_by(kSpectral, Crop{3, 2, 7, 5});
  ViewerFilm film(made.scene, {});
  EXPECT_FALSE(film.pixel(0, 0));  // there is no film yet
  film.replace(take_snapshot(made.scene, made.part.identity, made.part.result, 1));
  for (const auto& [x, y] : {std::pair{3, 2}, {6, 2}, {3, 4}, {6, 4}}) EXPECT_TRUE(film.pixel(x, y)) << x;
  for (const auto& [x, y] : {std::pair{2, 2}, {7, 4}, {3, 1}, {6, 5}, {0, 0}})
    EXPECT_FALSE(film.pixel(x, y)) << x << ", " << y;
}

TEST(ViewerFilm, MakesAPictureOnceForAllWhoAskForIt) {
  const test::RenderedScene made = seen_by(kMosaic);
  ViewerFilm film(made.scene, {});
  ASSERT_GE(film.views().size(), 2U);
  EXPECT_EQ(film.picture(film.views()[0], 0), nullptr);  // there is no film yet
  film.replace(take_snapshot(made.scene, made.part.identity, made.part.result, 1));
  const auto picture = film.picture(film.views()[0], 0);
  ASSERT_NE(picture, nullptr);
  EXPECT_EQ(picture->substr(1, 3), "PNG");
  EXPECT_EQ(film.picture(film.views()[0], 0), picture);
  EXPECT_NE(*film.picture(film.views()[0], 1), *picture);
  EXPECT_NE(*film.picture(film.views()[1], 0), *picture);
  EXPECT_EQ(film.picture("another", 0), nullptr);
  film.replace(take_snapshot(made.scene, made.part.identity, made.part.result, 1));
  EXPECT_EQ(film.number(), 2U);
  EXPECT_NE(film.picture(film.views()[0], 0), picture);
}

TEST(ViewerFilm, ShowsTheChannelsOfASensorThatNoDisplayShows) {
  const test::RenderedScene made = seen_by(kFour);
  ViewerFilm film(made.scene, {});
  EXPECT_EQ(film.views(), made.scene.channel_names());
  film.replace(take_snapshot(made.scene, made.part.identity, made.part.result, 1));
  const auto one = film.picture("a", 0);
  ASSERT_NE(one, nullptr);
  EXPECT_NE(*film.picture("c", 0), *one);
}

}  // namespace
}  // namespace abbe
