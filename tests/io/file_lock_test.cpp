#include "io/atomic_file.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "io/error.h"
#include "test_files.h"

namespace abbe {
namespace {

bool can_lock(const std::filesystem::path& path) {
  try {
    const FileLock lock(path);
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::output);
    EXPECT_EQ(error.what(), path.string() + ": another process is writing it");
    return false;
  }
}

/// Runs `during` while another process holds the lock, then kills that process.
void while_locked_elsewhere(const std::filesystem::path& path, const std::function<void(pid_t)>& during) {
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const FileLock lock(path);
    (void)!::write(ready[1], "x", 1);
    ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  during(child);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(ready[0]);
  ::close(ready[1]);
}

TEST(FileLock, OneHolderAtATimeAndNothingLeftBehind) {
  const auto path = test_folder() / "out.exr";
  {
    const FileLock lock(path);
    EXPECT_FALSE(can_lock(path));
    EXPECT_TRUE(can_lock(path.parent_path() / "other.exr"));
  }
  EXPECT_TRUE(can_lock(path));
  EXPECT_TRUE(std::filesystem::is_empty(path.parent_path()));
}

TEST(FileLock, AKilledHolderHoldsNothing) {
  const auto path = test_folder() / "out.exr";
  while_locked_elsewhere(path, [&](pid_t) { EXPECT_FALSE(can_lock(path)); });
  EXPECT_TRUE(can_lock(path));
}

// Also while others take it, let it go and remove its file.
TEST(FileLock, ManyWhoTryAreOneAtATime) {
  const auto path = test_folder() / "out.exr";
  std::atomic<int> inside{0};
  std::atomic<int> most{0};
  const auto hold_often = [&] {
    for (int held = 0; held < 100;) try {
        const FileLock lock(path);
        most = std::max(most.load(), ++inside);
        std::this_thread::yield();
        --inside;
        ++held;
      } catch (const Error&) {
      }
  };
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) threads.emplace_back(hold_often);
  }
  EXPECT_EQ(most, 1);
}

TEST(FileLock, ALinkAndWhatItLeadsToAreOneOutput) {
  const auto path = test_folder() / "out.exr";
  const auto link = path.parent_path() / "link.exr";
  std::filesystem::create_symlink("out.exr", link);
  const FileLock lock(path);
  try {
    const FileLock other(link);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), link.string() + ": another process is writing it");
  }
}

TEST(FileLock, RemovesWhatTheDeadLeftHalfWritten) {
  const auto folder = test_folder();
  const auto path = folder / "out.exr";
  pid_t dead = 0;
  while_locked_elsewhere(path, [&](pid_t child) { dead = child; });
  const auto temporary = [&](const std::string& stem, pid_t process, const std::string& extension) {
    const auto file = folder / ("." + stem + ".abbe-" + std::to_string(process) + "-0" + extension);
    put(file, "half");
    return file;
  };
  const auto left = temporary("out", dead, ".exr");
  const auto alive = temporary("out", ::getpid(), ".exr");
  const auto other = temporary("out2", dead, ".exr");
  const auto kind = temporary("out", dead, ".png");
  EXPECT_TRUE(can_lock(path));
  EXPECT_FALSE(std::filesystem::exists(left));
  for (const auto& kept : {alive, other, kind}) EXPECT_TRUE(std::filesystem::exists(kept)) << kept;
}

TEST(FileLock, AMissingFolderIsAnOutputError) {
  try {
    const FileLock lock(test_folder() / "nowhere" / "out.exr");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::output);
  }
}

}  // namespace
}  // namespace abbe
