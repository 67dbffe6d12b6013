#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/diagnostics.h"

namespace abbe {

/// Extrapolation rule of a table, outside its first and last row.
enum class Outside {
  clamp,  ///< The value of the first or last row.
  zero,   ///< The value 0.
  error   ///< The caller reports an error.
};

/// Origin of a table's numbers, as texts. Shipped tables must declare all fields.
struct Provenance {
  std::string title;
  std::string unit;
  std::string source;
  std::string status;
  std::string processing;
};

/// A table of numbers or words. The CSV file has `# key: value` lines (title, unit, source, status,
/// processing, outside, and others), then the column names, then the rows.
struct Table {
  Provenance provenance;
  /// All `# key: value` lines above the column names, including those of `provenance`.
  std::map<std::string, std::string> keys;
  Outside outside = Outside::error;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< `rows[i][j]` is the cell of `columns[j]`.
  SourcePosition where;                        ///< Start of the table's text.
  std::vector<std::size_t> row_offsets;        ///< Byte offset of each row in its text.

  /// Index of the column called `name`, if there is one.
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
  /// The values of column number `column`, by row. Reports each cell that is no number with the code `input`.
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::size_t column,
                                                           Diagnostics& diagnostics) const;
  [[nodiscard]] SourcePosition position(std::size_t row) const;
};

/// Keys of the `# key: value` lines that decide how a table is read. They must precede the column names;
/// `read_table` reports those that follow them.
[[nodiscard]] const std::vector<std::string>& governing_keys();

/// Provenance that a table must declare.
enum class TableOrigin {
  shipped,  ///< Part of `data/`: title, unit, source, status, processing and outside.
  user,     ///< A user's own file: its unit; `outside` defaults to error; its source is its path and hash.
};

/// Reads a table of UTF-8 text with cells separated by commas. Cells may be quoted ("a, b"). Reports with the
/// code `input` and returns nothing for:
/// - a missing or unreadable file, a byte order mark;
/// - missing provenance keys, repeated keys, an unknown rule `outside`, a governing key below the column
///   names, or followed by "=" instead of ":";
/// - cells separated by semicolons or tabs, an unclosed quote, rows of a wrong length, no rows;
/// - empty or duplicate column names.
[[nodiscard]] std::optional<Table> read_table(const std::filesystem::path& path, TableOrigin origin,
                                              Diagnostics& diagnostics);

/// A column of a table, found by name.
struct TableColumn {
  std::filesystem::path path;
  std::string column;  ///< Name of the column; "" if the table has several value columns and none is named.
};

/// Length [bytes] of the path of a user's table at the start of `name`. The path ends with `.csv` in either
/// case and may be followed by `:column`. `npos` if `name` is a name in the data directory.
[[nodiscard]] std::size_t user_table_end(std::string_view name);

/// Finds a table column by name in a folder of the data directory ("illuminant", "reflectance", "camera",
/// ...). A value column is not a `wavelength_...` column or, in a table without one, not the first. `name` is
/// one of, in order of precedence:
/// - a user's file, recognised by `user_table_end`;
/// - the stem of a file: its only value column, or "" if it has several;
/// - an alias from a line `# aliases: a=b, c=d` of a file: `a` for its column `b`;
/// - a column name that occurs once in the folder;
/// - `stem:column`, also of another spectral folder, such as a camera's channel used as a filter.
/// Reports at `where` and returns nothing for an unknown name, with the nearest name, and for a user's
/// missing file or column. Folders are indexed once. Thread-safe. Throws Error{input} if the data directory
/// is missing.
[[nodiscard]] std::optional<TableColumn> find_table(std::string_view folder, const std::string& name,
                                                    const SourcePosition& where, Diagnostics& diagnostics);

/// The names that `find_table` accepts in a folder, in byte order; `stem:column` only if the column name
/// alone is not accepted. Throws Error{input} if the data directory is missing.
[[nodiscard]] std::vector<std::string> table_names(std::string_view folder);

/// A table of reference values in the folder `reference` of `data_directory`, accessed by row number and by
/// column name.
class ReferenceTable {
 public:
  /// Reads the file `name` + ".csv". Throws Error{input} if it is missing or malformed.
  explicit ReferenceTable(const std::string& name);

  [[nodiscard]] std::size_t rows() const { return table_.rows.size(); }
  /// The text or number of a cell. Throw Error{input} for a missing row or column, or if it is not a finite
  /// number.
  [[nodiscard]] const std::string& text(std::size_t row, std::string_view column) const;
  [[nodiscard]] double number(std::size_t row, std::string_view column) const;

 private:
  std::string name_;
  Table table_;
};

}  // namespace abbe
