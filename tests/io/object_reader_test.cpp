#include "io/object_reader.h"

#include <gtest/gtest.h>

#include "test_files.h"

namespace abbe {
namespace {

/// One JSON object under a reader, and what the reader complained about, first lines only.
class Reading {
 public:
  explicit Reading(const std::string& text)
      : root_(*parse_json(source(text), diagnostics_)), reader(root_, diagnostics_) {}

  [[nodiscard]] std::string complaints() const {
    std::string all;
    for (const Diagnostic& diagnostic : diagnostics_.all()) {
      const std::string text = format(diagnostic);
      all += text.substr(0, text.find('\n')) + '\n';
    }
    return all;
  }

 private:
  Diagnostics diagnostics_;
  JsonValue root_;

 public:
  ObjectReader reader;
};

TEST(Range, TextAndBounds) {
  EXPECT_EQ((Range{0, 180, true, true}.text()), "(0, 180)");
  EXPECT_EQ(Range::non_negative().text(), "[0, inf)");
  EXPECT_EQ(Range::positive().text(), "(0, inf)");
  EXPECT_EQ(Range::unit().text(), "[0, 1]");
  EXPECT_EQ(Range::any().text(), "(-inf, inf)");
  EXPECT_FALSE(Range::positive().contains(0));
  EXPECT_TRUE(Range::non_negative().contains(0));
  EXPECT_FALSE((Range{0, 180, true, true}.contains(180)));
  EXPECT_TRUE(Range::unit().contains(1));
}

TEST(ObjectReader, ReadsWhatIsThereAndDefaultsWhatIsNot) {
  Reading r(R"({"x": 2.5, "n": 7, "s": "t", "b": true, "v": [1, 2, 3]})");
  EXPECT_EQ(r.reader.number("x"), 2.5);
  EXPECT_EQ(r.reader.require_number("x", Range::positive()), 2.5);
  EXPECT_EQ(r.reader.number_or("y", 9), 9);
  EXPECT_EQ(r.reader.integer("n", {1}), 7);
  EXPECT_EQ(r.reader.string("s"), "t");
  EXPECT_TRUE(r.reader.boolean_or("b", false));
  EXPECT_TRUE(r.reader.boolean_or("c", true));
  EXPECT_EQ(r.reader.require_numbers("v", 3), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(r.reader.numbers("w", 3), std::nullopt);
  EXPECT_EQ(r.reader.exactly_one({"x", "other"}), "x");
  r.reader.finish();
  EXPECT_EQ(r.complaints(), "");
}

TEST(ObjectReader, UnknownKeysPointAtTheKeyWithTheNearestName) {
  Reading r("{\"$schema\": \"x\",\n  \"sampels\": 4}");
  EXPECT_EQ(r.reader.integer("samples", {1}), std::nullopt);
  r.reader.finish();
  EXPECT_EQ(r.complaints(),
            "a.json:2:3: /sampels: error: unknown key \"sampels\"; did you mean \"samples\"?\n");
}

TEST(ObjectReader, WrongTypesSayWhatWasThere) {
  Reading r(R"({"x": "abc", "s": 3, "b": null, "v": {}, "o": [1], "w": [1, "q"]})");
  EXPECT_EQ(r.reader.number("x", Range::positive()), std::nullopt);
  EXPECT_EQ(r.reader.string("s"), std::nullopt);
  EXPECT_TRUE(r.reader.boolean_or("b", true));
  EXPECT_EQ(r.reader.numbers("v", 3), std::nullopt);
  EXPECT_EQ(r.reader.numbers("o", 3), std::nullopt);
  EXPECT_EQ(r.reader.numbers("w", 0), std::nullopt);
  EXPECT_EQ(r.complaints(),
            "a.json:1:7: /x: error: expected a number (got \"abc\", allowed (0, inf))\n"
            "a.json:1:19: /s: error: expected a string (got 3, allowed text in double quotes)\n"
            "a.json:1:27: /b: error: expected a boolean (got null, allowed true or false)\n"
            "a.json:1:38: /v: error: expected an array of numbers (got an object, allowed (-inf, inf))\n"
            "a.json:1:47: /o: error: wrong number of elements (got 1, allowed 3)\n"
            "a.json:1:61: /w/1: error: expected a number (got \"q\", allowed (-inf, inf))\n");
}

TEST(ObjectReader, NumbersOutOfRange) {
  Reading r(R"({"fov": 190, "big": 1e300, "edge": 180})");
  EXPECT_EQ(r.reader.number("fov", {0, 180, true, true}), std::nullopt);
  EXPECT_EQ(r.reader.number("big"), std::nullopt);
  EXPECT_EQ(r.reader.number("edge", {0, 180, true, true}), std::nullopt);
  EXPECT_EQ(
      r.complaints(),
      "a.json:1:9: /fov: error: expected a number (got 190, allowed (0, 180))\n"
      "a.json:1:21: /big: error: expected a number of single precision (got 1e+300, allowed magnitudes to "
      "3.40282e+38)\n"
      "a.json:1:36: /edge: error: expected a number (got 180, allowed (0, 180))\n");
}

TEST(ObjectReader, CountsAreWholeAndInRange) {
  Reading r(R"({"a": 3.5, "b": -5, "c": 1e300, "d": 9007199254740992})");
  EXPECT_EQ(r.reader.integer("a", {1}), std::nullopt);
  EXPECT_EQ(r.reader.integer("b", {1}), std::nullopt);
  EXPECT_EQ(r.reader.integer("c", {1}), std::nullopt);
  EXPECT_EQ(r.reader.integer("d", {1}), std::int64_t{9007199254740992});
  EXPECT_EQ(
      r.complaints(),
      "a.json:1:7: /a: error: expected an integer (got 3.5, allowed [1, inf))\n"
      "a.json:1:17: /b: error: expected an integer (got -5, allowed [1, inf))\n"
      "a.json:1:26: /c: error: expected an integer (got 1e+300, allowed magnitudes to 9007199254740992)\n");
}

TEST(ObjectReader, MissingAndExclusiveKeys) {
  Reading r(R"({"quad": {}, "disc": {}})");
  EXPECT_EQ(r.reader.require("from"), nullptr);
  EXPECT_EQ(r.reader.exactly_one({"quad", "disc"}), std::nullopt);
  EXPECT_EQ(r.reader.exactly_one({"sphere", "mesh"}), std::nullopt);
  r.reader.finish();
  EXPECT_EQ(r.complaints(),
            "a.json:1:1: error: missing key \"from\"\n"
            "a.json:1:1: error: expected exactly one key (got quad, disc, allowed quad, disc)\n"
            "a.json:1:1: error: expected exactly one key (got none, allowed sphere, mesh)\n");
}

TEST(ObjectReader, ChoicesAreNumberedFromZero) {
  Reading r(R"({"a": "mm", "b": "mmn", "c": 1})");
  Diagnostics diagnostics;
  const auto choice = [&](const char* key) {
    return read_choice(*r.reader.find(key), "unit", {"m", "mm"}, diagnostics);
  };
  EXPECT_EQ(choice("a"), 1U);
  EXPECT_EQ(choice("b"), std::nullopt);
  EXPECT_EQ(choice("c"), std::nullopt);
  ASSERT_EQ(diagnostics.all().size(), 2U);
  EXPECT_EQ(diagnostics.all()[0].message, "unknown unit \"mmn\"; did you mean \"mm\"?");
  EXPECT_EQ(diagnostics.all()[1].message, "expected a string (got 1, allowed text in double quotes)");
}

TEST(ObjectReader, TheKeyThatWasMeantInsteadOfNone) {
  Reading r(R"({"material": "m", "shpere": {}})");
  EXPECT_EQ(r.reader.exactly_one({"sphere", "mesh"}), std::nullopt);
  EXPECT_EQ(r.complaints(),
            "a.json:1:19: /shpere: error: unknown key \"shpere\"; did you mean \"sphere\"?\n");
}

TEST(ObjectReader, NoObjectIsReportedOnce) {
  Reading r("[1]");
  EXPECT_EQ(r.reader.require("a"), nullptr);
  EXPECT_EQ(r.reader.require_string("b"), std::nullopt);
  EXPECT_EQ(r.reader.exactly_one({"a", "b"}), std::nullopt);
  r.reader.finish();
  EXPECT_EQ(r.complaints(), "a.json:1:1: error: expected an object (got an array, allowed {...})\n");
}

}  // namespace
}  // namespace abbe
