#include "io/table.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "io/text.h"

namespace abbe {

namespace {

namespace fs = std::filesystem;

struct Cell {
  std::string text;
  std::size_t offset;  ///< Byte offset in the line.
};

/// Position of the quote that closes the one at `at`; two quotes in a row do not. The end of the line if
/// there is none.
std::size_t closing_quote(std::string_view line, std::size_t at) {
  for (++at; at < line.size() && (line[at] != '"' || line.substr(at, 2) == "\"\""); ++at)
    if (line[at] == '"') ++at;
  return std::min(at, line.size());
}

/// The cells of a line. Nothing if a quoted cell is not closed by a quote before a comma or the end.
std::optional<std::vector<Cell>> cells_of(std::string_view line) {
  std::vector<Cell> cells;
  for (std::size_t at = 0;;) {
    at = std::min(line.find_first_not_of(" \t", at), line.size());
    Cell cell{"", at};
    if (at < line.size() && line[at] == '"') {
      const std::size_t end = closing_quote(line, at);
      if (end == line.size()) return std::nullopt;
      for (++at; at < end; ++at) {
        if (line[at] == '"') ++at;
        cell.text += line[at];
      }
      at = std::min(line.find_first_not_of(" \t", at + 1), line.size());
      if (at < line.size() && line[at] != ',') return std::nullopt;
    } else {
      const std::size_t end = std::min(line.find(',', at), line.size());
      cell.text = line.substr(at, end - at);
      cell.text.erase(cell.text.find_last_not_of(" \t") + 1);
      at = end;
    }
    cells.push_back(std::move(cell));
    if (at == line.size()) return cells;
    ++at;
  }
}

/// The line that begins at `offset`, without its end.
std::string_view line_from(std::string_view text, std::size_t offset) {
  std::string_view line = text.substr(offset, text.find('\n', offset) - offset);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

bool has_byte_order_mark(const fs::path& path) {
  std::string begin(kByteOrderMark.size(), '\0');
  std::ifstream file(path);
  return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == kByteOrderMark;
}

/// Position of the first semicolon or tab that separates values where commas are expected. The cells are
/// missing after a quoted cell that a semicolon or tab follows directly.
std::optional<std::size_t> wrong_separator(std::string_view line,
                                           const std::optional<std::vector<Cell>>& cells) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  const bool is_quoted = line.substr(begin).starts_with('"');
  if (cells ? cells->size() != 1 : !is_quoted) return std::nullopt;
  const std::size_t at = is_quoted ? line.find_first_not_of(' ', closing_quote(line, begin) + 1)
                                   : line.find_first_of(";\t", begin);
  const bool separates = at <= line.find_last_not_of(" \t") && (line[at] == ';' || line[at] == '\t');
  return separates ? std::optional(at) : std::nullopt;
}

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t\r") == std::string_view::npos;
}

/// Splits `# key: value`; nothing for a comment of another form.
std::optional<std::pair<std::string, std::string>> key_line(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  return std::pair{split(line.substr(1, colon - 1), '\n').front(),
                   split(line.substr(colon + 1), '\n').front()};
}

bool governs(const std::string& key) {
  return std::ranges::find(governing_keys(), key) != governing_keys().end();
}

/// The key of a comment `# key = value`, if it would be a governing key with a colon.
std::optional<std::string> key_with_equals_sign(std::string_view line) {
  const std::size_t sign = line.find_first_of("=:");
  if (sign == std::string_view::npos || line[sign] == ':') return std::nullopt;
  std::string key = split(line.substr(1, sign - 1), '\n').front();
  return governs(key) ? std::optional(std::move(key)) : std::nullopt;
}

/// Builds a table line by line and reports each line that it cannot use.
class TableReader {
 public:
  TableReader(std::shared_ptr<const SourceText> source, Diagnostics& diagnostics)
      : source_(std::move(source)), diagnostics_(diagnostics) {
    table_.where.source = source_;
  }

  void read_lines() {
    const std::string_view text = source_->text;
    for (std::size_t offset = 0; offset < text.size() && !wrongly_separated_;) {
      const std::string_view line = line_from(text, offset);
      if (line.starts_with('#'))
        read_key(line, offset);
      else if (!is_blank(line))
        read_cells(line, offset);
      offset = std::min(text.find('\n', offset), text.size() - 1) + 1;
    }
    if (table_.rows.empty() && !wrongly_separated_)
      report(text.size(), "expected a line of column names and at least one row");
  }

  void refuse_byte_order_mark() { report(0, "begins with a byte order mark; save it as UTF-8 without one"); }

