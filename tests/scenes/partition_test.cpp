#include <algorithm>
#include <atomic>
#include <cstring>
#include <random>

#include <fmt/format.h>

#include "io/exr.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/part.h"

// A render may be cut into ranges of samples, interrupted and put together again in any order: every bit of
// its film stays as it was.

namespace abbe {
namespace {

constexpr int kSamples = 24;

Scene small_scene(const char* name, std::vector<Override> settings = {}) {
  settings.push_back({"/sensor/resolution", "[40, 24]"});
  settings.push_back({"/render/samples", std::to_string(kSamples)});
  return test::load(name, settings);
}

/// A scene, perhaps before another sensor.
struct Seen {
  const char* scene;
  const char* sensor = nullptr;
  const char* integrator = "auto";

  [[nodiscard]] Scene load() const {
    std::vector<Override> settings;
    if (std::strcmp(integrator, "auto") != 0) settings.push_back({"/render/integrator", integrator});
    if (sensor != nullptr) settings.push_back({"/sensor", sensor});
    return small_scene(scene, settings);
  }
};
// Everything a sensor may do to photons and camera paths: a mosaic, one of its filters tilting.
constexpr Seen kMosaic{"glass_sphere.json", R"({"mosaic": [["R", "G", "B"], ["G", "B", "R"]],
  "channels": {"R": {"band": [600, 700]}, "B": {"band": [400, 500]},
    "G": {"filters": [{"transmittance": {"band": [500, 600]}, "effective_index": 1.8}], "exposure_s": 2}}})"};

/// Cuts [0, kSamples) at random places.
SampleRanges cut(int pieces, std::mt19937& random) {
  std::vector<std::uint64_t> edges(kSamples - 1);
  for (std::size_t i = 0; i < edges.size(); ++i) edges[i] = i + 1;
  std::shuffle(edges.begin(), edges.end(), random);
  edges.resize(static_cast<std::size_t>(pieces) - 1);
  edges.insert(edges.end(), {0, kSamples});
  std::sort(edges.begin(), edges.end());
  SampleRanges ranges;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) ranges.push_back({edges[i], edges[i + 1]});
  std::shuffle(ranges.begin(), ranges.end(), random);
  return ranges;
}

// From so far that rays come in along the film's normal as floats tell, where the light of paths from lamps
// is told from that of others by where it falls alone.
TEST(Crop, HasWhatPathsFromLightsBringWhoseOwnPixelsItLeavesOut) {
  for (const char* integrator : {"bdpt", "vcm", "light"}) {
    const Scene scene = test::load_text(fmt::format(R"({{"abbe": 1,
      "camera": {{"pinhole": {{"fov_deg": 0.01}}, "from": [0, 0, 200], "to": [0, 0, 0], "up": [0, 1, 0]}},
      "sensor": {{"resolution": [4, 4], "observer": "1931"}},
      "materials": {{"grey": {{"diffuse": {{"reflectance": 0.5}}}}}},
      "lights": [{{"spot": {{"at": [0, 0, 0.3], "direction": [0, 0, -1], "half_angle_deg": 5}},
                   "emission": {{"spectrum": 1, "intensity": 10}}}}],
      "shapes": [{{"quad": {{"corner": [-0.2, -0.2, 0], "edge_u": [0.4, 0, 0], "edge_v": [0, 0.4, 0]}},
                   "material": "grey"}}],
      "render": {{"integrator": "{}", "samples": 64}}}})",
                                                    integrator));
    const Film whole = render(scene, {}).film;
    EXPECT_GT(whole.mean(0, 1), 0) << integrator;
    EXPECT_EQ(render(scene, {.crop = Crop{0, 0, 1, 1}}).film.mean(0, 1), whole.mean(0, 1)) << integrator;
  }
}

class Partition : public testing::TestWithParam<Seen> {
 protected:
  const Scene scene_ = GetParam().load();
  const FilmIdentity identity_{{"sensor_channels", fmt::format("{}", fmt::join(scene_.film_planes(), ","))}};

