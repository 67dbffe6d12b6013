#include "io/data_directory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "io/error.h"
#include "test_files.h"

namespace abbe {
namespace {

/// Tests of this program see a data directory of their own, chosen before any of them asks for it.
const struct OwnData {
  OwnData() {
    std::filesystem::create_directories(folder);
    ::setenv("ABBE_DATA", folder.c_str(), 1);
  }
  OwnData(const OwnData&) = delete;
  OwnData& operator=(const OwnData&) = delete;
  ~OwnData() { std::filesystem::remove_all(folder); }

  std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("abbe_io_test_data_" + std::to_string(::getpid()));
} kOwnData;

TEST(DataDirectory, FollowsTheEnvironment) {
  EXPECT_EQ(data_directory(), kOwnData.folder);
}

TEST(DataDirectory, WrongEnvironmentIsAnErrorAndNoneMeansTheSourceTree) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a fresh process, which has not chosen yet
  EXPECT_EXIT(
      {
        ::setenv("ABBE_DATA", "/nonexistent", 1);
        try {
          std::exit(data_directory().empty() ? 1 : 0);
        } catch (const Error& error) {
          std::fputs(error.what(), stderr);
          std::exit(static_cast<int>(error.code));
        }
      },
      testing::ExitedWithCode(4), "ABBE_DATA: no such folder \\(got /nonexistent\\)");
  EXPECT_EXIT(
      {
        ::unsetenv("ABBE_DATA");
        std::fputs(data_directory().c_str(), stderr);
        std::exit(0);
      },
      testing::ExitedWithCode(0), "/data$");
}

}  // namespace
}  // namespace abbe
