#include "develop/white_field.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "develop/develop.h"
#include "films.h"
#include "io/error.h"

namespace abbe {
namespace {

const std::array<std::string, 3> kColors{"R", "G", "B"};
// Red falls to 0.8 at the corner, blue rises to 1.1.
const WhiteField kTinted{{{1, 1, 1}, {0.95, 1, 1.05}, {0.8, 1, 1.1}}};

Image even_planes(int width, int height) {
  Image planes{width, height, {}, {}};
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (const std::string& name : kColors) planes.channels.push_back({name, std::vector<float>(pixels, 1)});
  return planes;
}

TEST(WhiteField, TextHoldsEveryDigit) {
  const WhiteField field{{{1, 1, 1}, {1.0 / 3, 1, 0.7}}};
  EXPECT_EQ(to_text(kTinted), "1,1,1;0.95,1,1.05;0.8,1,1.1");
  EXPECT_EQ(parse_white_field(to_text(field), 3).value().relative, field.relative);
  for (const char* wrong : {"", "1,1,1", "1,1,1;1,1", "1,1,1;1,0,1", "1,1,1;1,x,1", "1,1,1;1,-1,1"})
    EXPECT_FALSE(parse_white_field(wrong, 3)) << wrong;
  EXPECT_FALSE(parse_white_field("1,1;1,1", 3));
}

TEST(WhiteField, FlatteningDividesByTheResponseAtTheDistance) {
  Image planes = even_planes(8, 6);
  flatten(planes, kColors, kTinted);
  const auto value = [&](std::size_t k, std::size_t x, std::size_t y) {
    return static_cast<double>(planes.channels[k].values[8 * y + x]);
  };
  // The pixel at 4.5, 3.5 is half a pixel from the center in both directions; the corner is 5 pixels away.
  const double near = std::hypot(0.5, 0.5) / 5;
  EXPECT_NEAR(value(0, 4, 3), 1 / (1 - 0.05 * 2 * near), 1e-6);
  const double far = std::hypot(3.5, 2.5) / 5;  // in the outer of the two steps
  EXPECT_NEAR(value(0, 0, 0), 1 / (0.95 - 0.15 * (2 * far - 1)), 1e-6);
  EXPECT_NEAR(value(2, 7, 5), 1 / (1.05 + 0.05 * (2 * far - 1)), 1e-6);
  EXPECT_EQ(value(1, 0, 0), 1);
  EXPECT_EQ(largest_response(kTinted), (std::vector<double>{1, 1, 1.1}));
}

TEST(WhiteField, ATintIsWarnedOfAndADimmingIsNot) {
  const Matrix3 to_xyz(0.41, 0.36, 0.18, 0.21, 0.72, 0.07, 0.02, 0.12, 0.95);  // approximately sRGB
  EXPECT_LT(neutral_shift({{{1, 1, 1}, {0.5, 0.5, 0.5}}}, to_xyz), 1e-9);
  const double shift = neutral_shift(kTinted, to_xyz);
  EXPECT_GT(shift, 5);
  EXPECT_EQ(neutral_shift({{{0.8, 1, 1.1}, {1, 1, 1}}}, to_xyz), shift) << "wherever it is";
  EXPECT_FALSE(field_tint_warning(1, ""));
  EXPECT_NE(field_tint_warning(2.34, "so be it").value().find("by up to 2.3 ΔE00: so be it"),
            std::string::npos);
}

TEST(WhiteField, IsReadFromTheFilmAndDividesPicturesOnRequest) {
  Image film = test::counting_film();
  film.channels.clear();
  for (const std::string& name : kColors) {
    film.channels.push_back({name, {4e12F, 4e12F}});
    film.metadata["channel." + name] = film.metadata["channel.V"];
  }
  film.metadata["sensor_channels"] = "R,G,B";
  film.metadata["to_xyz_d65"] = "1 0 0 0 1 0 0 0 1";
  film.metadata[kWhiteFieldKey] = to_text(kTinted);
  const auto sensor = [&film] {
    Diagnostics diagnostics;
    return read_film_sensor(film, "a.exr", {}, {}, {}, diagnostics).value();
  };
  FilmSensor shown = sensor();
  ASSERT_TRUE(shown.white_field);
  EXPECT_EQ(display_planes(shown, film).channels[0].values, film.channels[0].values);
  shown.flattens_field = true;
  const double distance = 0.5 / std::hypot(1, 0.5);
  EXPECT_NEAR(display_planes(shown, film).channels[0].values[0] / 4e12F, 1 / (1 - 0.05 * 2 * distance), 1e-6);
  film.metadata[kWhiteFieldKey] = "1,1";
  EXPECT_THROW((void)sensor(), Error);
}

}  // namespace
}  // namespace abbe
