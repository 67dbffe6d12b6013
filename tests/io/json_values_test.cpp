#include "io/json_values.h"

#include <array>

#include <gtest/gtest.h>

#include "test_files.h"

namespace abbe {
namespace {

/// A JSON value and what was complained about on reading it, first lines only.
class JsonValues : public testing::Test {
 protected:
  void parse(const std::string& text) { root_ = parse_json(source(text), diagnostics_).value(); }
  [[nodiscard]] const JsonValue& at(const char* key) const { return *root_.find(key); }
  [[nodiscard]] std::string complaints() const {
    std::string all;
    for (const Diagnostic& diagnostic : diagnostics_.all()) {
      const std::string text = format(diagnostic);
      all += text.substr(0, text.find('\n')) + '\n';
    }
    return all;
  }

  Diagnostics diagnostics_;
  JsonValue root_;
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

TEST_F(JsonValues, AreReadAsTheirTypes) {
  parse(R"({"x": 2.5, "n": 7, "s": "t", "b": true, "v": [1, 2, 3]})");
  EXPECT_EQ(read_number(at("x"), Range::positive(), diagnostics_), 2.5);
  EXPECT_EQ(read_integer(at("n"), {1}, diagnostics_), 7);
  EXPECT_EQ(read_string(at("s"), diagnostics_), "t");
  EXPECT_EQ(read_boolean(at("b"), diagnostics_), true);
  EXPECT_EQ(read_numbers(at("v"), 3, Range::any(), diagnostics_), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(read_array(at("v"), "numbers", 3, diagnostics_)->size(), 3U);
  EXPECT_EQ(read_object(root_, diagnostics_)->size(), 5U);
  EXPECT_EQ(complaints(), "");
}

TEST_F(JsonValues, OfOtherTypesSayWhatWasThere) {
  parse(R"({"x": "abc", "s": 3, "b": null, "v": {}, "o": [1], "w": [1, "q"]})");
  EXPECT_EQ(read_number(at("x"), Range::positive(), diagnostics_), std::nullopt);
  EXPECT_EQ(read_string(at("s"), diagnostics_), std::nullopt);
  EXPECT_EQ(read_boolean(at("b"), diagnostics_), std::nullopt);
  EXPECT_EQ(read_numbers(at("v"), 3, Range::any(), diagnostics_), std::nullopt);
  EXPECT_EQ(read_numbers(at("o"), 3, Range::any(), diagnostics_), std::nullopt);
  EXPECT_EQ(read_numbers(at("w"), 0, Range::any(), diagnostics_), std::nullopt);
  EXPECT_EQ(read_array(at("x"), "layers", 1, diagnostics_), nullptr);
  EXPECT_EQ(read_array(at("o"), "layers", 2, diagnostics_), nullptr);
  EXPECT_EQ(read_object(at("o"), diagnostics_), nullptr);
  EXPECT_EQ(complaints(),
            "a.json:1:7: /x: error: expected a number (got \"abc\", allowed (0, inf))\n"
            "a.json:1:19: /s: error: expected a string (got 3, allowed text in double quotes)\n"
            "a.json:1:27: /b: error: expected a boolean (got null, allowed true or false)\n"
            "a.json:1:38: /v: error: expected an array of numbers (got an object, allowed (-inf, inf))\n"
            "a.json:1:47: /o: error: wrong number of elements (got 1, allowed 3)\n"
            "a.json:1:61: /w/1: error: expected a number (got \"q\", allowed (-inf, inf))\n"
            "a.json:1:7: /x: error: expected an array of layers (got a string)\n"
            "a.json:1:47: /o: error: expected an array of layers (got 1 of them, allowed [2, inf))\n"
            "a.json:1:47: /o: error: expected an object (got an array, allowed {...})\n");
}

TEST_F(JsonValues, NumbersOutOfRange) {
  parse(R"({"fov": 190, "big": 1e300, "edge": 180})");
  EXPECT_EQ(read_number(at("fov"), {0, 180, true, true}, diagnostics_), std::nullopt);
  EXPECT_EQ(read_number(at("big"), Range::any(), diagnostics_), std::nullopt);
  EXPECT_EQ(read_number(at("edge"), {0, 180, true, true}, diagnostics_), std::nullopt);
  EXPECT_EQ(
      complaints(),
      "a.json:1:9: /fov: error: expected a number (got 190, allowed (0, 180))\n"
      "a.json:1:21: /big: error: expected a number of single precision (got 1e+300, allowed magnitudes to "
      "3.40282e+38)\n"
      "a.json:1:36: /edge: error: expected a number (got 180, allowed (0, 180))\n");
}

TEST_F(JsonValues, CountsAreWholeAndInRange) {
  parse(R"({"a": 3.5, "b": -5, "c": 1e300, "d": 9007199254740991, "e": 9007199254740993})");
  EXPECT_EQ(read_integer(at("a"), {1}, diagnostics_), std::nullopt);
  EXPECT_EQ(read_integer(at("b"), {1}, diagnostics_), std::nullopt);
  EXPECT_EQ(read_integer(at("c"), {1}, diagnostics_), std::nullopt);
  EXPECT_EQ(read_integer(at("d"), {1}, diagnostics_), std::int64_t{9007199254740991});
  EXPECT_EQ(read_integer(at("e"), {1}, diagnostics_), std::nullopt);  // a double of two numbers
  EXPECT_EQ(
      complaints(),
      "a.json:1:7: /a: error: expected an integer (got 3.5, allowed [1, inf))\n"
      "a.json:1:17: /b: error: expected an integer (got -5, allowed [1, inf))\n"
      "a.json:1:26: /c: error: expected an integer (got 1e+300, allowed magnitudes to 9007199254740991)\n"
      "a.json:1:61: /e: error: expected an integer (got 9007199254740992, allowed magnitudes to "
      "9007199254740991)\n");
}

TEST_F(JsonValues, ChoicesAreNumberedFromZero) {
  parse(R"({"a": "mm", "b": "mmn", "c": 1})");
  const auto choice = [&](const char* key) {
    return read_choice(at(key), "unit", std::array{"m", "mm"}, diagnostics_);
  };
  EXPECT_EQ(choice("a"), 1U);
  EXPECT_EQ(choice("b"), std::nullopt);
  EXPECT_EQ(choice("c"), std::nullopt);
  EXPECT_EQ(complaints(),
            "a.json:1:18: /b: error: unknown unit \"mmn\"; did you mean \"mm\"?\n"
            "a.json:1:30: /c: error: expected a string (got 1, allowed text in double quotes)\n");
}

TEST_F(JsonValues, OneOfSomeKeysIsChosen) {
  using Keys = std::vector<std::string_view>;
  parse(R"({"material": "m", "quad": {}, "disc": {}, "shpere": {}})");
  EXPECT_EQ(choose_key(root_, Keys{"quad", "cube"}, diagnostics_), "quad");
  EXPECT_EQ(choose_key(root_, Keys{"quad", "disc"}, diagnostics_), std::nullopt);
  EXPECT_EQ(choose_key(root_, Keys{"cylinder", "mesh"}, diagnostics_), std::nullopt);
  EXPECT_EQ(choose_key(root_, Keys{"sphere", "mesh"}, diagnostics_), std::nullopt);
  EXPECT_EQ(complaints(),
            "a.json:1:1: error: expected exactly one key (got quad, disc, allowed quad, disc)\n"
            "a.json:1:1: error: expected exactly one key (got none, allowed cylinder, mesh)\n"
            "a.json:1:43: /shpere: error: unknown key \"shpere\"; did you mean \"sphere\"?\n");
}

}  // namespace
}  // namespace abbe
