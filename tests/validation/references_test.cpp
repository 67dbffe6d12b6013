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
  for (const char* folder :
       {"io", "sampling", "spectral", "materials", "lens", "sensor", "scene", "description", "transport",
        "calibration", "film", "develop", "validation", "cli", "preview", "docs"})
    for (const auto& file : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string extension = file.path().extension();
      if (extension != ".h" && extension != ".cpp" && extension != ".md") continue;
      const std::string text = contents(file.path());
      for (std::sregex_iterator it(text.begin(), text.end(), citation), end; it != end; ++it)
        EXPECT_TRUE(known.contains((*it)[1])) << file.path() << " cites [" << (*it)[1] << "]";
    }
}

}  // namespace
}  // namespace abbe
