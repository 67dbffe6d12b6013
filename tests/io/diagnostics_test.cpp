#include "io/diagnostics.h"

#include <gtest/gtest.h>

#include "test_files.h"

namespace abbe {
namespace {

std::string error_at(const std::string& text, std::size_t offset, const std::string& pointer = "") {
  return format({Diagnostic::Severity::error, ErrorCode::scene, {source(text), offset, pointer}, "no"});
}

TEST(Diagnostics, PlaceLineAndCaret) {
  EXPECT_EQ(error_at("{\n  \"fov\": 190\n}", 11, "/fov"),
            "a.json:2:10: /fov: error: no\n  \"fov\": 190\n         ^");
  EXPECT_EQ(error_at("x", 0), "a.json:1:1: error: no\nx\n^");
  EXPECT_EQ(error_at("x\n", 2), "a.json:2:1: error: no\n\n^");
  EXPECT_EQ(error_at("a\r\nb\r\n", 3), "a.json:2:1: error: no\nb\n^");
}

TEST(Diagnostics, NewlineBelongsToTheLineItEnds) {
  EXPECT_EQ(error_at("ab\ncd", 2), "a.json:1:3: error: no\nab\n  ^");
}

TEST(Diagnostics, ColumnsCountCodePointsAndTabsStay) {
  EXPECT_EQ(error_at("\tλé x", 6), "a.json:1:5: error: no\n\tλé x\n\t   ^");
}

TEST(Diagnostics, LongLinesAreCutAroundTheColumn) {
  const std::string text = error_at(std::string(5000, 'a') + "X" + std::string(5000, 'b'), 5000);
  EXPECT_EQ(text, "a.json:1:5001: error: no\n" + std::string(72, 'a') + "X" + std::string(35, 'b') + "\n" +
                      std::string(72, ' ') + "^");
}

TEST(Diagnostics, ControlCharactersDoNotReachTheTerminal) {
  EXPECT_EQ(error_at("\x1b[2J", 0), "a.json:1:1: error: no\n?[2J\n^");
  // Of 8 bits too, alone or in UTF-8; what no text has; but not letters.
  EXPECT_EQ(error_at("\x9b"
                     "2J \xc2\x9b"
                     "2J \xff \xc3\xa9",
                     0),
            "a.json:1:1: error: no\n?2J ?2J ? \xc3\xa9\n^");
}

TEST(Diagnostics, WholeFileAndNoFile) {
  EXPECT_EQ(error_at("", SourcePosition::kWholeFile), "a.json: error: no");
  EXPECT_EQ(format({Diagnostic::Severity::warning, ErrorCode::scene, {}, "dark"}), "warning: dark");
}

TEST(Diagnostics, CollectsAllAndLimitsTheText) {
  Diagnostics diagnostics;
  diagnostics.warning({}, "w");
  EXPECT_FALSE(diagnostics.has_errors());
  EXPECT_EQ(diagnostics.code(), ErrorCode::internal);
  diagnostics.error({}, "first", ErrorCode::input);
  for (int i = 0; i < 24; ++i) diagnostics.error({}, "e");
  EXPECT_EQ(diagnostics.code(), ErrorCode::input);
  EXPECT_EQ(diagnostics.all().size(), 26U);
  EXPECT_EQ(diagnostics.text(2), "warning: w\nerror: first\nerror: e\nfurther errors: 23\n");
  EXPECT_EQ(Diagnostics().text(), "");
}

TEST(Diagnostics, StrictnessMakesErrorsOfDoubts) {
  Diagnostics lenient;
  lenient.error_if_strict({}, "open");
  EXPECT_FALSE(lenient.has_errors());
  EXPECT_EQ(lenient.text(), "warning: open\n");
  Diagnostics strict(Strictness::strict);
  strict.error_if_strict({}, "open");
  strict.warning({}, "dark");
  EXPECT_EQ(strict.code(), ErrorCode::scene);
  EXPECT_EQ(strict.text(), "error: open\nwarning: dark\n");
}

TEST(NearestName, KnownAnswers) {
  const std::vector<std::string> names{"samples", "seed", "N-BK7", "N-SF11"};
  EXPECT_EQ(nearest_name("sampels", names), "samples");
  EXPECT_EQ(nearest_name("n-bk7", names), "N-BK7");
  EXPECT_EQ(nearest_name("N-SF10", names), "N-SF11");
  EXPECT_EQ(nearest_name("wavelength", names), std::nullopt);
  EXPECT_EQ(nearest_name("", names), std::nullopt);
}

TEST(NearestName, UnknownNameSuggestsOrLists) {
  const std::vector<std::string> names{"A", "D65"};
  EXPECT_EQ(unknown_name("illuminant", "D66", names), "unknown illuminant \"D66\"; did you mean \"D65\"?");
  EXPECT_EQ(unknown_name("illuminant", "candle", names), "unknown illuminant \"candle\"; known: A, D65");
  EXPECT_EQ(unknown_name("x", "y", std::vector<std::string>(13, "long name")), "unknown x \"y\"");
}

}  // namespace
}  // namespace abbe
