// Where photons draw their wavelengths from, once pilots have shown what leaves noise.
#include "tests/scenes/film_of_plan.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/learnt_plan.h"
#include "validation/bench/reference.h"
#include "validation/statistics/image_difference.h"

namespace abbe {
namespace {

Scene prism(const std::vector<Override>& more = {}, const char* name = "prism_spot.json") {
  std::vector<Override> settings{{"/sensor/resolution", "[320, 200]"}};
  settings.insert(settings.end(), more.begin(), more.end());
  return test::load(name, settings);
}

// The same, but that photons draw wavelengths as camera paths do.
Plan unlearnt(Plan plan) {
  plan.guides.photon_wavelengths = plan.wavelengths;
  return plan;
}

// By how much the mean squared error is less, relative to a reference that both share. At night of more
// samples.
template <typename PictureOf>
double gain(const Scene& scene, const Plan& plan, const PictureOf& picture_of) {
  const int samples = test::nightly() ? 48 : 16;
  const Image reference = picture_of(test::film_of(scene, plan, test::nightly() ? 256 : 64));
  const double before = rel_mse(picture_of(test::film_of(scene, unlearnt(plan), samples, 1)), reference);
  const double after = rel_mse(picture_of(test::film_of(scene, plan, samples, 2)), reference);
  std::printf("error %.3f times less\n", before / after);
  return before / after;
}

TEST(PhotonWavelengths, LeaveLessNoiseInTheColoursOfASpectrum) {
  const Scene scene = prism({}, "prism_area.json");
  const auto srgb = [&scene](const Film& film) { return linear_srgb(film.image(scene.film_planes())); };
  EXPECT_GT(gain(scene, make_learnt_plan(scene, 2), srgb), 1.18);
}

TEST(PhotonWavelengths, LeaveLessNoiseBehindTheFiltersOfAMosaic) {
  const Scene scene =
      prism({{"/sensor",
              R"({"resolution": [320, 200], "camera": "Nikon_D5100", "mosaic": [["R", "G"], ["G", "B"]]})"}});
  const Plan plan = make_learnt_plan(scene, 2);
  const auto raw = [&scene](const Film& film) { return film.image(scene.film_planes()); };
  EXPECT_GT(gain(scene, plan, raw), 1.3);
}

TEST(PhotonWavelengths, ChangeNoiseOnly) {
  const Scene scene = prism();
  const Plan plan = make_learnt_plan(scene, 2);
  const test::Comparison c =
      test::compare_regions(test::film_of(scene, unlearnt(plan), 32), test::film_of(scene, plan, 24), 8);
  std::printf("largest z %.2f, ratio of the means %.5f\n", c.largest_z, c.ratio);
  EXPECT_LT(c.largest_z, test::kLargestZ);
  EXPECT_NEAR(c.ratio, 1, 0.003);
}

TEST(PhotonWavelengths, AreTheSameOnAnyNumberOfThreads) {
  const Scene scene = prism();
  const Plan one = make_learnt_plan(scene, 1);
  const Plan four = make_learnt_plan(scene, 4);
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
  const Plan plan = make_learnt_plan(scene, 2);
  ASSERT_FALSE(plan.traced_lights.empty());
  for (int nm = 380; nm < 780; ++nm)
    ASSERT_EQ(plan.guides.photon_wavelengths.pdf(nm), plan.wavelengths.pdf(nm)) << nm;
}

}  // namespace
}  // namespace abbe
