#include "io/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

#include "io/error.h"
#include "test_files.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

/// The message of the output error that `action` throws.
template <class Action>
std::string output_error(Action action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::output);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

TEST(AtomicFile, WritesThroughATemporaryOfTheSameKindBesideIt) {
  const auto path = test_folder() / "out.png";
  put(path, "old");
  fs::path seen;
  write_atomically(
      path,
      [&](const fs::path& temporary) {
        seen = temporary;
        put(temporary, "new");
      },
      [&](const fs::path& temporary) {
        EXPECT_EQ(bytes_of(path), "old") << "replaced before it was verified";
        return bytes_of(temporary) == "new";
      });
  EXPECT_EQ(bytes_of(path), "new");
  EXPECT_EQ(seen.parent_path(), path.parent_path());
  EXPECT_EQ(seen.extension(), ".png");
  EXPECT_NE(seen, path);
  EXPECT_EQ(files_in(path.parent_path()), 1U);
}

TEST(AtomicFile, WritesNamesAsLongAsFileSystemsTake) {
  const auto folder = test_folder();
  const std::string exr = ".exr";
  for (const std::size_t bytes : {200U, 231U, 244U, 255U}) {
    std::string name;
    while (name.size() + exr.size() + 3 <= bytes) name += "\u2080";  // of three bytes
    name += std::string(bytes - exr.size() - name.size(), 'x') + exr;
    write_atomically(folder / name, "new");
    EXPECT_EQ(bytes_of(folder / name), "new") << bytes;
    EXPECT_NO_THROW(FileLock(folder / name)) << bytes;
  }
  EXPECT_EQ(files_in(folder), 4U);
  const std::string start(240, 'x');
  const FileLock one(folder / (start + "1"));
  EXPECT_NO_THROW(FileLock(folder / (start + "2"))) << "long names that differ at their end";
  EXPECT_NE(output_error([&] { FileLock(folder / (start + "1")); }), "");
  const fs::path longer = folder / (std::string(252, 'x') + exr);
  EXPECT_EQ(output_error([&] { require_writable(longer); }),
            longer.string() + ": the name is longer than the file system allows");
}

TEST(AtomicFile, WritesWhereLinksLead) {
  const auto folder = test_folder();
  fs::create_directory(folder / "far");
  fs::create_symlink("far/link", folder / "link");
  fs::create_symlink("out", folder / "far" / "link");  // to a file still missing
  write_atomically(folder / "link", "new");
  EXPECT_EQ(bytes_of(folder / "far" / "out"), "new");
  EXPECT_EQ(destination(folder / "link"), folder / "far" / "out");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  fs::create_symlink("loop", folder / "loop");
  EXPECT_EQ(output_error([&] { write_atomically(folder / "loop", "x"); }),
            (folder / "loop").string() + ": is a cycle of symbolic links");
}

// As an owner without the rights of root, who may do all.
TEST(AtomicFile, AReadOnlyFileStays) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // threads of libraries do not survive a fork
  const auto path = test_folder() / "out.txt";
  put(path, "old");
  fs::permissions(path, fs::perms::owner_read | fs::perms::others_read);
  fs::permissions(path.parent_path(), fs::perms::all);
  const auto write = [&] {
    (void)!::seteuid(65534);
    int code = 0;
    try {
      write_atomically(path, "new");
    } catch (const Error& error) {
      code = static_cast<int>(error.code);
    }
    (void)!::seteuid(::getuid());
    std::exit(code);
  };
  EXPECT_EXIT(write(), testing::ExitedWithCode(5), "");
  EXPECT_EQ(bytes_of(path), "old");
}

TEST(AtomicFile, AnyFailureLeavesTheOldFileAlone) {
  const auto path = test_folder() / "out.txt";
  put(path, "old");
  const auto keep = [](const fs::path&) { return true; };
  const auto fill = [](const fs::path& temporary) { put(temporary, "half"); };
  output_error([&] { write_atomically(path, fill, [](const fs::path&) { return false; }); });
  const std::string thrown = output_error([&] {
    write_atomically(
        path,
        [&](const fs::path& temporary) {
          fill(temporary);
          throw std::runtime_error("library failed");
        },
        keep);
  });
  EXPECT_EQ(thrown, path.string() + ": library failed");
  output_error([&] {
    write_atomically(
        path, [](const fs::path&) {}, keep);
  });
  output_error([&] {
    write_atomically(path, fill,
                     [](const fs::path&) -> bool { throw Error(ErrorCode::input, "", "unreadable"); });
  });
  EXPECT_EQ(bytes_of(path), "old");
  EXPECT_EQ(files_in(path.parent_path()), 1U) << "a temporary was left behind";
}

TEST(AtomicFile, OurOwnBugsKeepTheirCode) {
  const auto path = test_folder() / "out.txt";
  try {
    write_atomically(
        path, [](const fs::path&) { throw Error(ErrorCode::internal, "", "bug"); },
        [](const fs::path&) { return true; });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::internal);
  }
}

TEST(AtomicFile, WritesBytes) {
  const auto path = test_folder() / "bytes";
  const std::string bytes("a\0\r\n\xFF", 5);
  write_atomically(path, bytes);
  EXPECT_EQ(bytes_of(path), bytes);
  write_atomically(path, "");
  EXPECT_EQ(bytes_of(path), "");
}

TEST(AtomicFile, FullDiskIsAnOutputErrorAndKeepsTheOldFile) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // threads of libraries do not survive a fork
  const auto path = test_folder() / "bytes";
  put(path, "old");
  for (const std::size_t space : {1U, 99999U})
    EXPECT_EXIT(write_on_full_disk(space, [&] { write_atomically(path, std::string(100000, 'x')); }),
                testing::ExitedWithCode(5), "");
  EXPECT_EQ(bytes_of(path), "old");
  EXPECT_EQ(files_in(path.parent_path()), 1U);
}

TEST(AtomicFile, UnwritablePlacesAreFoundBeforeTheWork) {
  const auto folder = test_folder();
  EXPECT_NO_THROW(require_writable(folder / "new.exr"));
  EXPECT_NO_THROW(require_writable("relative.exr"));
  EXPECT_FALSE(fs::exists(folder / "new.exr"));
  const fs::path deep = folder / "no" / "out.exr";
  EXPECT_EQ(output_error([&] { require_writable(deep); }),
            deep.string() + ": no such folder \"" + deep.parent_path().string() + "\"");
  EXPECT_EQ(output_error([&] { require_writable(folder); }), folder.string() + ": is a folder");
  const fs::path fifo =
      folder / "fifo";  // stands for every device: a failing test as root must not replace one
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_EQ(output_error([&] { write_atomically(fifo, "x"); }),
            fifo.string() + ": is a device, not a regular file");
  EXPECT_TRUE(fs::is_fifo(fifo));
  EXPECT_EQ(output_error([&] { require_writable(""); }), "no file name");
  EXPECT_NE(output_error([&] { require_writable("/proc/x.exr"); }).find("/proc/x.exr"), std::string::npos);
}

}  // namespace
}  // namespace abbe