  // Through a file, as parts travel.
  RenderPart rendered(const SampleRange& range) const {
    const auto path = std::filesystem::path(testing::TempDir()) /
                      ("abbe_partition_" + std::to_string(::getpid()) + ".abbepart");
    RenderOptions options;
    options.samples = range;
    write_part(path, identity_, render(scene_, options));
    RenderPart part = read_part(path);
    std::filesystem::remove(path);
    return part;
  }

  static void expect_same(const RenderPart& sum, const RenderPart& whole) {
    EXPECT_EQ(sum.result.film.bytes(), whole.result.film.bytes());
    EXPECT_EQ(sum.result.samples, whole.result.samples);
    EXPECT_EQ(sum.result.stats.paths, whole.result.stats.paths);
    EXPECT_EQ(sum.result.stats.rays, whole.result.stats.rays);
    const Image a = image_of(sum);
    const Image b = image_of(whole);
    EXPECT_EQ(a.metadata, b.metadata);
    ASSERT_EQ(a.channels.size(), b.channels.size());
    for (std::size_t i = 0; i < a.channels.size(); ++i)
      EXPECT_EQ(a.channels[i].values, b.channels[i].values) << a.channels[i].name;
  }
};

TEST_P(Partition, AnyPartsInAnyOrderAndGroupingAreTheWhole) {
  const RenderPart whole{identity_, render(scene_, {})};
  std::mt19937 random(7);
  for (const int pieces : test::nightly() ? std::vector{2, 3, 4, 5, 6, 7, 8} : std::vector{3}) {
    std::vector<RenderPart> parts;
    for (const SampleRange& range : cut(pieces, random)) parts.push_back(rendered(range));
    while (parts.size() > 1) {  // any two become one
      std::shuffle(parts.begin(), parts.end(), random);
      merge(parts[parts.size() - 2], parts.back(), "part");
      parts.pop_back();
    }
    expect_same(parts.front(), whole);
  }
}

TEST_P(Partition, AnInterruptedRenderGoesOnAsItWouldHave) {
  const RenderPart whole{identity_, render(scene_, {})};
  RenderPart part = rendered({3, 9});
  RenderOptions options;
  options.samples = SampleRange{0, 17};
  part.result = render(scene_, options, std::move(part.result));
  EXPECT_EQ(to_text(part.result.samples), "0:17");
  part.result = render(scene_, {}, std::move(part.result));
  expect_same(part, whole);
}

std::string name_of_seen(const testing::TestParamInfo<Seen>& info) {
  const char* name = info.param.scene;
  return std::string(name, std::strchr(name, '.')) + "_" + info.param.integrator +
         (info.param.sensor == nullptr ? "" : "_mosaic");
}
INSTANTIATE_TEST_SUITE_P(Scenes, Partition,
                         testing::Values(Seen{"prism.json"}, Seen{"cornell.json"}, kMosaic,
                                         Seen{"glass_sphere.json", nullptr, "sppm"},
                                         Seen{"cornell.json", nullptr, "vcm"}, Seen{"rolling_fan.json"},
                                         Seen{"rolling_fan.json", nullptr, "bdpt"}),
                         name_of_seen);
INSTANTIATE_TEST_SUITE_P(Nightly, Partition, testing::Values(Seen{"glass_sphere.json"}), name_of_seen);

RenderResult copy(const RenderResult& result) {
  RenderResult same{*Film::from_bytes(result.film.shape(), result.film.bytes()), result.samples, result.stats,
                    result.unfinished, result.before_pass};
  same.film.set_samples(count_per_replicate(same.samples, same.film.replicates()));
  return same;
}

TEST(Resume, AStopByErrorFallsOnTheSameSample) {
  const Scene scene = small_scene("cornell.json");
  RenderOptions to_error;
  to_error.target_error = test::nightly() ? 0.03 : 0.06;
  const RenderResult whole = render(scene, to_error);
  const auto goes_on_to_the_same = [&](RenderResult start) {
    const std::string from = to_text(start.samples);
    const RenderResult end = render(scene, to_error, std::move(start));
    EXPECT_EQ(end.samples, whole.samples) << "from " << from;
    EXPECT_EQ(end.film.bytes(), whole.film.bytes()) << "from " << from;
    EXPECT_EQ(end.stats.rays, whole.stats.rays) << "from " << from;
  };
  int amid = 0;
  RenderOptions saving = to_error;
  saving.checkpoint_interval_s = 0;  // every state a checkpoint could hold
  saving.threads = 3;
  saving.checkpoint = [&](const RenderResult& result) {
    amid += result.unfinished ? 1 : 0;
    goes_on_to_the_same(copy(result));
  };
  goes_on_to_the_same(render(scene, saving));
  EXPECT_GT(amid, 0);
  RenderOptions odd = to_error;  // no end of a pass
  odd.samples = SampleRange{0, 100};
  odd.target_error = {};
  odd.time_limit_s = 1e9;
  goes_on_to_the_same(render(scene, odd));
}

