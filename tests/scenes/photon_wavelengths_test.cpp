// Where photons draw their wavelengths from, once pilots have shown what leaves noise.
#include <fmt/format.h>

#include "report/image_difference.h"
#include "tests/scenes/film_of_plan.h"
#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/trained_plan.h"
#include "validation/bench/run.h"

namespace abbe {
namespace {

// By day of a quarter of the pixels.
const char* resolution() {
  return test::nightly() ? "[320, 200]" : "[160, 100]";
}

Scene prism(const std::vector<Override>& more = {}, const char* name = "prism_spot.json") {
  std::vector<Override> settings{{"/sensor/resolution", resolution()}};
  settings.insert(settings.end(), more.begin(), more.end());
  return test::load(name, settings);
}

// The same, but that photons draw wavelengths as camera paths do.
Plan unlearnt(Plan plan) {
  plan.guides.photon_wavelengths = plan.wavelengths;
  return plan;
}

// By how much the mean squared error is less, relative to a reference that both share.
template <typename PictureOf>
double gain(const Scene& scene, const Plan& plan, const PictureOf& picture_of) {
  const int samples = 48;
  const Image reference = picture_of(test::film_of(scene, plan, 256));
  const double before = rel_mse(picture_of(test::film_of(scene, unlearnt(plan), samples, 1)), reference);
  const double after = rel_mse(picture_of(test::film_of(scene, plan, samples, 2)), reference);
  std::printf("error %.3f times less\n", before / after);
  return before / after;
}

TEST(NightlyPhotonWavelengths, LeaveLessNoiseInTheColoursOfASpectrum) {
  const Scene scene = prism({}, "prism_area.json");
  const auto srgb = [&scene](const Film& film) { return linear_srgb(film.image(scene.film_planes())); };
  EXPECT_GT(gain(scene, make_trained_plan(scene, 2), srgb), 1.18);
}

TEST(NightlyPhotonWavelengths, LeaveLessNoiseBehindTheFiltersOfAMosaic) {
  const Scene scene = prism(
      {{"/sensor",
        fmt::format(R"({{"resolution": {}, "camera": "Nikon_D5100", "mosaic": [["R", "G"], ["G", "B"]]}})",
                    resolution())}});
  const Plan plan = make_trained_plan(scene, 2);
  const auto raw = [&scene](const Film& film) { return film.image(scene.film_planes()); };
  EXPECT_GT(gain(scene, plan, raw), 1.3);
}

TEST(PhotonWavelengths, ChangeNoiseOnly) {
  const Scene scene = prism();
  const Plan plan = make_trained_plan(scene, 2);
  const Film as_camera_paths = test::film_of(scene, unlearnt(plan), 32);
  const Film learnt = test::film_of(scene, plan, test::nightly() ? 24 : 16);
  const test::Comparison c = test::compare_regions(as_camera_paths, learnt, 8);
  std::printf("largest z %.2f, ratio of the means %.5f\n", c.largest_z, c.ratio);
  EXPECT_LT(c.largest_z, test::kLargestZ);
  EXPECT_NEAR(c.ratio, 1, test::ratio_margin(as_camera_paths, learnt, 0.003, 0.03));
}

TEST(PhotonWavelengths, AreTheSameOnAnyNumberOfThreads) {
  const Scene scene = prism();
  const Plan one = make_trained_plan(scene, 1);
  const Plan four = make_trained_plan(scene, 4);
  int learnt = 0;
  for (int nm = 380; nm < 780; ++nm) {
    ASSERT_EQ(one.guides.photon_wavelengths.pdf(nm), four.guides.photon_wavelengths.pdf(nm)) << nm;
    learnt += one.guides.photon_wavelengths.pdf(nm) != one.wavelengths.pdf(nm) ? 1 : 0;
  }
  EXPECT_GT(learnt, 390);
}

// Where all lanes go one way, each pixel sees all wavelengths.
TEST(PhotonWavelengths, AreThoseOfCameraPathsWhereNothingDisperses) {
  const Scene scene = prism({{"/materials/glass/dielectric/ior", "1.7"}});
  const Plan plan = make_trained_plan(scene, 2);
  ASSERT_FALSE(plan.traced_lights.empty());
  for (int nm = 380; nm < 780; ++nm)
    ASSERT_EQ(plan.guides.photon_wavelengths.pdf(nm), plan.wavelengths.pdf(nm)) << nm;
}

}  // namespace
}  // namespace abbe
