#include "io/json.h"

#include <gtest/gtest.h>

#include "test_files.h"

namespace abbe {
namespace {

std::optional<JsonValue> read(const std::string& text, Diagnostics& diagnostics) {
  return parse_yaml(source(text), diagnostics);
}

// The first complaint about `text`: "offset message".
std::string first_complaint(const std::string& text) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read(text, diagnostics)) << text.substr(0, 80);
  if (!diagnostics.has_errors()) return "nothing";
  EXPECT_EQ(diagnostics.code(), ErrorCode::input);
  const Diagnostic& first = diagnostics.all().front();
  return std::to_string(first.where.offset) + ' ' + first.message;
}

TEST(Yaml, GivesScalarsAsTheyAreWrittenWithTheirPlaces) {
  const std::string text =
      "# c\nA: 0.3 2.5\nB:\n  - type: 'q'\n    data: |\n      1 2\n      3 4\n  - {n: 1e-3, none: }\n";
  for (const std::string& mark : {std::string(), std::string("\xef\xbb\xbf")}) {
    Diagnostics diagnostics;
    const auto root = read(mark + text, diagnostics);
    ASSERT_TRUE(root) << diagnostics.text();
    EXPECT_EQ(std::get<std::string>(root->find("A")->value), "0.3 2.5");
    EXPECT_EQ(root->find("A")->where.offset, mark.size() + text.find("0.3"));
    EXPECT_EQ(root->find("B")->key_offset, mark.size() + text.find("B:"));
    const auto& blocks = std::get<JsonValue::Array>(root->find("B")->value);
    ASSERT_EQ(blocks.size(), 2U);
    EXPECT_EQ(std::get<std::string>(blocks[0].find("type")->value), "q");
    EXPECT_EQ(std::get<std::string>(blocks[0].find("data")->value), "1 2\n3 4\n");
    EXPECT_EQ(blocks[0].find("data")->where.offset, mark.size() + text.find('|'));
    EXPECT_EQ(std::get<std::string>(blocks[1].find("n")->value), "1e-3");
    EXPECT_EQ(blocks[1].find("n")->where.pointer, "/B/1/n");
    EXPECT_EQ(blocks[1].find("none")->type_name(), "null");
  }
}

TEST(Yaml, RefusesWhatIsNoSingleDocument) {
  EXPECT_EQ(first_complaint(""), "0 expected a value (got an empty text)");
  EXPECT_EQ(first_complaint("# nothing\n"), "0 expected a value (got an empty text)");
  EXPECT_EQ(first_complaint("a: 1\n---\nb: 2\n"), "5 expected the end of the text (got another document)");
  EXPECT_EQ(first_complaint("a: [1, 2\n").substr(0, 12), "9 not YAML: ");
  EXPECT_EQ(first_complaint("a: 1\nb: 2\na: 3\n"), "10 duplicate key \"a\"");
  EXPECT_EQ(first_complaint("? [1]\n: 2\n"), "2 expected a word as a key");
}

// Nine lines of aliases stand for 10^9 values.
TEST(Yaml, RefusesAnchorsAndAliases) {
  const std::string refusal = "anchors and aliases are not read; write the value out";
  EXPECT_EQ(first_complaint("a: &x [1, 1]\nb: [*x, *x]\n"), "3 " + refusal);
  EXPECT_EQ(first_complaint("&x a: 1\n"), "0 " + refusal);
  EXPECT_EQ(first_complaint("a: &x 1\n"), "3 " + refusal);
}

TEST(Yaml, HasLimits) {
  std::string deep, many, sequences;
  for (int i = 0; i < 300; ++i) deep = '[' + deep + ']';
  EXPECT_EQ(first_complaint(deep), "256 nesting too deep (allowed 256 levels)");
  for (int i = 0; i < 100000; ++i) sequences += "- ";
  EXPECT_EQ(first_complaint(sequences), "512 nesting too deep (allowed 256 levels)");
  for (std::size_t i = 0; i < kMaxYamlValues; ++i) many += "-\n";
  EXPECT_EQ(first_complaint(many).substr(0, 7), "200000 ");
  many.resize(many.size() - 2);
  Diagnostics diagnostics;
  EXPECT_TRUE(read(many, diagnostics)) << diagnostics.text();
}

}  // namespace
}  // namespace abbe
