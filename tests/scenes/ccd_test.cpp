#include <cmath>

#include <fmt/format.h>

#include "sensor/readout/readout.h"
#include "tests/angles.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

// What a sensor counts behind its filters, in physical units.

namespace abbe {
namespace {

// A film of 16 small pixels on the axis of an f/4 lens, before a dome.
Scene flat_field(const std::string& sensor, const std::string& emission, int samples) {
  return test::load_text(fmt::format(
      R"({{"abbe": 1,
           "camera": {{"thin_lens": {{"focal_length": 0.05, "f_number": 4, "focus_distance": "infinity"}},
                       "from": [0, 0, 0], "to": [0, 0, 1], "up": [0, 1, 0]}},
           "sensor": {{"resolution": [4, 4], {}}},
           "lights": [{{"environment": {{}}, "emission": {}}}], "render": {{"samples": {}}}}})",
      sensor, emission, samples));
}
// Irradiance on its film per radiance of the dome.
constexpr double kFlatField_sr = kPi / (4 * 4 * 4);

TEST(FlatField, TStopsDimAndFillFactorsDoNot) {
  const auto mean = [](const std::vector<Override>& settings) {
    return test::whole(render(test::load("exposure.json", settings), {}).film).mean;
  };
  const double plain = mean({});
  EXPECT_NEAR(mean({{"/camera/thin_lens/t_stop", "5"}}) / plain, 0.64, 1e-3);
  EXPECT_EQ(mean({{"/sensor/fill_factor", "0.5"}}), plain);
  EXPECT_EQ(mean({{"/sensor/lens_transmission", "0.5"}}), plain / 2);
}

// A line of 1 W/(m^2 sr) where the filters leave it, cut it or stop it.
TEST(FlatField, LinesInBandsAreExactOrNothing) {
  const Scene scene = flat_field(
      R"("response": "energy", "channels": {"clear": {"filters": []}, "within": {"filters": [{"band": [545, 555], "value": 0.8}]},
         "half": {"band": [550, 560]}, "beside": {"band": [551, 560]}, "far": "bessell_I",
         "stack": {"filters": [{"band": [500, 560]}, {"band": [540, 600]}, 0.5]},
         "tilting": {"filters": [{"transmittance": {"band": [545, 555]}, "effective_index": 2}]}})",
      R"({"lines": [{"nm": 550, "width_nm": 1, "power": 1}]})", 1024);
  const RenderResult result = render(scene, {});
  EXPECT_EQ(result.stats.nonfinite_samples, 0U);
  const std::vector<double> expected{1, 0.8, 0.5, 0, 0, 0.5, 1};
  for (int channel = 0; channel < 7; ++channel) {
    const double mean = test::whole(result.film, channel).mean / kFlatField_sr;
    const double sought = expected[static_cast<std::size_t>(channel)];
    if (sought == 0)
      EXPECT_EQ(mean, 0) << channel;
    else
      EXPECT_NEAR(mean, sought, 2e-3) << channel;
  }
}

TEST(FlatField, AFilterWheelExposesEachFilterForItsTime) {
  const Scene scene = flat_field(
      R"("exposure_s": 0.1, "channels": {"short": {"filters": [{"band": [500, 600]}], "exposure_s": 0.02},
         "plain": {"band": [500, 600]}})",
      R"({"spectrum": 1})", 256);
  const Film film = render(scene, {}).film;
  EXPECT_NEAR(test::whole(film, 0).mean, 100 * 0.02 * kFlatField_sr, 2e-3);
  EXPECT_NEAR(test::whole(film, 0).mean / test::whole(film, 1).mean, 0.2, 1e-6);
}

// A lamp that gives 200 lx at 2 m, and the luminance that takes.
TEST(Meters, ReadLuxAndCandelaPerSquareMetre) {
  const auto read = [](const char* camera) {
    return test::
        whole(render(
                  test::load_text(fmt::format(
                      R"({{"abbe": 1, "camera": {{{}}}, "sensor": {{"observer": "1931", "resolution": [16, 16]}},
                  "lights": [{{"disc": {{"center": [0, 0, 2], "normal": [0, 0, -1], "radius": 0.3}},
                               "emission": {{"illuminant": "D65", "illuminance": 200, "distance": 2}}}}],
                  "render": {{"samples": 256}}}})",
                      camera)),
                  {})
                  .film,
              1)
            .mean;
  };
  EXPECT_NEAR(read(R"("irradiance_probe": {"at": [0, 0, 0], "normal": [0, 0, 1]})"), 200, 0.2);
  EXPECT_NEAR(
      read(
          R"("pinhole": {"fov_deg": 1, "f_number": 0.886226925}, "from": [0, 0, 0], "to": [0, 0, 2], "up": [0, 1, 0])"),
      200 / kPi * 4.09 / 0.09, 3);
}

