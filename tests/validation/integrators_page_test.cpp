#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "scene/integrators.h"
#include "tests/source_tree.h"

namespace abbe {
namespace {

TEST(IntegratorsPage, HasARowForEveryIntegrator) {
  for (const std::string name : kIntegratorNames) {
    std::ifstream page(test::source_tree() / "docs" / "reference" / "integrators.md");
    int rows = 0;
    for (std::string line; std::getline(page, line);)
      if (line.starts_with("| `" + name + "`")) ++rows;
    EXPECT_EQ(rows, 1) << name;
  }
}

}  // namespace
}  // namespace abbe
