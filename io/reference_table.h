#pragma once

#include <string>
#include <string_view>

#include "io/table.h"

namespace abbe {

/// A table of reference values from `data/reference`, accessed by column name. Validation compares computed
/// values with it. Its functions throw Error{input} for a missing table, row, column or number.
class ReferenceTable {
 public:
  explicit ReferenceTable(const std::string& name);

  [[nodiscard]] std::size_t rows() const { return table_.rows.size(); }
  [[nodiscard]] const std::string& text(std::size_t row, std::string_view column) const;
  [[nodiscard]] double number(std::size_t row, std::string_view column) const;

 private:
  std::string name_;
  Table table_;
};

}  // namespace abbe
