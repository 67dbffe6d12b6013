#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace abbe::test {
namespace {

// Uses path tracing alone unless the test needs the choice of an integrator, whose pilot rays take longest.
std::string quick_furnace(const std::string& more, const std::string& integrators = "path") {
  return "bench furnace --spp 1,2 --seeds 2 --quick --reference-spp 32 --json --cache " +
         (scratch() / "cache").string() + " " + (integrators.empty() ? "" : "--integrator " + integrators) +
         " " + more;
}

TEST(BenchProgram, RunsEndToEndAndComparesWithItself) {
  const std::filesystem::path folder = scratch() / "out";
  const Outcome run = abbe(quick_furnace("-o " + folder.string(), ""));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("the reference is rendered"), std::string::npos) << run.err;
  const nlohmann::json json = run.json();
  EXPECT_EQ(json["version"], ABBE_VERSION);
  EXPECT_TRUE(json["quick"]);
  EXPECT_EQ(json, nlohmann::json::parse(read_file(folder / "bench.json")));
  const nlohmann::json& rows = json["suites"].at(0)["rows"];
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(json["suites"][0]["reference_spp"], 32);
  EXPECT_EQ(rows[0]["paths"], 64 * 64);
  EXPECT_GT(rows[0]["cpu_s"], 0);
  EXPECT_GT(rows[0]["embree_replay_share"], 0);
  EXPECT_GT(rows[0]["relMSE"], rows[3]["relMSE"]);
  EXPECT_TRUE(read_file(folder / "bench.csv").starts_with("suite,integrator,spp,seed,"));
  EXPECT_TRUE(read_file(folder / "furnace.svg").ends_with("</svg>\n"));

  const Outcome again = abbe(quick_furnace("--baseline " + (folder / "bench.json").string(), ""));
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.err.find("the reference was in the cache"), std::string::npos) << again.err;
  const nlohmann::json change = again.json()["baseline"].at(0);
  EXPECT_EQ(change["relMSE"]["ratio"], 1);
  EXPECT_FALSE(change["relMSE"]["changed"]);
}

TEST(BenchProgram, ComparesIntegratorsInTheOrderOfTheirList) {
  const Outcome run = abbe(quick_furnace("", "bdpt,path,bdpt"));
  ASSERT_EQ(run.code, 0) << run.err;
  const nlohmann::json suite = run.json()["suites"].at(0);
  ASSERT_EQ(suite["rows"].size(), 8U);
  ASSERT_EQ(suite["standings"].size(), 2U);
  EXPECT_EQ(suite["standings"][0]["integrator"], "path");
  EXPECT_EQ(suite["standings"][1]["integrator"], "bdpt");
  const bool path_is_best = suite["standings"][0]["cost"] < suite["standings"][1]["cost"];
  EXPECT_EQ(suite["standings"][path_is_best ? 0 : 1]["over_best"], 1);
}

TEST(BenchProgram, StrictFailsWhenErrorGrew) {
  const Outcome first = abbe(quick_furnace(""));
  ASSERT_EQ(first.code, 0) << first.err;
  nlohmann::json planted = first.json();
  for (nlohmann::json& row : planted["suites"][0]["rows"]) row["relMSE"] = row["relMSE"].get<double>() / 1.2;
  const std::string baseline = "--baseline " + scratch().write("planted.json", planted.dump()).string();
  EXPECT_EQ(abbe(quick_furnace(baseline)).code, 0);
  EXPECT_EQ(abbe(quick_furnace(baseline + " --strict")).code, 1);
}

TEST(BenchProgram, RefusesABaselineOfOtherConditionsBeforeItRenders) {
  const Outcome first = abbe(quick_furnace("--threads 1"));
  ASSERT_EQ(first.code, 0) << first.err;
  const std::string baseline = " --baseline " + scratch().write("other.json", first.json().dump()).string();
  for (const auto& [now, told] : std::vector<std::pair<std::string, std::string>>{
           {quick_furnace("--threads 2"), "differ: threads (got 1, allowed 2)\n"},
           {"bench furnace --spp 1,2 --reference-spp 16 --quick --threads 1 --integrator path --cache " +
                (scratch() / "cache").string(),
            "differ: reference_spp (got 32, allowed 16)\n"},
           {"bench furnace --reference-spp 32 --threads 1 --integrator path --cache " +
                (scratch() / "cache").string(),
            "differ: resolution (got 64x64, allowed 256x256)\n"}}) {
    const Outcome run = abbe(now + baseline);
    EXPECT_EQ(run.code, 4) << run.err;
    EXPECT_NE(run.err.find(told), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find("samples per pixel"), std::string::npos) << run.err;
  }
  EXPECT_EQ(abbe(quick_furnace("--threads 1" + baseline)).code, 0);
}

TEST(BenchProgram, RefusesOptionsThatWouldHaveNoEffect) {
  for (const auto& [arguments, told] : std::vector<std::pair<std::string, std::string>>{
           {"furnace --strict", "--strict requires --baseline"},
           {"furnace --seed 3", "--seed requires --soak"},
           {"furnace --soak 1", "suite excludes --soak"},
           {"furnace --scale", "suite excludes --scale"},
           {"furnace --list", "suite excludes --list"},
           {"--soak 1 --spp 4", "--spp excludes --soak"},
           {"--soak 1 --seeds 2", "--seeds excludes --soak"},
           {"--soak 1 --integrator path", "--integrator excludes --soak"},
           {"--soak 1 --reference-spp 4", "--reference-spp excludes --soak"},
           {"--soak 1 --baseline b.json", "--baseline excludes --soak"},
           {"--soak 1 --quick", "--quick excludes --soak"},
           {"--soak 1 --threads 1", "--threads excludes --soak"},
           {"--soak 1 --scale", "--scale excludes --soak"},
           {"--soak 1 -o none --cache none", "--cache: has no effect on --soak with --output"},
           {"--scale --spp 4", "--spp excludes --scale"},
           {"--scale -o none", "--output excludes --scale"},
           {"--scale --baseline b.json", "--baseline excludes --scale"},
           {"--list --quick", "--quick excludes --list"},
           {"--list --soak 1", "--soak excludes --list"},
           {"--list --cache none", "--cache excludes --list"}}) {
    const Outcome run = abbe("bench " + arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_NE(run.err.find(told), std::string::npos) << arguments << ": " << run.err;
  }
}

TEST(BenchProgram, ListsItsSuitesAndRefusesOthers) {
  const Outcome list = abbe("bench --list --json");
  ASSERT_EQ(list.code, 0) << list.err;
  for (const char* name :
       {"furnace", "cornell", "cornell-10nm", "prism-spot", "prism-area", "glass-sphere", "mesh"})
    EXPECT_TRUE(list.json().contains(name)) << name;
  EXPECT_NE(list.json()["mesh"].get<std::string>().find("diffuse"), std::string::npos);
  EXPECT_EQ(abbe("bench cornel").code, 2);
  EXPECT_EQ(abbe("bench furnace --spp 4,0").code, 2);
  const Outcome misspelt = abbe("bench furnace --integrator auto,bdp");
  EXPECT_EQ(misspelt.code, 2);
  EXPECT_NE(misspelt.err.find("bdpt"), std::string::npos) << misspelt.err;
  EXPECT_EQ(abbe("bench furnace --baseline /nowhere.json").code, 4);
  const Outcome nowhere = abbe("bench furnace -o /dev/null/folder");
  EXPECT_EQ(nowhere.code, 5);
  EXPECT_EQ(nowhere.err.find("reference"), std::string::npos) << "found out before rendering";
}

}  // namespace
}  // namespace abbe::test
