#include "cli/reference.h"

#include <gtest/gtest.h>

namespace abbe::cli {
namespace {

const CommandUsage kProgram{"tool",
                            "Does things",
                            {{{"-h", "--help"}, "", "Print this", false}},
                            {{"tool cut",
                              "Cuts",
                              {{{}, "SCENE", ".hidden \\ part", true},
                               {{"-w", "--with"}, "saw|axe", "Saw|axe", true},
                               {{"--dry"}, "", "'Only' think", false}},
                              {}}}};

void expect_line(const std::string& page, const std::string& line) {
  EXPECT_NE(('\n' + page).find('\n' + line + '\n'), std::string::npos) << line << "\nin\n" << page;
}

TEST(Reference, MarkdownKeepsBarsInTheirCells) {
  const std::string page = reference(kProgram, ReferenceFormat::markdown);
  expect_line(page, "## tool cut");
  expect_line(page, "tool cut SCENE --with saw|axe [OPTION...]");
  expect_line(page, "| `-w, --with saw\\|axe` | Saw\\|axe; required |");
  expect_line(page, "| `--dry` | 'Only' think |");
  EXPECT_EQ(page.find("| `-h"), std::string::npos) << page;  // said once for all
}

TEST(Reference, ManTakesTextForText) {
  const std::string page = reference(kProgram, ReferenceFormat::man);
  expect_line(page, ".SS \"tool cut SCENE \\-\\-with saw|axe [OPTION...]\"");
  expect_line(page, "\\&.hidden \\e part.");
  expect_line(page, "\\fB\\-w, \\-\\-with saw|axe\\fR");
  expect_line(page, "\\&'Only' think.");
}

TEST(Reference, CompletionKnowsWhatValuesAre) {
  const std::string script = reference(kProgram, ReferenceFormat::bash);
  expect_line(script, "    'tool') commands='cut' options='--help' ;;");
  expect_line(script, "    'tool cut') commands='' options='--with --dry' ;;");
  expect_line(script, "    'tool cut 1') kind='files json' ;;");
  expect_line(script, "    'tool cut -w' | 'tool cut --with') kind='words saw axe' ;;");
  EXPECT_EQ(script.find("--dry')"), std::string::npos) << script;  // takes no value
}

}  // namespace
}  // namespace abbe::cli