// What a path costs is not known before, so the first passes are short.
TEST(Time, EndsASmallFilmAfterASampleThatTakesLonger) {
  RenderOptions soon;
  soon.time_limit_s = 1e-9;
  EXPECT_EQ(render(small_scene("cornell.json"), soon).stats.samples_per_pixel, 1U);
  soon.target_error = 1e-9;
  EXPECT_EQ(render(small_scene("cornell.json"), soon).stats.samples_per_pixel, 1U);
}

// What the first says bounds the passes of all: as many samples as have been traced, and ever fewer when the
// time that is left does not allow them.
TEST(Time, EndsTheLongPassesOfACrewToo) {
  std::vector<std::uint64_t> told;
  RenderOptions timed;
  timed.time_limit_s = 0.5;
  timed.mpi_group = {.rank = 0,
                     .size = 2,
                     .reduce = [](std::span<Int128>) {},
                     .broadcast =
                         [&told](std::uint64_t said) {
                           if (said > 1) told.push_back(said);
                           return said;
                         }};
  EXPECT_GT(render(small_scene("cornell.json"), timed).stats.samples_per_pixel, 8U);
  ASSERT_FALSE(told.empty());
  EXPECT_LT(told.back(), *std::max_element(told.begin(), told.end()) / 2);
}

// Amid a sample, the photons of which are traced again and not counted twice.
TEST(Resume, WhatGathersPhotonsGoesOnAsItWouldHave) {
  for (const char* integrator : {"sppm", "vcm"}) {
    SCOPED_TRACE(integrator);
    const Scene scene = small_scene(
        "cornell.json", {{"/render/integrator", integrator}, {"/render/photons", R"({"per_sample": 500})"}});
    RenderOptions few;
    few.samples = SampleRange{0, 3};
    const RenderResult whole = render(scene, few);
    int amid = 0;
    RenderOptions saving = few;
    saving.checkpoint_interval_s = 0;
    saving.checkpoint = [&](const RenderResult& result) {
      amid += result.unfinished ? 1 : 0;
      const RenderResult end = render(scene, few, copy(result));
      EXPECT_EQ(end.film.bytes(), whole.film.bytes());
      EXPECT_EQ(end.stats.rays, whole.stats.rays);
      EXPECT_EQ(end.stats.paths, whole.stats.paths);
    };
    const RenderResult saved = render(scene, saving);
    EXPECT_EQ(saved.film.bytes(), whole.film.bytes());
    EXPECT_EQ(saved.stats.rays, whole.stats.rays);
    EXPECT_GT(amid, 0);
  }
}

