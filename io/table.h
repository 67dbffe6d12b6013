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

/// What a table holds beyond its first and last row.
enum class Outside { clamp, zero, error };

/// Where a table's numbers come from; every field is required of the tables the product ships.
struct Provenance {
  std::string title;
  std::string unit;
  std::string source;
  std::string status;
  std::string processing;
};

/// Columns of numbers or words under one header. Written as CSV: `# key: value` lines (title, unit, source,
/// status, processing, outside, and keys of the table's own), then the column names, then the rows.
struct Table {
  Provenance provenance;
  std::map<std::string, std::string> keys;  ///< Every `# key: value` line, those of `provenance` included.
  Outside outside = Outside::error;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< `rows[i][j]` is the cell of `columns[j]`.
  SourcePosition where;
  std::vector<std::size_t> row_offsets;  ///< Byte offset of each row in its text.

  /// Index of the column of that name, if there is one.
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
  /// The values of a column as numbers; an empty or malformed cell is reported.
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::size_t column,
                                                           Diagnostics& diagnostics) const;
  /// Place of a row, for complaints about it.
  [[nodiscard]] SourcePosition position(std::size_t row) const;
};

/// The keys of lines that say how a table is read. They stand above the column names.
[[nodiscard]] const std::vector<std::string>& governing_keys();

/// Which provenance a table must carry.
enum class TableOrigin {
  shipped,  ///< Part of `data/`: title, unit, source, status, processing and outside.
  user,     ///< A user's own file: its unit; `outside` defaults to error; its source is its path and hash.
};

/// Reads one table. Quoted cells ("a, b") are understood. Reports a missing provenance key, a row of the
/// wrong length, a duplicate column.
[[nodiscard]] std::optional<Table> read_table(const std::filesystem::path& path, TableOrigin origin,
                                              Diagnostics& diagnostics);

/// A column of a table in the data directory, found by name.
struct TableColumn {
  std::filesystem::path path;
  std::string column;
};

/// Where the path of a user's table ends in a name: behind `.csv` in letters of either case, with nothing or
/// `:column` behind it. `npos` of a name that is looked for in the data folders.
[[nodiscard]] std::size_t user_table_end(std::string_view name);

/// Finds `name` in a folder of the data directory ("illuminant", "reflectance", "camera", ...): the stem of a
/// file (its only value column, which those of wavelengths are not, or "" when it has several), a column's
/// own name when it occurs once in the folder, or `stem:column`, which may be in another folder of spectra,
/// as a camera's channel that serves as a filter. A `# aliases: a=b, c=d` line of a file adds names. A user's
/// file is told by `user_table_end`. Nothing found is reported at `where` with the nearest name.
[[nodiscard]] std::optional<TableColumn> find_table(std::string_view folder, const std::string& name,
                                                    const SourcePosition& where, Diagnostics& diagnostics);

/// The names `find_table` accepts in a folder, sorted; `stem:column` only where the column's own name is not
/// accepted.
[[nodiscard]] std::vector<std::string> table_names(std::string_view folder);

}  // namespace abbe