// --- Filters that shift with the angle ---

constexpr double kIndex = 2;
constexpr double kCenter = 650;
// A filter of 10 nm alone and behind a wedge, 0 at 500 nm and 1 at 700 nm: the ratio of both tells the mean
// wavelength.
constexpr const char* kCentroid =
    R"("channels": {"all": {"filters": [{"transmittance": {"band": [645, 655]}, "effective_index": 2}]},
       "wedge": {"filters": [{"transmittance": {"band": [645, 655]}, "effective_index": 2},
         {"table": {"wavelength_nm": [500, 700], "values": [0, 1], "outside": "clamp"}}]}})";

double centroid_nm(const Film& film, int x0, int y0, int x1, int y1) {
  return 500 + 200 * test::region(film, 1, x0, y0, x1, y1).mean / test::region(film, 0, x0, y0, x1, y1).mean;
}

double shift(double sine2) {
  return std::sqrt(1 - sine2 / (kIndex * kIndex));
}

// The light of a band that is stretched by s is s times as much, its centre at s times the centre.
struct Centroid {
  double sum = 0;
  double moment = 0;
  void add(double weight, double s) {
    sum += weight * s;
    moment += weight * s * s * kCenter;
  }
  [[nodiscard]] double nm() const { return moment / sum; }
};

// A white card before an f/2 lens, evenly lit; its corners are seen under 35 degrees.
Scene card(const char* integrator, int samples) {
  return test::load_text(fmt::format(
      R"({{"abbe": 1,
           "camera": {{"thin_lens": {{"focal_length": 0.02, "f_number": 2}}, "from": [0, 0, 0], "to": [0, 0, 1], "up": [0, 1, 0]}},
           "sensor": {{"resolution": [24, 24], "pixel_pitch_um": 900, {}}},
           "materials": {{"white": {{"diffuse": {{"reflectance": 0.8}}}}}},
           "shapes": [{{"quad": {{"corner": [-2, -2, 1], "edge_u": [0, 4, 0], "edge_v": [4, 0, 0]}}, "material": "white"}}],
           "lights": [{{"spot": {{"at": [0, 0, -9], "direction": [0, 0, 1], "half_angle_deg": 5}}, "emission": {{"spectrum": 1}}}}],
           "render": {{"integrator": "{}", "samples": {}}}}})",
      kCentroid, integrator, samples));
}

// Mean wavelength in the pixel: over its area and the opening.
Centroid of_pixel(const Scene& scene, int x, int y) {
  const auto& lens = std::get<ThinLens>(scene.camera.kind);
  constexpr int kSteps = 6;
  constexpr int kRings = 8;
  Centroid mean;
  for (int i = 0; i < kSteps * kSteps; ++i)
    for (int j = 0; j < kRings * kRings; ++j) {
      const double pitch = scene.camera.pixel_pitch;
      const double fx = (x + (i % kSteps + 0.5) / kSteps - 12) * pitch;
      const double fy = (y + (i / kSteps + 0.5) / kSteps - 12) * pitch;
      const double r = lens.aperture_radius * std::sqrt((j % kRings + 0.5) / kRings);
      const double a = 2 * kPi * (j / kRings + 0.5) / kRings;
      const double lx = r * std::cos(a);
      const double ly = r * std::sin(a);
      // The direction cosines at the film are p0 + (p0 - p)/m: p of the ray from the opening to the point in
      // focus, p0 of the ray through the centre of the lens, m = v/s the magnification [Born1999, sec. 4.5].
      const double cx = fx / lens.image_distance;
      const double cy = fy / lens.image_distance;
      const double ox = cx - lx / lens.focus_distance;
      const double oy = cy - ly / lens.focus_distance;
      const double c0 = 1 / std::sqrt(1 + cx * cx + cy * cy);
      const double c = 1 / std::sqrt(1 + ox * ox + oy * oy);
      const double m = lens.image_distance / lens.focus_distance;
      const double px = cx * c0 + (cx * c0 - ox * c) / m;
      const double py = cy * c0 + (cy * c0 - oy * c) / m;
      mean.add(std::pow(c, 4), shift(px * px + py * py));
    }
  return mean;
}