// However long the pass, what is done can be saved as soon as a stop is asked for; the pass then ends, so
// that the film is a mean of whole samples.
TEST(Resume, AStopIsSavedAtOnceAndEndsThePass) {
  const Scene scene = small_scene("glass_sphere.json");
  RenderOptions options;
  options.threads = 1;
  // By day from shortly before the end of a pass, which is at a multiple of its samples.
  const std::uint64_t first = test::nightly() ? 0 : 250;
  options.samples = SampleRange{first, 500};
  const std::atomic<bool> stop{true};
  std::vector<RenderResult> saved;
  options.stop = &stop;
  options.checkpoint_interval_s = 1e9;
  options.checkpoint = [&](const RenderResult& result) { saved.push_back(copy(result)); };
  const RenderResult stopped = render(scene, options);
  EXPECT_TRUE(stopped.stats.interrupted);
  EXPECT_FALSE(stopped.unfinished);
  const RenderResult whole = render(scene, {.samples = stopped.samples.front()});
  EXPECT_EQ(stopped.film.bytes(), whole.film.bytes());
  ASSERT_EQ(saved.size(), 1U);
  ASSERT_TRUE(saved.front().unfinished);
  EXPECT_EQ(saved.front().unfinished->items, 1U);  // a tile of a thread
  EXPECT_TRUE(saved.front().samples.empty());

  // Through a file, which is a checkpoint but no part, as a tile has none of the photons yet.
  const auto path = std::filesystem::path(testing::TempDir()) /
                    ("abbe_unfinished_" + std::to_string(::getpid()) + ".abbepart");
  write_part(path, {{"sensor_channels", "R,G,B"}}, saved.front());
  EXPECT_THROW((void)read_part(path), Error);
  RenderOptions rest;
  rest.samples = SampleRange{first, first + 2};  // what was begun is ended whatever is wanted
  const RenderResult end = render(scene, rest, read_checkpoint(path).result);
  std::filesystem::remove(path);
  EXPECT_EQ(end.samples, stopped.samples);
  EXPECT_EQ(end.film.bytes(), whole.film.bytes());
  EXPECT_EQ(end.stats.paths, whole.stats.paths);
}

// A render that saves itself amid passes, until one of its savings is as wanted, which ends it.
template <typename Wanted>
RenderResult saved_amid_a_pass(const Scene& scene, Wanted wanted) {
  struct Saved {};
  std::optional<RenderResult> saved;
  RenderOptions options;
  options.threads = 1;
  options.checkpoint_interval_s = 0;
  options.checkpoint = [&](const RenderResult& result) {
    if (!result.unfinished || !wanted(result)) return;
    saved = copy(result);
    throw Saved{};
  };
  EXPECT_THROW((void)render(scene, options), Saved);
  if (!saved) throw Error(ErrorCode::internal, "test", "no saving was as wanted");
  return *std::move(saved);
}

class SavedAmidAPass : public testing::Test {
 protected:
  RenderPart through_file(const RenderResult& saved) const {
    const auto path =
        std::filesystem::path(testing::TempDir()) / ("abbe_amid_" + std::to_string(::getpid()) + ".abbepart");
    write_part(path, identity_, saved);
    RenderPart part = read_part(path);
    EXPECT_EQ(read_part_header(path).areas, header_of(part).areas);
    EXPECT_EQ(read_part_header(path).shape, header_of(part).shape);
    std::filesystem::remove(path);
    return part;
  }
  // Those samples of those pixels, rendered on their own.
  RenderPart anew(const SampledAreas& areas, const PartHeader& header) const {
    RenderPart sum = empty_part(header);
    for (const SampledArea& area : areas)
      for (const SampleRange& range : area.samples) {
        RenderPart part{identity_, render(scene_, {.crop = area.pixels, .samples = range})};
        part.identity[kCropKey] = to_text(area.pixels);
        merge(sum, part, "anew");
      }
    return sum;
  }

  const std::string samples_ = test::nightly() ? "128" : "48";
  const Scene scene_ =
      test::load("cornell.json", {{"/sensor/resolution", "[100, 70]"}, {"/render/samples", samples_}});
  const FilmIdentity identity_{{"sensor_channels", "X,Y,Z"}, {kStatedSamplesKey, samples_}};
};

TEST_F(SavedAmidAPass, PixelsOfTheTilesDoneHaveItsSamples) {
  const RenderPart part = through_file(saved_amid_a_pass(
      scene_, [](const RenderResult& r) { return !r.samples.empty() && r.unfinished->items > 8; }));
  const PartHeader header = header_of(part);
  EXPECT_EQ(part.result.film.crop(), (Crop{0, 0, 100, 70}));
  ASSERT_GE(header.areas.size(), 2U);
  EXPECT_GT(count(header.areas.front().samples), count(header.areas.back().samples));
  const PartHeader empty{header.identity, header.shape, {}};
  EXPECT_EQ(anew(header.areas, empty).result.film.bytes(), part.result.film.bytes());
  // The rest may be rendered by others.
  RenderPart sum = anew(missing_samples(header), empty);
  merge(sum, part, "saved");
  EXPECT_EQ(sum.result.film.bytes(), render(scene_, {}).film.bytes());
}

