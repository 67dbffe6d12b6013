#include "io/text.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "test_files.h"

namespace abbe {
namespace {

/// What reading the file complains about, without its path.
std::string refusal(const std::filesystem::path& path, ErrorCode code, std::size_t limit = 1000) {
  Diagnostics diagnostics;
  EXPECT_EQ(read_text(path, diagnostics, ErrorCode::scene, limit), nullptr);
  EXPECT_EQ(diagnostics.code(), code);
  const std::string text = diagnostics.text();
  EXPECT_TRUE(text.starts_with(path.string())) << text;
  return text.substr(path.string().size());
}

TEST(ReadText, GivesTheTextWithoutByteOrderMark) {
  const auto path = test_folder() / "a.txt";
  put(path, "\xEF\xBB\xBFλ = 550\n");
  Diagnostics diagnostics;
  const auto text = read_text(path, diagnostics);
  ASSERT_NE(text, nullptr);
  EXPECT_EQ(text->text, "λ = 550\n");
  EXPECT_EQ(text->file, path.string());
}

TEST(ReadText, RefusesWhatIsNoText) {
  const auto folder = test_folder();
  const auto path = folder / "a.txt";
  put(path, "ab\n\"\xFF\"");
  EXPECT_EQ(refusal(path, ErrorCode::scene), ":2:2: error: invalid UTF-8 (got byte 0xFF)\n\"\n ^\n");
  put(path, std::string("ab\0c", 4));
  EXPECT_EQ(refusal(path, ErrorCode::scene), ":1:3: error: NUL byte in a text\nab\n  ^\n");
}

TEST(ReadText, RefusesWhatIsNoRegularFileWithoutWaiting) {
  const auto folder = test_folder();
  EXPECT_EQ(refusal(folder / "none", ErrorCode::scene),
            ": error: cannot open the file (No such file or directory)\n");
  EXPECT_EQ(refusal(folder, ErrorCode::scene), ": error: not a regular file\n");
  ASSERT_EQ(::mkfifo((folder / "fifo").c_str(), 0600), 0);
  EXPECT_EQ(refusal(folder / "fifo", ErrorCode::scene), ": error: not a regular file\n");
  EXPECT_EQ(refusal("/dev/zero", ErrorCode::scene), ": error: not a regular file\n");
}

TEST(FileFault, NamesWhatNoDiskHolds) {
  const auto folder = test_folder();
  put(folder / "file", "text");
  EXPECT_FALSE(file_fault(folder / "file"));
  std::filesystem::create_symlink("file", folder / "link");
  EXPECT_FALSE(file_fault(folder / "link"));
  EXPECT_EQ(file_fault(folder / "none"), "no such file");
  ASSERT_EQ(::mkfifo((folder / "fifo").c_str(), 0600), 0);
  const int listening = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = (folder / "socket").string();
  ASSERT_LT(name.size(), sizeof address.sun_path);
  name.copy(address.sun_path, name.size());
  ASSERT_EQ(::bind(listening, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::close(listening);
  for (const std::filesystem::path& path :
       {folder, folder / "fifo", folder / "socket", std::filesystem::path("/dev/zero"),
        std::filesystem::path("/proc/kmsg"), std::filesystem::path("/sys/kernel/notes")})
    if (std::filesystem::exists(path)) {
      EXPECT_EQ(file_fault(path), "not a regular file") << path;
    }
  Diagnostics diagnostics;
  EXPECT_FALSE(is_file("/dev/zero", {}, diagnostics));
  EXPECT_EQ(diagnostics.all().front().message, "not a regular file \"/dev/zero\"");
}

TEST(ReadText, LimitIsInclusive) {
  const auto path = test_folder() / "a.txt";
  put(path, "12345");
  EXPECT_EQ(refusal(path, ErrorCode::resource, 4), ": error: file too large (allowed 4 bytes)\n");
  EXPECT_EQ(refusal("/proc/self/status", ErrorCode::resource, 4),
            ": error: file too large (allowed 4 bytes)\n")
      << "a file that announces no size";
  Diagnostics diagnostics;
  EXPECT_NE(read_text(path, diagnostics, ErrorCode::input, 5), nullptr);
}

TEST(ValidPrefix, StopsAtTheFirstBadByte) {
  EXPECT_EQ(valid_prefix("aλ€𝄞"), 10U);
  EXPECT_EQ(valid_prefix("a\xC0\xAF"), 1U) << "overlong slash";
  EXPECT_EQ(valid_prefix("a\xED\xA0\x80"), 1U) << "surrogate";
  EXPECT_EQ(valid_prefix("a\xF4\x90\x80\x80"), 1U) << "beyond U+10FFFF";
  EXPECT_EQ(valid_prefix("ab\xCE"), 2U) << "cut short";
}

TEST(ValidUtf8, ReplacesTheOtherBytesAlone) {
  EXPECT_EQ(valid_utf8("aλ€𝄞"), "aλ€𝄞");
  EXPECT_EQ(valid_utf8(""), "");
  EXPECT_EQ(valid_utf8("caf\xE9 \xFF"), "caf\uFFFD \uFFFD");
  EXPECT_EQ(valid_utf8(std::string_view("a\0b", 3), "?"), "a?b");
  EXPECT_EQ(valid_utf8("ab\xCE", "?"), "ab?") << "cut short";
}

TEST(ParseNumber, AllOfTheTextOrNothing) {
  EXPECT_EQ(parse_number("587.5618"), 587.5618);
  EXPECT_EQ(parse_number("+1e-3"), 0.001);
  EXPECT_EQ(parse_number("-.5"), -0.5);
  for (const char* text : {"", "1,5", "1.5 ", "0x10", "1e400", "nan", "inf", "+-1", "++1", "1e"})
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
}

TEST(Split, TrimsAndKeepsEmptyPieces) {
  EXPECT_EQ(split(" a ,,b\t", ','), (std::vector<std::string>{"a", "", "b"}));
  EXPECT_EQ(split("", ','), (std::vector<std::string>{""}));
}

TEST(Sha256, ExamplesOfTheStandard) {  // [FIPS180-4], the examples published with it
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

}  // namespace
}  // namespace abbe
