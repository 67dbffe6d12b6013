#include "io/reference_table.h"

#include <utility>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "io/text.h"

namespace abbe {

ReferenceTable::ReferenceTable(const std::string& name) : name_(name) {
  Diagnostics diagnostics;
  auto table =
      read_table(data_directory() / "reference" / (name + ".csv"), TableOrigin::shipped, diagnostics);
  if (!table) throw Error(ErrorCode::input, name, diagnostics.text());
  table_ = *std::move(table);
}

const std::string& ReferenceTable::text(std::size_t row, std::string_view column) const {
  const std::optional<std::size_t> at = table_.column(column);
  if (!at || row >= rows())
    throw Error(ErrorCode::input, name_, fmt::format("no row {} of a column \"{}\"", row, column));
  return table_.rows[row][*at];
}

double ReferenceTable::number(std::size_t row, std::string_view column) const {
  const std::string& cell = text(row, column);
  const std::optional<double> value = parse_number(cell);
  if (!value)
    throw Error(ErrorCode::input, name_,
                fmt::format("expected a number in row {} of {} (got \"{}\")", row, column, cell));
  return *value;
}

}  // namespace abbe
