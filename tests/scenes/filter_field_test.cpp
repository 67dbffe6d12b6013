#include <array>
#include <cmath>

#include <fmt/format.h>

#include "calibration/chart/delta_e.h"
#include "results/rendered_film.h"
#include "results/white.h"
#include "spectral/colorimetry.h"
#include "spectral/rgb.h"
#include "tests/scenes/scene_fixture.h"

// White behind interference filters, at the centre of the field and off the axis.

namespace abbe {
namespace {

constexpr int kSide = 12;

// An even dome before an f/1.4 lens and three filters of 40 nm; the corners are seen under 18 degrees.
Scene white_dome(const char* filter) {
  std::string channels;
  for (const auto& [name, low] : {std::pair("R", 630), std::pair("G", 530), std::pair("B", 430)})
    channels += fmt::format(R"({}"{}": {{"filters": [{}]}})", channels.empty() ? "" : ", ", name,
                            fmt::format(fmt::runtime(filter), low, low + 40));
  return test::load_text(fmt::format(
      R"({{"abbe": 1,
           "camera": {{"thin_lens": {{"focal_length": 0.016, "f_number": 1.4}}, "from": [0, 0, 0], "to": [0, 0, 1], "up": [0, 1, 0]}},
           "sensor": {{"resolution": [{0}, {0}], "pixel_pitch_um": 600, "response": "quantum", "channels": {{{1}}}}},
           "lights": [{{"environment": {{}}, "emission": {{"illuminant": "LED-B3", "radiance": 1}}}}],
           "render": {{"integrator": "path", "samples": 4096}}}})",
      kSide, channels));
}
Scene shifting_dome() {
  return white_dome(R"({{"transmittance": {{"band": [{}, {}]}}, "effective_index": 1.8}})");
}

Image planes_of(const Film& film) {
  Image planes{kSide, kSide, {{"R", {}}, {"G", {}}, {"B", {}}}, {}};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < kSide * kSide; ++i)
      planes.channels[k].values.push_back(static_cast<float>(film.mean(i, static_cast<int>(k))));
  return planes;
}

// CIEDE2000 of a square of 2 x 2 pixels with white, at equal luminance.
double tint(const Image& planes, const Matrix3& to_xyz_d65, int x0, int y0) {
  std::array<double, 3> sum{};
  for (std::size_t k = 0; k < 3; ++k)
    for (int y = y0; y < y0 + 2; ++y)
      for (int x = x0; x < x0 + 2; ++x)
        sum[k] += static_cast<double>(planes.channels[k].values[static_cast<std::size_t>(y * kSide + x)]);
  XYZ xyz = multiply(to_xyz_d65, sum);
  const double luminance = xyz[1];
  for (double& v : xyz) v /= luminance;
  const XYZ white = unit_xyz(kD65);
  return delta_e_2000(xyz_to_lab(white, white), xyz_to_lab(xyz, white));
}

TEST(FilterField, ChannelsAtTheCentreCountWhatTheFilmCounts) {
  const Scene scene = shifting_dome();
  const RenderResult result = render(scene, {});
  const std::vector<Channel> channels = channels_at_center(scene);
  const Curve light = scene.lights.front().emission.curve();
  const auto counted = [&](int k) { return test::region(result.film, k, 5, 5, 7, 7).mean; };
  const auto expected = [&](std::size_t k) { return integral_of_product(light, channels[k].weight); };
  EXPECT_NEAR(counted(0) / counted(1) / (expected(0) / expected(1)), 1, 0.02);
  EXPECT_NEAR(counted(2) / counted(1) / (expected(2) / expected(1)), 1, 0.02);
}

TEST(FilterField, WhiteIsNeutralAtTheCentreAndOverTheFlattenedField) {
  const Scene scene = shifting_dome();
  Image planes = planes_of(render(scene, {}).film);
  const Matrix3 to_xyz = display_of(scene).to_xyz_d65();
  const WhiteField field = white_field(scene).value();
  EXPECT_LT(tint(planes, to_xyz, 5, 5), 1);
  const double shift = neutral_shift(field, to_xyz);
  EXPECT_NEAR(neutral_shift(scene).value(), shift, 1e-9);
  const double near_corner = tint(planes, to_xyz, 0, 0);
  EXPECT_GT(near_corner, 2);
  EXPECT_GT(near_corner, 0.5 * shift);
  EXPECT_LT(near_corner, 1.1 * shift) << "which is that of the corner itself";
  flatten(planes, std::array<std::string, 3>{"R", "G", "B"}, field);
  for (const int at : {0, 2, 5, 10}) EXPECT_LT(tint(planes, to_xyz, at, at), 1.2) << at;
}

TEST(FilterField, FiltersWithoutAnAngleHaveNoField) {
  const Scene scene = white_dome(R"({{"band": [{}, {}]}})");
  EXPECT_FALSE(white_field(scene));
  EXPECT_FALSE(neutral_shift(scene));
  EXPECT_FALSE(film_attributes(scene).contains(kWhiteFieldKey));
  EXPECT_TRUE(film_attributes(shifting_dome()).contains(kWhiteFieldKey));
}

}  // namespace
}  // namespace abbe
