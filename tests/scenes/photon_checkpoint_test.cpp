#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <unistd.h>

#include <gtest/gtest.h>

#include "sensor/film/feature_film.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/part.h"
#include "transport/render/render.h"

namespace abbe {
namespace {

// Photons fall on all pixels, so what is begun counts for none of them until it is whole.
class SavedAmidPhotons : public testing::TestWithParam<const char*> {
 protected:
  const Scene scene_ = test::load("cornell.json", {{"/sensor/resolution", "[256, 128]"},
                                                   {"/render/samples", "12"},
                                                   {"/render/max_depth", "1"},
                                                   {"/render/integrator", GetParam()}});
  const FilmIdentity identity_{{"sensor_channels", "X,Y,Z"}, {kFeaturesKey, "depth"}};
  const std::filesystem::path path_ = std::filesystem::path(testing::TempDir()) /
                                      ("abbe_photons_" + std::to_string(::getpid()) + ".abbepart");
  // Of two passes, which end at multiples of eight samples; by day of two samples each.
  const SampleRange wanted_ = test::nightly() ? SampleRange{0, 12} : SampleRange{6, 10};
  RenderOptions options_{.threads = 1, .samples = wanted_, .features = {Feature::depth}};

  struct Saved {};
  // Written as soon as a saving is as wanted, which ends the render.
  template <typename Wanted>
  void save(Wanted wanted, std::optional<RenderResult> start = {}) {
    RenderOptions options = options_;
    options.checkpoint_interval_s = 0;
    options.checkpoint = [&](const RenderResult& result) {
      if (!result.unfinished || !wanted(result)) return;
      write_part(path_, identity_, result);
      throw Saved{};
    };
    EXPECT_THROW((void)render(scene_, options, std::move(start)), Saved);
  }
  void expect_same(const RenderResult& a, const RenderResult& b) const {
    EXPECT_EQ(a.samples, b.samples);
    EXPECT_EQ(a.film.bytes(), b.film.bytes());
    EXPECT_EQ(a.features->sums().bytes(), b.features->sums().bytes());
  }
  void TearDown() override { std::filesystem::remove(path_); }
};

TEST_P(SavedAmidPhotons, TheFilmIsThatOfWholePassesAndGoesOnAsItWas) {
  if (!test::nightly() && GetParam() == std::string("vcm")) GTEST_SKIP() << "takes long";
  const auto amid_the_second = [](const RenderResult& r) {
    return !r.samples.empty() && r.unfinished->items > 3;
  };
  save(amid_the_second);
  const RenderPart part = read_part(path_);
  EXPECT_EQ(read_part_header(path_).areas, header_of(part).areas);
  const SampleRange first_pass{wanted_.first, 8};
  EXPECT_EQ(part.result.samples, SampleRanges{first_pass});
  RenderOptions first = options_;
  first.samples = first_pass;
  expect_same(part.result, render(scene_, first));
  const RenderResult whole = render(scene_, options_);
  expect_same(render(scene_, options_, read_checkpoint(path_).result), whole);
  // Gone on with, and saved amid the same pass again.
  const std::uint32_t done = read_checkpoint(path_).result.unfinished->items;
  save([&](const RenderResult& r) { return amid_the_second(r) && r.unfinished->items > done; },
       read_checkpoint(path_).result);
  expect_same(read_part(path_).result, part.result);
  expect_same(render(scene_, options_, read_checkpoint(path_).result), whole);
}

TEST_P(SavedAmidPhotons, NoPixelHasASampleBeforeTheFirstPassIsWhole) {
  save([](const RenderResult& r) { return r.samples.empty() && r.unfinished->items > 3; });
  EXPECT_THROW((void)read_part(path_), Error);
  EXPECT_THROW((void)read_part_header(path_), Error);
}

INSTANTIATE_TEST_SUITE_P(Techniques, SavedAmidPhotons, testing::Values("\"light\"", "\"vcm\""),
                         [](const auto& info) { return std::string(info.index == 0 ? "light" : "vcm"); });

}  // namespace
}  // namespace abbe
