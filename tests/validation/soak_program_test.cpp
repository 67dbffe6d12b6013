#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace abbe::test {
namespace {

std::string soak(const std::string& paths, const std::string& seed, const std::string& folder) {
  return "bench --soak " + paths + " --seed " + seed + " --json -o " + (scratch() / folder).string();
}

TEST(Soak, NothingGoesWrongInDrawnScenes) {
  const Outcome run = abbe(soak("300000", "51", "fine"));
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_GE(run.json()["paths"], 300000);
  EXPECT_GE(run.json()["scenes"], 5);
  EXPECT_EQ(run.json()["failures"], 0);
  EXPECT_TRUE(std::filesystem::is_empty(scratch() / "fine"));
}

// Without tables the names of spectra and materials are unknown, so every scene fails.
TEST(Soak, AFailingSceneIsKeptAndTold) {
  std::filesystem::create_directories(scratch() / "empty");
  const Outcome run =
      shell("ABBE_DATA=" + (scratch() / "empty").string() + " " ABBE_BINARY " " + soak("1", "1", "kept"));
  EXPECT_EQ(run.code, 1) << run.err;
  EXPECT_GE(run.json()["failures"], 1);
  const std::filesystem::path scene = scratch() / "kept/soak_1/soak_1.json";
  EXPECT_NE(run.err.find(scene.string() + ": "), std::string::npos) << run.err;
  EXPECT_TRUE(std::filesystem::exists(scene));
}

TEST(NightlySoak, ASeedIsOneSceneWhereverItStands) {
  const auto rays = [](const std::string& paths, const std::string& seed) {
    return abbe(soak(paths, seed, "seed")).json()["rays"].get<std::uint64_t>();
  };
  EXPECT_EQ(rays("1", "15"), rays("1", "15"));
  EXPECT_NE(rays("1", "15"), rays("1", "16"));
}

}  // namespace
}  // namespace abbe::test
