#include "io/json.h"

#include <gtest/gtest.h>

#include "test_files.h"

namespace abbe {
namespace {

JsonValue parsed(const std::string& text) {
  Diagnostics diagnostics;
  auto value = parse_json(source(text), diagnostics);
  EXPECT_EQ(diagnostics.text(), "");
  return value ? std::move(*value) : JsonValue{};
}

TEST(Json, ReadsEveryKindWithCommentsAndTrailingCommas) {
  const JsonValue root =
      parsed("// c\n{\"a\": [1.5, -2e3, true, false, null,], /* c */ \"b\": {\"s\": \"\\u00e9\\n\"},}");
  ASSERT_EQ(root.type_name(), "an object");
  const auto& a = std::get<JsonValue::Array>(root.find("a")->value);
  ASSERT_EQ(a.size(), 5U);
  EXPECT_EQ(std::get<double>(a[0].value), 1.5);
  EXPECT_EQ(std::get<double>(a[1].value), -2000);
  EXPECT_TRUE(std::get<bool>(a[2].value));
  EXPECT_FALSE(std::get<bool>(a[3].value));
  EXPECT_EQ(a[4].type_name(), "null");
  EXPECT_EQ(std::get<std::string>(root.find("b")->find("s")->value), "é\n");
  EXPECT_EQ(root.find("c"), nullptr);
  EXPECT_EQ(a[0].find("x"), nullptr);
}

TEST(Json, NumbersAreCorrectlyRounded) {
  EXPECT_EQ(std::get<double>(parsed("0.1000000000000000055511151231257827").value), 0.1);
  EXPECT_EQ(std::get<double>(parsed("9007199254740993").value), 9007199254740992.0);
  EXPECT_EQ(std::get<double>(parsed("5e-324").value), 5e-324);
}

TEST(Json, EveryValueAndKeyKnowsWhereItBegins) {
  const std::string text = "{ \"k\" : [ 12.5 , \"s\\\"t\", true , false,null, {\"q/~\": -1}, [] ] }";
  const JsonValue root = parsed(text);
  EXPECT_EQ(root.where.offset, 0U);
  const JsonValue& k = *root.find("k");
  EXPECT_EQ(k.key_offset, text.find("\"k\""));
  EXPECT_EQ(k.where.offset, text.find('['));
  EXPECT_EQ(k.where.pointer, "/k");
  const auto& items = std::get<JsonValue::Array>(k.value);
  const char* const begins[] = {"12.5", "\"s", "true", "false", "null", "{\"q", "[]"};
  ASSERT_EQ(items.size(), std::size(begins));
  for (std::size_t i = 0; i < items.size(); ++i) {
    EXPECT_EQ(items[i].where.offset, text.find(begins[i])) << begins[i];
    EXPECT_EQ(items[i].where.pointer, "/k/" + std::to_string(i));
  }
  const JsonValue& q = *items[5].find("q/~");
  EXPECT_EQ(q.where.offset, text.find("-1"));
  EXPECT_EQ(q.where.pointer, "/k/5/q~1~0");
  EXPECT_EQ(q.key_position().offset, text.find("\"q"));
}

TEST(JsonFaults, TruncatedAndEmpty) {
  EXPECT_EQ(complaint(""), "a.json:1:1: error: expected a value (got an empty text)\n\n^\n");
  EXPECT_EQ(complaint(" \n"), "a.json:1:1: error: expected a value (got an empty text)\n \n^\n");
  EXPECT_EQ(complaint("{\"a\": [1, 2"),
            "a.json:1:12: /a: error: expected ',' or ']' (got the end of the text)\n"
            "{\"a\": [1, 2\n           ^\n");
  EXPECT_EQ(complaint("{\"a\":"),
            "a.json:1:6: error: expected a value (got the end of the text)\n{\"a\":\n     ^\n");
  EXPECT_EQ(
      complaint("[\"ab"),
      "a.json:1:5: error: expected '\"' at the end of the string (got the end of the text)\n[\"ab\n    ^\n");
  EXPECT_EQ(complaint("/* x"),
            "a.json:1:5: error: expected a complete comment (got the end of the text)\n/* x\n    ^\n");
}

TEST(JsonFaults, EveryPrefixOfAFileIsReported) {
  const std::string text = R"({"abbe": 1, "s": [{"quad": "x\u00e9", "e": -1.5e3}, null, true]})";
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_NE(complaint(text.substr(0, size)), "") << size;
  EXPECT_EQ(complaint(text), "");
}

TEST(JsonFaults, TrailingBytes) {
  EXPECT_EQ(complaint("{}\n{}"), "a.json:2:1: error: expected the end of the text (got {)\n{}\n^\n");
  EXPECT_EQ(complaint(std::string("{}\0 x", 5)), "a.json:1:3: error: NUL byte in a text\n{}? x\n  ^\n");
}

TEST(JsonFaults, DuplicateKeysPointAtTheSecond) {
  EXPECT_EQ(complaint("{\"a\": 1,\n \"b\": 2,\n \"a\": 3}"),
            "a.json:3:2: /a: error: duplicate key \"a\"\n \"a\": 3}\n ^\n");
  EXPECT_EQ(complaint("[{\"a\": 1}, {\"a\": 1}]"), "");
}

TEST(JsonFaults, NotFinite) {
  EXPECT_EQ(complaint("{\"a\": NaN}"),
            "a.json:1:7: error: expected a value (got NaN, allowed finite numbers)\n{\"a\": NaN}\n      ^\n");
  EXPECT_EQ(complaint("[-Infinity]"),
            "a.json:1:2: error: expected a value (got -Infinity, allowed finite numbers)\n[-Infinity]\n ^\n");
  EXPECT_EQ(
      complaint("[1e400]"),
      "a.json:1:2: error: number out of range (got 1e400, allowed magnitudes to 1.797e308)\n[1e400]\n ^\n");
  EXPECT_EQ(complaint("[1, 1.8e308]"),
            "a.json:1:5: /1: error: number out of range (got 1.8e308, allowed magnitudes "
            "from 4.94e-324 to 1.797e308)\n[1, 1.8e308]\n    ^\n");
}

TEST(JsonFaults, GrammarNamesWhatWasExpected) {
  EXPECT_EQ(complaint("{a: 1}"),
            "a.json:1:2: error: expected a key in double quotes or '}' (got a)\n{a: 1}\n ^\n");
  EXPECT_EQ(complaint("{\"a\" 1}"), "a.json:1:6: error: expected ':' (got 1)\n{\"a\" 1}\n     ^\n");
  EXPECT_EQ(complaint("[1 2]"), "a.json:1:4: error: expected ',' or ']' (got 2)\n[1 2]\n   ^\n");
  EXPECT_EQ(complaint("[nul]"), "a.json:1:2: error: expected a value (got nul)\n[nul]\n ^\n");
  EXPECT_EQ(complaint("[λ]"), "a.json:1:2: error: expected a value (got λ)\n[λ]\n ^\n");
  EXPECT_EQ(complaint("[\"\\x\"]"),
            "a.json:1:3: error: expected a printable character or a JSON escape (got \\)\n[\"\\x\"]\n  ^\n");
  EXPECT_EQ(complaint("[1.]"),
            "a.json:1:4: error: expected a digit after the decimal point (got ])\n[1.]\n   ^\n");
}

TEST(JsonFaults, StringsHoldText) {
  EXPECT_EQ(complaint(R"(["\u0000"])"),
            "a.json:1:2: error: invalid string (got NUL or half a surrogate pair)\n"
            "[\"\\u0000\"]\n ^\n");
  EXPECT_NE(complaint(R"(["\udc00"])"), "");
  EXPECT_NE(complaint(R"(["\ud800"])"), "");
  EXPECT_EQ(complaint(R"(["\ud834\udd1e"])"), "");
}

TEST(JsonFaults, DepthIsLimitedBeforeAnyStack) {
  EXPECT_EQ(complaint(std::string(256, '[') + std::string(256, ']')), "");
  const std::string deep = complaint(std::string(257, '[') + std::string(257, ']'));
  EXPECT_TRUE(deep.starts_with("a.json:1:257: error: nesting too deep (allowed 256 levels)\n")) << deep;
  EXPECT_EQ(complaint(std::string(1000000, '[')).substr(0, 60), deep.substr(0, 60));
  std::string objects;
  for (int i = 0; i < 1000000; ++i) objects += "{\"a\":";
  EXPECT_NE(complaint(objects).find("nesting too deep"), std::string::npos);
}

TEST(JsonFaults, PathsAreLimited) {
  const std::string long_key(1100, 'k');
  EXPECT_NE(
      complaint("{\"" + long_key + "\": 1}").find("keys too long (got a path of 1101 bytes, allowed 1024)"),
      std::string::npos);
}

TEST(Json, TheTextOfAValueReadsBackAsTheSame) {
  Diagnostics diagnostics;
  const auto value = parse_json(source(R"({"a": [1, 0.1, -2.5e-300, 16777217, true, null], // text
                 "b\"c": {"λ": "two\nlines \\ \u0001", "d": {}, "e": []}})"),
                                diagnostics);
  ASSERT_TRUE(value) << diagnostics.text();
  const std::string text = to_text(*value);
  EXPECT_EQ(
      text,
      R"({"a":[1,0.1,-2.5e-300,16777217,true,null],"b\"c":{"λ":"two\nlines \\ \u0001","d":{},"e":[]}})");
  const auto again = parse_json(source(text), diagnostics);
  ASSERT_TRUE(again) << diagnostics.text();
  EXPECT_EQ(to_text(*again), text);
}

}  // namespace
}  // namespace abbe
