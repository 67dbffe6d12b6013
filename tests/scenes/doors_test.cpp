// Scenes of other renderers, converted, look as the same scenes written for Abbe.
#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>

#include "description/doors/doors.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/source_tree.h"
#include "tests/tier.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

struct Pair {
  const char* theirs;  // beside this file
  const char* ours;    // in the folder of data
};

void PrintTo(const Pair& pair, std::ostream* to) {
  *to << pair.theirs;
}

class Doors : public ::testing::TestWithParam<Pair> {};

Scene converted(const fs::path& file) {
  Diagnostics diagnostics;
  const auto text = convert_scene(file, {file.parent_path(), {}}, diagnostics);
  if (!text) throw Error(ErrorCode::internal, file.string(), diagnostics.text());
  const auto source = std::make_shared<const SourceText>(SourceText{"converted", *text});
  auto scene = load_scene(source, file.parent_path(), {}, diagnostics);
  if (!scene) throw Error(ErrorCode::internal, file.string(), diagnostics.text());
  return std::move(*scene);
}

TEST_P(Doors, SameWithinOnePercentOfEachTile) {
  constexpr int kTiles = 4;
  const auto rendered = [](Scene scene) {
    if (!test::nightly()) scene.render.samples = 8;
    return render(scene, {}).film;
  };
  const Film theirs = rendered(converted(test::source_tree() / "tests/scenes/doors" / GetParam().theirs));
  const Film ours = rendered(test::load_file(data_directory() / GetParam().ours, {}));
  ASSERT_TRUE(theirs.shape() == ours.shape());
  double worst = 0;
  for (int channel = 0; channel < ours.channels(); ++channel)
    for (int j = 0; j < kTiles; ++j)
      for (int i = 0; i < kTiles; ++i) {
        const auto mean = [&](const Film& film) {
          return test::region(film, channel, i * film.width() / kTiles, j * film.height() / kTiles,
                              (i + 1) * film.width() / kTiles, (j + 1) * film.height() / kTiles)
              .mean;
        };
        worst = std::max(worst, std::abs(mean(theirs) / mean(ours) - 1));
      }
  std::printf("largest difference of a tile: %.3f %%\n", 100 * worst);
  EXPECT_LE(worst, 0.01);
}

INSTANTIATE_TEST_SUITE_P(All, Doors,
                         ::testing::Values(Pair{"pbrt/cornell.pbrt", "scenes/cornell.json"},
                                           Pair{"pbrt/metals.pbrt", "bench/metals.json"},
                                           Pair{"mitsuba/cornell.xml", "scenes/cornell.json"},
                                           Pair{"mitsuba/metals.xml", "bench/metals.json"}));

}  // namespace
}  // namespace abbe
