#pragma once

#include <string>
#include <string_view>

#include "io/table.h"

namespace abbe {

/// A table of reference values in the folder `reference` of `data_directory`, accessed by row number from 0
/// on and by column name. Validation compares computed values with it.
class ReferenceTable {
 public:
  /// Reads the file `name` + ".csv". Throws Error{input} if it is missing or malformed.
  explicit ReferenceTable(const std::string& name);

  [[nodiscard]] std::size_t rows() const { return table_.rows.size(); }
  /// The text of a cell. Throws Error{input} for a missing row or column.
  [[nodiscard]] const std::string& text(std::size_t row, std::string_view column) const;
  /// The number of a cell, in the unit that the table declares. Throws Error{input} also if it is not a
  /// finite number.
  [[nodiscard]] double number(std::size_t row, std::string_view column) const;

 private:
  std::string name_;
  Table table_;
};

}  // namespace abbe