  void check_provenance(TableOrigin origin) {
    Provenance& provenance = table_.provenance;
    const bool shipped = origin == TableOrigin::shipped;
    if (!shipped) {
      provenance.title = fs::path(source_->file).stem().string();
      provenance.source = user_source(*source_);
    }
    take("title", provenance.title, shipped);
    take("unit", provenance.unit, true);
    take("source", provenance.source, shipped);
    take("status", provenance.status, shipped);
    take("processing", provenance.processing, shipped);
    std::string outside = "error";
    take("outside", outside, shipped);
    constexpr std::array<std::string_view, 3> kNames{"clamp", "zero", "error"};
    const auto name = std::find(kNames.begin(), kNames.end(), outside);
    if (name == kNames.end())
      report(key_offsets_["outside"],
             fmt::format("unknown range rule (got {}, allowed {})", outside, fmt::join(kNames, ", ")));
    else
      table_.outside = static_cast<Outside>(name - kNames.begin());
  }

  [[nodiscard]] std::optional<Table> result() {
    if (has_errors_) return std::nullopt;
    return std::move(table_);
  }

 private:
  void report(std::size_t offset, std::string message) {
    diagnostics_.error({source_, offset, ""}, std::move(message), ErrorCode::input);
    has_errors_ = true;
  }

  void read_key(std::string_view line, std::size_t offset) {
    if (const auto key = key_with_equals_sign(line))
      return report(offset, fmt::format("\"# {0} =\" is not read; write \"# {0}: <{0}>\"", *key));
    const auto key = key_line(line);
    if (key && !table_.columns.empty() && governs(key->first))
      return report(offset, fmt::format("\"# {}:\" is not read below the column names; move it above them",
                                        key->first));
    if (!table_.columns.empty() || !key) return;
    if (!table_.keys.insert(*key).second) report(offset, fmt::format("repeated line \"# {}:\"", key->first));
    key_offsets_[key->first] = offset;
  }

  void read_cells(std::string_view line, std::size_t offset) {
    auto cells = cells_of(line);
    const auto wrong = table_.columns.size() == 1 ? std::nullopt : wrong_separator(line, cells);
    wrongly_separated_ = wrong.has_value();
    if (wrong)
      return report(offset + *wrong,
                    fmt::format("cells are separated by {}, allowed ',')",
                                line[*wrong] == ';' ? "semicolons (got ';'" : "tabs (got a tab"));
    if (!cells) return report(offset, "quoted cell without its closing quote");
    if (!table_.columns.empty()) {
      if (cells->size() != table_.columns.size())
        return report(offset, fmt::format("wrong number of cells (got {}, allowed {})", cells->size(),
                                          table_.columns.size()));
      table_.row_offsets.push_back(offset);
      std::vector<std::string>& row = table_.rows.emplace_back();
      for (Cell& cell : *cells) row.push_back(std::move(cell.text));
      return;
    }
    for (Cell& cell : *cells) {
      if (cell.text.empty()) report(offset + cell.offset, "empty column name");
      if (!cell.text.empty() && table_.column(cell.text))
        report(offset + cell.offset, fmt::format("duplicate column \"{}\"", cell.text));
      table_.columns.push_back(std::move(cell.text));
    }
  }

  void take(const std::string& key, std::string& value, bool required) {
    const auto found = table_.keys.find(key);
    if (found != table_.keys.end() && !found->second.empty())
      value = found->second;
    else if (required)
      report(0, fmt::format("missing {}; add a line \"# {}: <{}>\"", key, key, key));
  }

  std::shared_ptr<const SourceText> source_;
  Diagnostics& diagnostics_;
  Table table_;
  std::map<std::string, std::size_t> key_offsets_;
  bool has_errors_ = false;
  bool wrongly_separated_ = false;  ///< Cells are not separated by commas; reading stops.
};

struct Heading {
  std::string aliases;
  std::vector<std::string>
      values;  ///< Column names except those of wavelengths or, without any, except the first.
  bool wrongly_separated = false;  ///< Cells are not separated by commas; the column names are unknown.
};

// Reads the lines up to the column names, without reports: `read_table` reports their errors.
Heading heading_of(const fs::path& path) {
  Heading heading;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
    if (line.starts_with('#')) {
      const auto key = key_line(line);
      if (key && key->first == "aliases") heading.aliases = key->second;
    } else if (!is_blank(line)) {
      if (line.ends_with('\r')) line.pop_back();
      const auto read = cells_of(line);
      heading.wrongly_separated = wrong_separator(line, read).has_value();
      std::vector<Cell> cells = read.value_or(std::vector<Cell>{});
      for (Cell& cell : cells)
        if (!cell.text.starts_with("wavelength_")) heading.values.push_back(std::move(cell.text));
      if (!cells.empty() && heading.values.size() == cells.size())
        heading.values.erase(heading.values.begin());
      break;
    }
  }
  return heading;
}

std::string only_value(const Heading& heading) {
  return heading.values.size() == 1 ? heading.values.front() : "";
}

using Names = std::map<std::string, TableColumn, std::less<>>;