class TiltedFilter : public testing::TestWithParam<const char*> {};

TEST_P(TiltedFilter, TheCentreOfItsBandMovesByTheFormula) {
  if (!test::nightly() && GetParam() != std::string("path")) GTEST_SKIP() << "takes long";
  const Scene scene = card(GetParam(), GetParam() == std::string("path") ? 512 : 16384);
  const RenderResult result = render(scene, {});
  EXPECT_EQ(result.stats.nonfinite_samples, 0U);
  const Film& film = result.film;
  double least = kCenter;
  for (int block = 0; block < 16; ++block) {
    const int x0 = block % 4 * 6;
    const int y0 = block / 4 * 6;
    double sum = 0;
    double moment = 0;
    for (int y = y0; y < y0 + 6; ++y)
      for (int x = x0; x < x0 + 6; ++x) {
        const double light = film.mean(static_cast<std::size_t>(y * 24 + x), 0);
        sum += light;
        moment += light * of_pixel(scene, x, y).nm();
      }
    EXPECT_NEAR(centroid_nm(film, x0, y0, x0 + 6, y0 + 6), moment / sum, 0.05) << x0 << ' ' << y0;
    least = std::min(least, moment / sum);
  }
  EXPECT_LT(least, 640) << "the corners are far off the axis";
}

INSTANTIATE_TEST_SUITE_P(Both, TiltedFilter, testing::Values("path", "light"),
                         [](const auto& info) { return std::string(info.param); });

TEST(TiltedFilterBeforeAMeter, TurnsWithWhereTheLightComesFrom) {
  const auto meter = [](const char* light) {
    return test::load_text(fmt::format(
        R"({{"abbe": 1, "camera": {{"irradiance_probe": {{"at": [0, 0, 0], "normal": [0, 0, 1]}}}},
             "sensor": {{"resolution": [8, 8], {}}}, "lights": [{{{}, "emission": {{"spectrum": 1}}}}],
             "render": {{"samples": 1024}}}})",
        kCentroid, light));
  };
  const auto measured = [&](const char* light) {
    return centroid_nm(render(meter(light), {}).film, 0, 0, 8, 8);
  };
  EXPECT_NEAR(measured(R"("point": {"at": [3, 0, 4]})"), kCenter * shift(0.36), 0.01);
  EXPECT_NEAR(measured(R"("point": {"at": [0, 0, 4]})"), kCenter, 0.01);
  Centroid dome;
  for (double sine2 = 0.0005; sine2 < 1; sine2 += 0.001) dome.add(1, shift(sine2));
  EXPECT_NEAR(measured(R"("environment": {})"), dome.nm(), 0.05);
  Centroid lamp;  // a disc of radius 1 m, 1 m away
  for (double sine2 = 0.0005; sine2 < 0.5; sine2 += 0.001) lamp.add(1, shift(sine2));
  EXPECT_NEAR(measured(R"("disc": {"center": [0, 0, 1], "normal": [0, 0, -1], "radius": 1})"), lamp.nm(),
              0.05);
}

// --- Mosaics ---

constexpr const char* kNarrow =
    R"("channels": {"R": {"band": [620, 630]}, "G": {"band": [530, 540]}, "B": {"band": [450, 460]}})";
constexpr const char* kBayer = R"(, "mosaic": [["R", "G"], ["G", "B"]])";

Scene narrow(const char* name, const char* pattern, int samples, std::vector<Override> settings = {}) {
  settings.push_back({"/sensor", fmt::format(R"({{"resolution": [48, 48], "pixel_pitch_um": 520, {}{}}})",
                                             kNarrow, pattern)});
  settings.push_back({"/render/samples", std::to_string(samples)});
  return test::load(name, settings);
}

