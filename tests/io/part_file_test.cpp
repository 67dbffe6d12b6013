#include "io/part_file.h"

#include <thread>

#include "io/error.h"
#include "test_files.h"
#include "tests/tier.h"

namespace abbe {
namespace {

const std::map<std::string, std::string> kHeader{{"scene", "a b.json"}, {"seed", "7"}};
const std::string kBytes("\0\n\nabc\xff: x", 10);

std::filesystem::path written() {
  const auto path = test_folder() / "sums.abbepart";
  write_part_file(path, kHeader, kBytes);
  return path;
}

/// The message of the input error that reading throws.
std::string complaint_about(const std::filesystem::path& path) {
  try {
    (void)read_part_file(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::input);
    return error.what();
  }
  return "";
}

TEST(PartFile, ReadsBackWhatWasWritten) {
  const PartFile part = read_part_file(written());
  EXPECT_EQ(part.header, kHeader);
  EXPECT_EQ(part.bytes, kBytes);
}

TEST(PartFile, ItsHeaderIsReadAlone) {
  const auto path = written();
  EXPECT_EQ(read_part_file_header(path), kHeader);
  std::string bad = bytes_of(path);
  bad.back() ^= 1;
  put(path, bad);
  EXPECT_EQ(read_part_file_header(path), kHeader);
  put(path, bad.substr(0, bad.size() - 1));
  EXPECT_THROW((void)read_part_file_header(path), Error);
}

TEST(PartFile, NoBytesAreBytesToo) {
  const auto path = test_folder() / "none.abbepart";
  write_part_file(path, {}, "");
  EXPECT_EQ(read_part_file(path).bytes, "");
}

TEST(PartFile, AnyFlippedBitIsRefused) {
  const auto path = written();
  const std::string good = bytes_of(path);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 4);
    put(path, bad);
    EXPECT_NE(complaint_about(path), "") << "byte " << i;
  }
}

TEST(PartFile, AnyTornOrLongerFileIsRefused) {
  const auto path = written();
  const std::string good = bytes_of(path);
  for (std::size_t size = 0; size < good.size(); ++size) {
    put(path, good.substr(0, size));
    EXPECT_NE(complaint_about(path), "") << size << " bytes";
  }
  put(path, good + "x");
  EXPECT_NE(complaint_about(path).find("the header declares 10 bytes of sums, the file has 11"),
            std::string::npos);
}

TEST(PartFile, AHeaderThatCannotBeReadBackIsNotWritten) {
  const auto path = test_folder() / "a.abbepart";
  for (const auto& entry : std::map<std::string, std::string>{{"a", "b\nc"}, {"a\nb", "c"}, {"a:", "b"}})
    EXPECT_THROW(write_part_file(path, {entry}, ""), Error) << entry.first;
  EXPECT_THROW(write_part_file(path, {{"a", std::string(17 << 20, 'x')}}, ""), Error);
  EXPECT_FALSE(std::filesystem::exists(path));
  const std::map<std::string, std::string> odd{{"a", " b: c "}, {"", ""}};
  write_part_file(path, odd, "");
  EXPECT_EQ(read_part_file(path).header, odd);
}

TEST(PartFile, AHugeHeaderIsRefused) {
  const auto path = test_folder() / "a.abbepart";
  for (const char* line : {"x", "x: y\n"}) {
    std::string text = "abbepart 1\n";
    while (text.size() < 20'000'000) text += line;
    put(path, text + "\n\n");
    EXPECT_NE(complaint_about(path).find("damaged header"), std::string::npos);
  }
}

TEST(PartFile, OtherFilesAreRefusedByName) {
  const auto path = test_folder() / "a.abbepart";
  EXPECT_EQ(complaint_about(path), path.string() + ": no such file");
  EXPECT_EQ(complaint_about(path.parent_path()), path.parent_path().string() + ": not a regular file");
  put(path, "v/1\x01 not ours");
  EXPECT_EQ(complaint_about(path),
            path.string() + ": not a part file (expected the first line \"abbepart 1\")");
  put(path, "abbepart 1\nbytes: 99999999999999\nsha256: 00\n\n");  // nothing of that size is allocated
  EXPECT_NE(complaint_about(path).find("truncated or extended"), std::string::npos);
}

// As one who merges meets the checkpoint of another process.
TEST(PartFile, IsReadWholeWhileItIsWrittenAnew) {
  const auto path = written();
  std::jthread writer([&path](const std::stop_token& stop) {
    for (std::size_t i = 0; !stop.stop_requested(); ++i)
      write_part_file(path, {{"samples", std::string(i % 7, '1')}}, kBytes);
  });
  const int reads = test::nightly() ? 500 : 100;
  for (int i = 0; i < reads; ++i) {
    ASSERT_EQ(complaint_about(path), "");
    ASSERT_NO_THROW((void)read_part_file_header(path));
  }
}

TEST(PartFile, AFullDiskLeavesTheOldFile) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // threads of libraries do not survive a fork
  const auto path = written();
  EXPECT_EXIT(write_on_full_disk(1000, [&] { write_part_file(path, kHeader, std::string(5000, 'x')); }),
              testing::ExitedWithCode(5), "");
  EXPECT_EQ(read_part_file(path).bytes, kBytes);
}

}  // namespace
}  // namespace abbe
