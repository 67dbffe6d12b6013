#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "tests/source_tree.h"

namespace abbe {
namespace {

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(References, EveryCitationInTheCodeIsInTheBibliography) {
  const std::filesystem::path root = test::source_tree();
  std::set<std::string> known;
  const std::string bibliography = contents(root / "docs" / "references.bib");
  const std::regex entry(R"(@\w+\{(\w+),)");
  for (std::sregex_iterator it(bibliography.begin(), bibliography.end(), entry), end; it != end; ++it)
    known.insert((*it)[1]);
  ASSERT_FALSE(known.empty());
  const std::regex citation(R"(\[([A-Z][A-Za-z]+\d{2,4})(,[^\]]*)?\])");
  for (const auto& folder : std::filesystem::directory_iterator(root)) {
    if (!std::filesystem::exists(folder.path() / "CMakeLists.txt") && folder.path().filename() != "docs")
      continue;
    if (folder.path().filename() == "tests") continue;
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder)) {
      const std::string extension = file.path().extension();
      if (extension != ".h" && extension != ".cpp" && extension != ".md") continue;
      const std::string text = contents(file.path());
      for (std::sregex_iterator it(text.begin(), text.end(), citation), end; it != end; ++it)
        EXPECT_TRUE(known.contains((*it)[1])) << file.path() << " cites [" << (*it)[1] << "]";
    }
  }
}

}  // namespace
}  // namespace abbe
