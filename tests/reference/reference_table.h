#pragma once

#include <gtest/gtest.h>

#include <string>

#include "io/data_directory.h"
#include "io/table.h"

namespace abbe::test {

/// A table of known answers from `tests/reference`, read by column name.
class ReferenceTable {
 public:
  explicit ReferenceTable(const std::string& name) {
    Diagnostics diagnostics;
    const auto path = data_directory().parent_path() / "tests" / "reference" / (name + ".csv");
    auto table = read_table(path, TableOrigin::shipped, diagnostics);
    EXPECT_TRUE(table.has_value()) << diagnostics.text();
    if (table) table_ = *std::move(table);
  }

  [[nodiscard]] std::size_t rows() const { return table_.rows.size(); }
  [[nodiscard]] const std::string& text(std::size_t row, const std::string& column) const {
    return table_.rows.at(row).at(table_.column(column).value());
  }
  [[nodiscard]] double number(std::size_t row, const std::string& column) const {
    return std::stod(text(row, column));
  }

 private:
  Table table_;
};

}  // namespace abbe::test