/// All names of a folder. Stems precede aliases, and aliases precede column names.
Names index_folder(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing))
    if (entry.path().extension() == ".csv" && entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());

  Names names;
  Names aliases;
  std::map<std::string, std::vector<TableColumn>> columns;
  for (const fs::path& path : files) {
    const Heading heading = heading_of(path);
    const std::string stem = path.stem().string();
    names[stem] = {path, only_value(heading)};
    for (const std::string& column : heading.values) {
      names[fmt::format("{}:{}", stem, column)] = {path, column};
      columns[column].push_back({path, column});
    }
    if (heading.aliases.empty()) continue;
    for (const std::string& alias : split(heading.aliases, ',')) {
      const std::vector<std::string> sides = split(alias, '=');
      const bool whole = sides.size() < 2 || sides[1] == stem;
      aliases.try_emplace(sides[0], TableColumn{path, whole ? only_value(heading) : sides[1]});
    }
  }
  names.merge(aliases);
  for (const auto& [name, locations] : columns)
    if (locations.size() == 1) names.try_emplace(name, locations.front());
  return names;
}

const Names& names_in(std::string_view folder) {
  static std::mutex mutex;
  static std::map<std::string, Names, std::less<>> folders;
  const std::lock_guard lock(mutex);
  const auto known = folders.find(folder);
  if (known != folders.end()) return known->second;
  return folders.emplace(folder, index_folder(data_directory() / folder)).first->second;
}

/// Finds "stem:column" in the spectral folders.
std::optional<TableColumn> column_elsewhere(const std::string& name) {
  if (name.find(':') == std::string::npos) return std::nullopt;
  for (const char* folder : {"camera", "filter", "illuminant", "observer", "reflectance"})
    if (const auto found = names_in(folder).find(name); found != names_in(folder).end()) return found->second;
  return std::nullopt;
}

/// Finds `path.csv` or `path.csv:column` of a user.
std::optional<TableColumn> user_column(const std::string& name, const SourcePosition& where,
                                       Diagnostics& diagnostics) {
  const std::size_t end = user_table_end(name);
  const fs::path path = name.substr(0, end);
  if (!is_file(path, where, diagnostics)) return std::nullopt;
  const Heading heading = heading_of(path);
  if (end == name.size()) return TableColumn{path, only_value(heading)};
  const std::string column = name.substr(end + 1);
  // `read_table` reports the wrong separator with its position.
  if (heading.wrongly_separated) return TableColumn{path, column};
  if (std::find(heading.values.begin(), heading.values.end(), column) != heading.values.end())
    return TableColumn{path, column};
  diagnostics.error(where, unknown_name("column", column, heading.values), ErrorCode::input);
  return std::nullopt;
}

}  // namespace

std::optional<std::size_t> Table::column(std::string_view name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

std::optional<std::vector<double>> Table::numbers(std::size_t column, Diagnostics& diagnostics) const {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string& cell = rows[i][column];
    if (const auto number = parse_number(cell)) {
      numbers.push_back(*number);
      continue;
    }
    SourcePosition at = position(i);
    at.offset += cells_of(line_from(where.source->text, at.offset)).value()[column].offset;
    diagnostics.error(
        at,
        fmt::format("expected a number in column \"{}\" (got \"{}\", allowed finite decimal numbers)",
                    columns[column], cell.substr(0, 40)),
        ErrorCode::input);
  }
  if (numbers.size() != rows.size()) return std::nullopt;
  return numbers;
}

SourcePosition Table::position(std::size_t row) const {
  return {where.source, row_offsets[row], ""};
}

std::optional<Table> read_table(const std::filesystem::path& path, TableOrigin origin,
                                Diagnostics& diagnostics) {
  auto source = read_text(path, diagnostics);
  if (!source) return std::nullopt;
  TableReader reader(std::move(source), diagnostics);
  if (has_byte_order_mark(path)) reader.refuse_byte_order_mark();
  reader.read_lines();
  reader.check_provenance(origin);
  return reader.result();
}

const std::vector<std::string>& governing_keys() {
  static const std::vector<std::string> keys{
      "unit", "outside", "interpolation", "value_range", "index_relative_to", "white_xy", "aliases"};
  return keys;
}

std::size_t user_table_end(std::string_view name) {
  constexpr std::string_view kExtension = ".csv";
  const std::string lower = lower_case(name);
  if (lower.ends_with(kExtension)) return name.size();
  const std::size_t dot = lower.rfind(std::string(kExtension) + ':');
  return dot == std::string::npos ? dot : dot + kExtension.size();
}

std::optional<TableColumn> find_table(std::string_view folder, const std::string& name,
                                      const SourcePosition& where, Diagnostics& diagnostics) {
  if (user_table_end(name) != std::string::npos) return user_column(name, where, diagnostics);
  const Names& names = names_in(folder);
  if (const auto found = names.find(name); found != names.end()) return found->second;
  if (auto elsewhere = column_elsewhere(name)) return elsewhere;
  diagnostics.error(where, unknown_name(folder, name, table_names(folder)));
  return std::nullopt;
}

std::vector<std::string> table_names(std::string_view folder) {
  const Names& names = names_in(folder);
  std::vector<std::string> listed;
  for (const auto& [name, location] : names) {
    const std::size_t colon = name.find(':');
    if (colon == std::string::npos || !names.contains(name.substr(colon + 1))) listed.push_back(name);
  }
  return listed;
}

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
