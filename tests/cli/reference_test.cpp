#include "cli/help.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/source_tree.h"

namespace abbe::cli {
namespace {

const CommandUsage kProgram{"tool",
                            "Does things",
                            {{{"-h", "--help"}, "", "Print this", false}},
                            {{"tool cut",
                              "Cuts",
                              {{{}, "SCENE", ".hidden \\ part", true},
                               {{}, "KEY", "Key", false},
                               {{}, "COMMAND|all", "Command", false},
                               {{"-w", "--with"}, "saw|axe", "Saw|axe", true},
                               {{"--dry"}, "", "'Only' think", false}},
                              {}}}};

bool has_line(const std::string& page, const std::string& line) {
  return ('\n' + page).find('\n' + line + '\n') != std::string::npos;
}

TEST(Reference, MarkdownKeepsBarsInTheirCells) {
  const std::string page = reference(kProgram, ReferenceFormat::markdown);
  EXPECT_TRUE(has_line(page, "## tool cut")) << page;
  EXPECT_TRUE(has_line(page, "tool cut SCENE [KEY] [COMMAND|all] --with saw|axe [OPTION...]")) << page;
  EXPECT_TRUE(has_line(page, "| `-w, --with saw\\|axe` | Saw\\|axe; required |")) << page;
  EXPECT_TRUE(has_line(page, "| `--dry` | 'Only' think |")) << page;
  EXPECT_EQ(page.find("| `-h"), std::string::npos) << page;  // mentioned once for all
}

TEST(Reference, ManTakesTextForText) {
  const std::string page = reference(kProgram, ReferenceFormat::man);
  EXPECT_TRUE(has_line(page, ".SS \"tool cut SCENE [KEY] [COMMAND|all] \\-\\-with saw|axe [OPTION...]\""))
      << page;
  EXPECT_TRUE(has_line(page, "\\&.hidden \\e part.")) << page;
  EXPECT_TRUE(has_line(page, "\\fB\\-w, \\-\\-with saw|axe\\fR")) << page;
  EXPECT_TRUE(has_line(page, "\\&'Only' think.")) << page;
}

TEST(Reference, CompletionKnowsWhatValuesAre) {
  const std::string script = reference(kProgram, ReferenceFormat::bash);
  EXPECT_TRUE(has_line(script, "    'tool') commands='cut' options='--help' ;;")) << script;
  EXPECT_TRUE(has_line(script, "    'tool cut') commands='' options='--with --dry' ;;")) << script;
  EXPECT_TRUE(has_line(script, "    'tool cut 1') kind='files json' ;;")) << script;
  EXPECT_TRUE(has_line(script, "    'tool cut -w' | 'tool cut --with') kind='words saw axe' ;;")) << script;
  EXPECT_NE(script.find("    'tool cut 2') kind='words $schema "), std::string::npos) << script;
  EXPECT_TRUE(has_line(script, "    'tool cut 3') kind='words all cut' ;;")) << script;
  EXPECT_EQ(script.find("--dry')"), std::string::npos) << script;  // takes no value
}

TEST(Help, TellsTheDocumentedJobs) {
  const std::string all = test::abbe("help slurm").out;
  for (const std::string name : {"render.sbatch", "merge.sbatch", "submit.sh"}) {
    const std::string job = test::read_file(test::source_tree() / "docs/guide/slurm" / name);
    EXPECT_EQ(test::abbe("help slurm " + name).out, job);
    EXPECT_NE(all.find(fmt::format("\n{}:\n{}", name, job)), std::string::npos) << all;
  }
  const test::Outcome unknown = test::abbe("help slurm render.sbatsh");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("did you mean \"render.sbatch\""), std::string::npos) << unknown.err;
}

}  // namespace
}  // namespace abbe::cli