TEST_F(SavedAmidAPass, AFilmWithoutAWholePassIsThatOfItsTiles) {
  const RenderPart part = through_file(saved_amid_a_pass(
      scene_, [](const RenderResult& r) { return r.samples.empty() && r.unfinished->items <= 7; }));
  const Crop crop = part.result.film.crop();
  EXPECT_EQ(crop.y1, 16);
  const RenderPart alone = anew(header_of(part).areas, {part.identity, part.result.film.shape(), {}});
  EXPECT_EQ(alone.result.film.bytes(), part.result.film.bytes());
}

TEST(Merge, AHeaderThatIsRefusedLeavesTheSumUnchanged) {
  const FilmShape shape{
      .width = 8, .height = 8, .channels = 3, .replicates = 2, .unit_exponent = 0, .crop = {}};
  const FilmIdentity identity{{"sensor_channels", "X,Y,Z"}};
  PartHeader sum{identity, shape, {{{0, 0, 8, 8}, {{0, 2}}}}};
  const SampledAreas before = sum.areas;
  const PartHeader part{identity, shape, {{{0, 0, 4, 8}, {{2, 4}}}, {{4, 0, 8, 8}, {{1, 3}}}}};
  EXPECT_THROW(merge(sum, part, "b.abbepart"), Error);
  EXPECT_EQ(sum.areas, before);
}

TEST(Merge, RefusesWhatDoesNotBelongTogether) {
  const Scene scene = small_scene("cornell.json");
  RenderOptions options;
  const auto part = [&](const FilmIdentity& identity, const SampleRange& range) {
    options.samples = range;
    return RenderPart{identity, render(scene, options)};
  };
  const auto refusal = [](RenderPart& sum, const RenderPart& more) {
    try {
      merge(sum, more, "b.abbepart");
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::input);
      return std::string(error.what());
    }
    return std::string();
  };
  const FilmIdentity own{{"sensor_channels", "X,Y,Z"}, {"seed", "1"}, {"scene", "a.json"}};
  FilmIdentity other = own;
  other["seed"] = "2";
  FilmIdentity renamed = own;
  renamed["scene"] = "b.json";
  RenderPart sum = part(own, {0, 2});
  EXPECT_EQ(refusal(sum, part(other, {2, 3})),
            "b.abbepart: belongs to another render, with another seed (got 2, allowed 1)");
  options.crop = Crop{0, 0, 4, 4};
  RenderPart corner = part(own, {2, 3});
  options.crop = Crop{4, 0, 5, 4};
  EXPECT_EQ(refusal(corner, part(own, {2, 3})),
            "b.abbepart: has pixels outside the film that it is added to");
  options.crop.reset();
  EXPECT_EQ(refusal(sum, part(own, {1, 3})), "b.abbepart: has samples that are already included (got 1:3)");
  const Scene smaller = test::load("cornell.json", {{"/sensor/resolution", "[8, 8]"}});
  const RenderPart misshapen{own, render(smaller, {.samples = SampleRange{2, 3}})};
  EXPECT_EQ(refusal(sum, misshapen), "b.abbepart: has a film of another shape");
  EXPECT_THROW((void)render(scene, {}, copy(misshapen.result)), Error);
  FilmShape other_shares = sum.result.film.shape();
  other_shares.path_interval = 2;
  const RenderPart another{own, {Film(other_shares), {{2, 3}}, {}}};
  EXPECT_EQ(refusal(sum, another), "b.abbepart: has a film of another shape");
  RenderPart more = part(renamed, {2, 3});
  more.result.stats.nonfinite_samples = 5;
  sum.result.stats.cut = {4, Int128{2} << 40};
  more.result.stats.cut = {3, Int128{3} << 39};
  EXPECT_EQ(refusal(sum, more), "");
  EXPECT_EQ(to_text(sum.result.samples), "0:3");
  EXPECT_EQ(sum.result.stats.nonfinite_samples, 5U);
  EXPECT_EQ(sum.result.stats.cut.paths, 7U);
  EXPECT_EQ(sum.result.stats.cut.throughput(), 3.5);
}

}  // namespace
}  // namespace abbe
