#include "transport/render/part_films.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "sensor/film/recorded_attributes.h"

namespace abbe {
namespace {

// Two pixels and two replicates, of which the left has values in the first, and the right in both.
RenderPart left_and_right(const SampleRanges& left, const SampleRanges& right) {
  Film film(2, 1, 1, 2, 1.0);
  const auto add = [&film](std::size_t pixel, int replicate, double value) {
    film.add(pixel, replicate, {&value, 1});
  };
  add(0, 0, 3);
  add(1, 0, 1);
  add(1, 1, 3);
  film.set_samples({0, 0});
  return {
      {{"sensor_channels", "V"}}, {std::move(film), {}, {}}, {{{0, 0, 1, 1}, left}, {{1, 0, 2, 1}, right}}};
}

TEST(PartFilms, PixelsOfOneReplicateLeaveTheErrorUnknown) {
  const Image image = image_of(left_and_right({{0, 1}}, {{0, 2}}));
  EXPECT_EQ(image.find("V")->values, (std::vector<float>{3, 2}));
  EXPECT_EQ(image.find("Variance.V")->values, (std::vector<float>{0, 1}));
  ASSERT_EQ(image.metadata.count(kFrameMeanErrorKey), 1U);
  EXPECT_TRUE(has_unknown_error(image.metadata));
  EXPECT_FALSE(image.metadata.contains("samples_per_pixel"));
  const Image one_replicate = image_of(left_and_right({{0, 1}, {2, 3}}, {{0, 2}}));
  EXPECT_TRUE(has_unknown_error(one_replicate.metadata)) << "as samples 0 and 2 are";
}

TEST(PartFilms, UnevenPixelsOfTwoReplicatesTellTheirVariances) {
  const Image image = image_of(left_and_right({{0, 2}}, {{0, 4}}));
  // Replicates of 3 and 0 in the left pixel, and of 1/2 and 3/2, two samples each, in the right.
  EXPECT_EQ(image.find("Variance.V")->values, (std::vector<float>{2.25F, 0.25F}));
  EXPECT_FALSE(image.metadata.contains(kFrameMeanErrorKey));
}

// Of the planes of a Stokes vector those beside the intensity have a sign.
TEST(PartFilms, TheErrorIsThatOfIntensities) {
  Film film(1, 1, 4, 2, 1.0);
  film.add(0, 0, std::vector<double>{2, -1, 3, 0.5});
  film.add(0, 1, std::vector<double>{4, 2, -3, 0});
  film.set_samples({1, 1});
  const RenderPart part{{{"sensor_channels", "V,S1.V,S2.V,S3.V"}}, {std::move(film), {{0, 2}}, {}}};
  const Image image = image_of(part);
  EXPECT_NEAR(std::stod(image.metadata.at(kFrameMeanErrorKey)), 1.0 / 3, 1e-12);
}

// Two pixels of 65, each with all of its light in one replicate.
TEST(PartFilms, FewSamplesThatCarryTheNoiseAreAnAttribute) {
  Film film(65, 1, 1, 2, 1.0);
  for (const std::size_t pixel : {3, 9}) film.add(pixel, 0, std::vector<double>{5});
  film.set_samples({1, 1});
  const RenderPart part{{{"sensor_channels", "V"}}, {std::move(film), {{0, 2}}, {}}};
  EXPECT_EQ(image_of(part).metadata.at(kHalfNoiseSamplesKey), "1");
  EXPECT_EQ(few_samples(left_and_right({{0, 2}}, {{0, 4}})), std::nullopt) << "pixels with different samples";
}

}  // namespace
}  // namespace abbe
