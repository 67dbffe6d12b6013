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
enum class Outside { clamp, zero, error };

/// Origin of a table's numbers. Shipped tables must declare all fields.
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
  std::map<std::string, std::string> keys;  ///< All `# key: value` lines, including those of `provenance`.
  Outside outside = Outside::error;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< `rows[i][j]` is the cell of `columns[j]`.
  SourcePosition where;
  std::vector<std::size_t> row_offsets;  ///< Byte offset of each row in its text.

  /// Index of the column called `name`, if there is one.
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
  /// The values of a column as numbers. Reports empty and malformed cells and returns nothing.
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::size_t column,
                                                           Diagnostics& diagnostics) const;
  /// Source position of a row, for diagnostics.
  [[nodiscard]] SourcePosition position(std::size_t row) const;
};

/// Keys of the `# key: value` lines that decide how a table is read. They must precede the column names.
[[nodiscard]] const std::vector<std::string>& governing_keys();

/// Provenance that a table must declare.
enum class TableOrigin {
  shipped,  ///< Part of `data/`: title, unit, source, status, processing and outside.
  user,     ///< A user's own file: its unit; `outside` defaults to error; its source is its path and hash.
};

/// Reads a table. Cells may be quoted ("a, b"). Reports missing provenance keys, rows of a wrong length and
/// duplicate columns, and returns nothing.
[[nodiscard]] std::optional<Table> read_table(const std::filesystem::path& path, TableOrigin origin,
                                              Diagnostics& diagnostics);

/// A column of a table, found by name.
struct TableColumn {
  std::filesystem::path path;
  std::string column;
};

/// Length of the path of a user's table at the start of `name`, which ends with `.csv` in either case and may
/// be followed by `:column`. `npos` if `name` is a name in the data directory.
[[nodiscard]] std::size_t user_table_end(std::string_view name);

/// Finds a table column by name in a folder of the data directory ("illuminant", "reflectance", "camera",
/// ...). `name` is one of:
/// - the stem of a file: its only value column (not a wavelength column), or "" if it has several;
/// - a column name that occurs once in the folder;
/// - `stem:column`, also of another spectral folder, such as a camera's channel used as a filter;
/// - an alias from a line `# aliases: a=b, c=d` of a file;
/// - a user's file, recognised by `user_table_end`.
/// Reports an unknown name at `where` with the nearest name and returns nothing.
[[nodiscard]] std::optional<TableColumn> find_table(std::string_view folder, const std::string& name,
                                                    const SourcePosition& where, Diagnostics& diagnostics);

/// The names that `find_table` accepts in a folder, sorted. `stem:column` is listed only if the column name
/// alone is not accepted.
[[nodiscard]] std::vector<std::string> table_names(std::string_view folder);

}  // namespace abbe
