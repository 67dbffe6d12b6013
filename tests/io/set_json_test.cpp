#include <gtest/gtest.h>

#include "io/json_values.h"
#include "test_files.h"

namespace abbe {
namespace {

class SetJson : public testing::Test {
 protected:
  SetJson() {
    Diagnostics diagnostics;
    root_ = *parse_json(source(R"({"render": {"samples": 4}, "list": [1, 2], "none": null})"), diagnostics);
  }

  /// The complaints of setting `text` at `pointer`.
  std::string set(std::string_view pointer, std::string_view text) {
    Diagnostics diagnostics;
    set_json(root_, pointer, text, diagnostics);
    EXPECT_TRUE(!diagnostics.has_errors() || diagnostics.code() == ErrorCode::usage);
    return diagnostics.text();
  }

  JsonValue root_;
};

TEST_F(SetJson, ReplacesAndKeepsTheRest) {
  EXPECT_EQ(set("/render/samples", "16"), "");
  EXPECT_EQ(std::get<double>(root_.find("render")->find("samples")->value), 16);
  EXPECT_EQ(set("/list/1", "{\"a\": true}"), "");
  const auto& list = std::get<JsonValue::Array>(root_.find("list")->value);
  EXPECT_EQ(std::get<double>(list[0].value), 1);
  EXPECT_EQ(list[1].find("a")->where.pointer, "/list/1/a");
}

TEST_F(SetJson, RefusesWhatNoFileMayHold) {
  EXPECT_EQ(set("/render/name", "\xff"), "error: --set: invalid UTF-8\n");
  EXPECT_EQ(set("/render/\xff", "1"), "error: --set: invalid UTF-8\n");
}

TEST_F(SetJson, CreatesTheObjectsOnTheWay) {
  EXPECT_EQ(set("/output/display/a~1b", "x"), "");
  const JsonValue& display = *root_.find("output")->find("display");
  EXPECT_EQ(display.where.pointer, "/output/display");
  EXPECT_EQ(std::get<std::string>(display.find("a/b")->value), "x");
  EXPECT_EQ(set("/list/-", "3"), "");
  EXPECT_EQ(set("/list/3", "4"), "");
  EXPECT_EQ(std::get<JsonValue::Array>(root_.find("list")->value).size(), 4U);
}

TEST_F(SetJson, BareWordsAndPathsAreStrings) {
  for (const char* text : {"D65", "out/prism.exr", "2024/x.csv", "N-BK7", ""}) {
    EXPECT_EQ(set("/word", text), "");
    EXPECT_EQ(std::get<std::string>(root_.find("word")->value), text);
  }
  EXPECT_EQ(set("/word", "\"16\""), "");
  EXPECT_EQ(std::get<std::string>(root_.find("word")->value), "16");
}

TEST_F(SetJson, ReportsWhereThereIsNoWay) {
  for (const char* pointer :
       {"/render/samples/x", "/none/x", "/list/9", "/list/x", "/list/01x", "/list/01", "render"})
    EXPECT_EQ(set(pointer, "1"),
              std::string("--set:1:1: ") + pointer + ": error: no value can be set at this pointer\n1\n^\n");
  EXPECT_EQ(set("/list", "[1, 2"),
            "--set:1:6: /list: error: expected ',' or ']' (got the end of the text)\n[1, 2\n     ^\n");
  EXPECT_EQ(std::get<JsonValue::Array>(root_.find("list")->value).size(), 2U);
}

TEST_F(SetJson, LaterComplaintsNameTheOption) {
  EXPECT_EQ(set("/render/samples", "many"), "");
  Diagnostics diagnostics;
  EXPECT_EQ(read_integer(*root_.find("render")->find("samples"), {1}, diagnostics), std::nullopt);
  EXPECT_EQ(
      diagnostics.text(),
      "--set:1:1: /render/samples: error: expected an integer (got \"many\", allowed [1, inf))\nmany\n^\n");
}

}  // namespace
}  // namespace abbe
