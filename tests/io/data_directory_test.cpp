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

/// Prints what `ask` gives or complains of on stderr and ends the process: for a fresh one, which has not
/// chosen its folder yet.
template <class Ask>
[[noreturn]] void answer_and_exit(Ask ask) {
  try {
    std::fputs(ask().c_str(), stderr);
    std::exit(0);
  } catch (const Error& error) {
    std::fputs(error.what(), stderr);
    std::exit(static_cast<int>(error.code));
  }
}

TEST(DataDirectory, FollowsTheEnvironment) {
  EXPECT_EQ(data_directory(), kOwnData.folder);
}

TEST(DataDirectory, WrongEnvironmentIsAnErrorAndNoneMeansTheSourceTree) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a fresh process, which has not chosen yet
  EXPECT_EXIT(
      {
        ::setenv("ABBE_DATA", "/nonexistent", 1);
        answer_and_exit(data_directory);
      },
      testing::ExitedWithCode(4), "ABBE_DATA: no such folder \\(got /nonexistent\\)");
  EXPECT_EXIT(
      {
        ::unsetenv("ABBE_DATA");
        answer_and_exit(data_directory);
      },
      testing::ExitedWithCode(0), "/data$");
}

TEST(DataDirectory, AProgramMayNameIt) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto named = test_folder();
  EXPECT_EXIT(
      {
        ::unsetenv("ABBE_DATA");
        set_data_directory(named);
        std::exit(data_directory() == named ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
  EXPECT_EXIT(
      {
        set_data_directory(named);
        std::exit(data_directory() == kOwnData.folder ? 0 : 1);  // the environment comes first
      },
      testing::ExitedWithCode(0), "");
  EXPECT_EXIT(
      {
        ::unsetenv("ABBE_DATA");
        set_data_directory("/nonexistent");
        answer_and_exit(data_directory);
      },
      testing::ExitedWithCode(4), "set_data_directory: no such folder \\(got /nonexistent\\)");
}

// The known answer is what coreutils say: sha256sum b/y.csv z.csv | sha256sum.
TEST(DataDirectory, HashIsThatOfTheTables) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto folder = test_folder();
  for (const char* inner : {"b", "scenes"}) std::filesystem::create_directories(folder / inner);
  put(folder / "z.csv", "2\n");
  put(folder / "b" / "y.csv", "1\n");
  put(folder / "b" / "y.txt", "no table");
  put(folder / "scenes" / "x.csv", "no table of this hash");
  const auto hash = [&folder] {
    ::setenv("ABBE_DATA", folder.c_str(), 1);
    answer_and_exit(data_sha256);
  };
  EXPECT_EXIT(hash(), testing::ExitedWithCode(0),
              "^83f40fa66ca3ce1c76cc3299b90b1d68fe3a013049773706456a19946703f799$");
  put(folder / "b" / "y.csv", "3\n");
  EXPECT_EXIT(hash(), testing::ExitedWithCode(0),
              "^511bd2fde32fef0f0e2021782e37a4016b16fd91b4bad2687873c79cc5a57a57$");
  put(folder / "b" / "y.csv", std::string("\0", 1));
  EXPECT_EXIT(hash(), testing::ExitedWithCode(4), "b/y.csv:1:1: error: NUL byte in a text");
}

}  // namespace
}  // namespace abbe
