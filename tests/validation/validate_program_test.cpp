#include <sys/resource.h>

#include <gtest/gtest.h>

#include "io/data_directory.h"
#include "tests/cli/program.h"
#include "tests/tier.h"

namespace abbe::test {
namespace {

TEST(ValidateProgram, WritesJsonAndReport) {
  const std::filesystem::path folder = scratch() / "made" / "out";
  const Outcome run = abbe("validate --quick --suite camera --json -o " + folder.string());
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("camera raw"), std::string::npos) << run.err;
  const nlohmann::json json = nlohmann::json::parse(read_file(folder / "report.json"));
  EXPECT_EQ(json["version"], ABBE_VERSION);
  EXPECT_TRUE(json["quick"]);
  EXPECT_TRUE(read_file(folder / "report.html").ends_with("</html>\n"));
  EXPECT_EQ(run.json()["outcomes"].size(), json["outcomes"].size());
}

double children_cpu_seconds() {
  rusage usage{};
  EXPECT_EQ(getrusage(RUSAGE_CHILDREN, &usage), 0);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// The CPU seconds include hashing the data, loading scenes and planning; the nightly run also renders.
TEST(ValidateProgram, CountsTheCpuSecondsOfAllThatItDoes) {
  const double before = children_cpu_seconds();
  const std::string suite = nightly() ? "sensor" : "camera";
  const nlohmann::json json = abbe("validate --quick --suite " + suite + " --json").json();
  const double used = children_cpu_seconds() - before;
  EXPECT_NEAR(json["cpu_s"].get<double>(), used, 0.05 * used + 0.2);  // includes the start of the program
}

// Copy of the data folder made of links, with one known answer changed by a thousandth.
std::filesystem::path spoilt_data() {
  namespace fs = std::filesystem;
  const fs::path folder = scratch() / "data";
  fs::create_directories(folder / "reference");
  for (const auto& entry : fs::directory_iterator(data_directory()))
    if (entry.path().filename() != "reference")
      fs::create_symlink(entry.path(), folder / entry.path().filename());
  for (const auto& entry : fs::directory_iterator(data_directory() / "reference"))
    fs::copy(entry.path(), folder / "reference");
  const fs::path table = folder / "reference" / "camera_raw_colorchecker.csv";
  std::string text = read_file(table);
  const std::size_t at = text.find("0.1558763");
  EXPECT_NE(at, std::string::npos);
  std::ofstream(table, std::ios::binary) << text.replace(at, 9, "0.1560322");
  return folder;
}

TEST(ValidateProgram, AFailingCaseIsToldInTheTableAndIsTheExitCode) {
  const Outcome run =
      shell("ABBE_DATA=" + spoilt_data().string() + " " ABBE_BINARY " validate --quick --suite camera");
  EXPECT_EQ(run.code, 1) << run.err;
  EXPECT_NE(run.out.find("least-squares"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("radiometry  "), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("FAIL"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("2 of 3 cases pass"), std::string::npos) << run.out;
}

TEST(ValidateProgram, RefusesOtherSuitesAndPlacesItCannotWrite) {
  const Outcome run = abbe("validate --suite optics,color");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("colour"), std::string::npos) << run.err;
  EXPECT_EQ(abbe("validate --quick --suite camera -o /proc/nowhere").code, 5);
}

}  // namespace
}  // namespace abbe::test
