#pragma once

#include <string>
#include <string_view>

#include "io/table.h"

namespace abbe {

/// A table of known answers from `data/reference`, read by column name: what the program's own figures are
/// compared with. Throws Error{input} for a table, row, column or number that is not there.
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
