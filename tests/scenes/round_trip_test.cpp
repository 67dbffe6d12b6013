// Scenes read, written and read again render the same bits.
#include <memory>
#include <string>
#include <vector>

#include "description/scene.h"
#include "io/schema/read.h"
#include "io/schema/write.h"
#include "tests/description/examples.h"
#include "tests/scenes/film_of_plan.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

// A copy of a folder that a scene can be written into: its files are there as links.
class Copy {
 public:
  explicit Copy(const fs::path& folder)
      : path_(fs::temp_directory_path() / ("abbe_round_trip_" + std::to_string(::getpid()))) {
    fs::create_directory(path_);
    for (const auto& entry : fs::directory_iterator(folder))
      fs::create_symlink(fs::absolute(entry.path()), path_ / entry.path().filename());
  }
  ~Copy() { fs::remove_all(path_); }
  Copy(const Copy&) = delete;
  Copy& operator=(const Copy&) = delete;

  [[nodiscard]] fs::path file(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  fs::path path_;
};

// What is written of a scene that has been read.
std::string written(const std::string& text) {
  Diagnostics diagnostics;
  const auto json = parse_json(std::make_shared<const SourceText>(SourceText{"scene", text}), diagnostics);
  const auto scene = json ? schema::read<spec::Scene>(*json, diagnostics) : std::nullopt;
  if (!scene) throw Error(ErrorCode::internal, "scene", diagnostics.text());
  return to_text(schema::write(*scene));
}

// Few samples of few pixels, or of the scene's own where these are few: a row of a spectrograph is.
std::vector<Override> small_settings(const Scene& scene) {
  std::vector<Override> settings{{"/render/samples", "8"}};
  if (scene.camera.width * scene.camera.height > 4096) settings.push_back({"/sensor/resolution", "[32, 18]"});
  return settings;
}

// By day of a plan that pilots have taught nothing: they would take much longer than the paths.
Film film_of_few(const Scene& scene) {
  if (test::nightly()) return render(scene, {}).film;
  return test::film_of(scene, make_plan(scene), static_cast<std::uint64_t>(scene.render.samples));
}

TEST(RoundTrip, EveryShippedSceneRendersTheSameBits) {
  const std::vector<fs::path> paths = test::scene_files("scenes");
  ASSERT_GE(paths.size(), 40U);
  int seen = 0;
  for (const fs::path& path : paths) {
    SCOPED_TRACE(path);
    const std::vector<Override> settings = small_settings(test::load_file(path, {}));
    const Scene scene = test::load_file(path, settings);
    const Film film = film_of_few(scene);
    const Copy folder(path.parent_path());
    const fs::path copy = folder.file("written_scene.json", written(test::file_text(path)));
    const Film again = film_of_few(test::load_file(copy, settings));
    EXPECT_TRUE(film.shape() == again.shape());
    EXPECT_TRUE(film.bytes() == again.bytes());
    const bool dark = film.bytes().find_first_not_of('\0') == std::string_view::npos;
    if (test::nightly()) {
      EXPECT_EQ(dark, scene.lights.empty());
    }
    seen += dark ? 0 : 1;
  }
  EXPECT_GE(seen, 35) << "of those that are lit, a few are dark without what pilots find";
}

}  // namespace
}  // namespace abbe