// Of all pixels of a channel in blocks of a film with mosaic and one without: the largest difference in
// standard errors, the ratio of the sums and that of the variances.
struct MosaicComparison {
  double largest_z = 0;
  double ratio = 0;
  double variance_ratio = 0;
};
MosaicComparison compare(const Scene& scene, const Film& raw, const Film& all, int grid) {
  MosaicComparison found;
  test::Region total_raw;
  test::Region total_all;
  for (int block = 0; block < grid * grid; ++block)
    for (int channel = 0; channel < 3; ++channel) {
      test::Region a;
      test::Region b;
      const int side = raw.width() / grid;
      for (int i = 0; i < side * side; ++i) {
        const int x = block % grid * side + i % side;
        const int y = block / grid * side + i / side;
        if (scene.mosaic->at(x, y) != channel) continue;
        const auto pixel = static_cast<std::size_t>(y * raw.width() + x);
        a.mean += raw.mean(pixel, 0);
        a.variance += raw.variance(pixel, 0);
        b.mean += all.mean(pixel, channel);
        b.variance += all.variance(pixel, channel);
      }
      found.largest_z =
          std::max(found.largest_z, std::abs(a.mean - b.mean) / std::sqrt(a.variance + b.variance));
      total_raw = {total_raw.mean + a.mean, total_raw.variance + a.variance};
      total_all = {total_all.mean + b.mean, total_all.variance + b.variance};
    }
  found.ratio = total_raw.mean / total_all.mean;
  found.variance_ratio = total_raw.variance / total_all.variance;
  return found;
}

TEST(MosaicFilm, ExpectsWhatAFilmOfAllChannelsDoesWithLessNoise) {
  const Scene scene = narrow("cornell.json", kBayer, 128);
  const RenderResult raw = render(scene, {});
  EXPECT_EQ(raw.film.channels(), 1);
  const RenderResult all = render(narrow("cornell.json", "", 128), {});
  EXPECT_EQ(raw.stats.paths, all.stats.paths);
  const MosaicComparison found = compare(scene, raw.film, all.film, 4);
  EXPECT_LT(found.largest_z, test::kLargestZ);
  EXPECT_NEAR(found.ratio, 1, 0.005);
  std::printf("variance of a pixel with a mosaic over that without, at as many paths: %.3f\n",
              found.variance_ratio);
  EXPECT_LT(found.variance_ratio, 0.9);
}

TEST(NightlyMosaicFilm, PhotonsMeetThePixelsFilter) {
  const Scene scene = narrow("glass_sphere.json", kBayer, 256);
  const RenderResult raw = render(scene, {});
  ASSERT_GT(raw.stats.paths, 256U * 48 * 48) << "no photon was traced";
  const RenderResult all = render(narrow("glass_sphere.json", "", 256), {});
  const MosaicComparison found = compare(scene, raw.film, all.film, 4);
  EXPECT_LT(found.largest_z, test::kLargestZ);
  EXPECT_NEAR(found.ratio, 1, 0.01);
  const Scene photons = narrow("cornell.json", kBayer, 256, {{"/render/integrator", "light"}});
  const RenderResult paths = render(narrow("cornell.json", "", 64), {});
  const Film light = render(photons, {}).film;
  double ratio_raw = 0;
  double ratio_all = 0;
  for (int y = 24; y < 48; ++y)  // no lamp in sight
    for (int x = 0; x < 48; ++x) {
      const auto pixel = static_cast<std::size_t>(y * 48 + x);
      ratio_raw += light.mean(pixel, 0);
      ratio_all += paths.film.mean(pixel, photons.mosaic->at(x, y));
    }
  EXPECT_NEAR(ratio_raw / ratio_all, 1, 0.02);
}

TEST(MosaicFilm, AnUnlitFilterIsExactlyBlack) {
  const Scene scene = flat_field(
      R"("channels": {"lit": {"band": [400, 500]}, "dark": {"band": [600, 700]}}, "mosaic": [["lit", "dark"]])",
      R"({"spectrum": {"band": [420, 430]}})", 64);
  const RenderResult result = render(scene, {});
  EXPECT_EQ(result.stats.nonfinite_samples, 0U);
  for (std::size_t pixel = 0; pixel < 16; ++pixel) {
    if (pixel % 2 == 1)
      EXPECT_EQ(result.film.mean(pixel, 0), 0);
    else
      EXPECT_NEAR(result.film.mean(pixel, 0), 10 * kFlatField_sr, 0.01);
  }
}

}  // namespace
}  // namespace abbe
