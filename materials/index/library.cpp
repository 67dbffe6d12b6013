#include "materials/index/library.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "io/table.h"
#include "io/text.h"
#include "spectral/library.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGlass = "glass";
constexpr const char* kFolders[] = {kGlass, "metal"};
// An index may be asked for at any wavelength: RefractiveIndex holds n beyond a table, and says where that
// begins.
constexpr NeededRange kNothingNeeded{kMaxWavelengthNm, kMinWavelengthNm};

IndexMedium medium_named(const std::string& name) {
  return name == "vacuum" ? IndexMedium::vacuum : IndexMedium::air;
}

/// The catalogue of dispersion formulas: one material per row.
class Catalogue {
 public:
  explicit Catalogue(Diagnostics& diagnostics) {
    auto table = read_table(data_directory() / kGlass / "dielectrics.csv", TableOrigin::shipped, diagnostics);
    if (!table) return;
    table_ = *std::move(table);
    for (std::size_t row = 0; row < table_.rows.size(); ++row) rows_[cell(row, "id")] = row;
    const auto aliases = table_.keys.find("aliases");
    if (aliases == table_.keys.end()) return;
    for (const std::string& alias : split(aliases->second, ',')) {
      const std::vector<std::string> sides = split(alias, '=');
      if (sides.size() == 2 && rows_.contains(sides[1])) rows_.try_emplace(sides[0], rows_[sides[1]]);
    }
  }

  /// Row of each identifier and alias.
  [[nodiscard]] const std::map<std::string, std::size_t>& rows() const { return rows_; }

  [[nodiscard]] std::optional<NamedIndex> load(std::size_t row, Diagnostics& diagnostics) const {
    const std::string& id = cell(row, "id");
    const auto low_um = number(row, "lambda_min_um", diagnostics);
    const auto high_um = number(row, "lambda_max_um", diagnostics);
    const auto formula = formula_of(row, diagnostics);
    if (!low_um || !high_um || !formula) return std::nullopt;
    if (const auto fault = dispersion_fault(*formula, *low_um * 1e3, *high_um * 1e3)) {
      diagnostics.error(table_.position(row), fmt::format("{}: {}", id, *fault), ErrorCode::input);
      return std::nullopt;
    }
    std::optional<Curve> k;
    const fs::path absorption = data_directory() / kGlass / (id + "_k.csv");
    if (fs::exists(absorption)) {
      const auto loaded =
          load_curve(kGlass, absorption.stem().string() + ":k", {}, diagnostics, kNothingNeeded);
      if (!loaded) return std::nullopt;
      k = loaded->curve;
    }
    return NamedIndex{id, cell(row, "source"),
                      RefractiveIndex(*formula, k, medium_named(cell(row, "index_relative_to")),
                                      *low_um * 1e3, *high_um * 1e3)};
  }

 private:
  [[nodiscard]] const std::string& cell(std::size_t row, const std::string& column) const {
    const auto index = table_.column(column);
    if (!index) throw Error(ErrorCode::input, table_.where.source->file, "no column \"" + column + "\"");
    return table_.rows[row][*index];
  }

  [[nodiscard]] std::optional<double> number(std::size_t row, const std::string& column,
                                             Diagnostics& diagnostics) const {
    const auto value = parse_number(cell(row, column));
    if (!value)
      diagnostics.error(table_.position(row), fmt::format("expected a number in column \"{}\"", column),
                        ErrorCode::input);
    return value;
  }

  [[nodiscard]] std::optional<DispersionFormula> formula_of(std::size_t row, Diagnostics& diagnostics) const {
    const auto id = number(row, "formula", diagnostics);
    if (!id) return std::nullopt;
    DispersionFormula formula{.id = static_cast<int>(*id), .c = {}, .terms = 0};
    for (std::size_t i = 0; i < formula.c.size(); ++i) {
      const std::string column = fmt::format("c{}", i + 1);
      if (cell(row, column).empty()) continue;
      const auto c = number(row, column, diagnostics);
      if (!c) return std::nullopt;
      formula.c[i] = *c;
      formula.terms = static_cast<int>(i + 1);
    }
    return formula;
  }

  Table table_;
  std::map<std::string, std::size_t> rows_;
};

/// The file of `name` if that is a table of n (and perhaps k): its stem or an alias, or a user's path.
std::optional<fs::path> table_of(const char* folder, const std::string& name) {
  Diagnostics unheard;
  const auto found = find_table(folder, name, {}, unheard);
  if (!found || (!found->column.empty() && found->column != "n")) return std::nullopt;
  if (!find_table(folder, found->path.stem().string() + ":n", {}, unheard)) return std::nullopt;
  return found->path;
}

std::optional<NamedIndex> load_tables(const char* folder, const std::string& name, const fs::path& path,
                                      const SourcePosition& where, Diagnostics& diagnostics) {
  const auto n = load_curve(folder, name + ":n", where, diagnostics, kNothingNeeded);
  if (!n) return std::nullopt;
  Curve k;
  Diagnostics unheard;
  if (find_table(folder, name + ":k", where, unheard)) {
    const auto loaded = load_curve(folder, name + ":k", where, diagnostics, kNothingNeeded);
    if (!loaded) return std::nullopt;
    k = loaded->curve;
  }
  if (n->curve.min() <= 0 || k.min() < 0) {
    diagnostics.error(
        where,
        fmt::format(
            "{}: an index must be positive and its extinction not negative (got n down to {}, k down to {})",
            path.string(), n->curve.min(), k.min()),
        ErrorCode::input);
    return std::nullopt;
  }
  const auto table = read_table(path, TableOrigin::user, diagnostics);
  if (!table) return std::nullopt;
  const auto medium = table->keys.find("index_relative_to");
  return NamedIndex{
      path.stem().string(), n->source,
      RefractiveIndex(n->curve, k, medium_named(medium == table->keys.end() ? "" : medium->second), n->low_nm,
                      n->high_nm)};
}

}  // namespace

std::optional<NamedIndex> load_index(const std::string& name, const SourcePosition& where,
                                     Diagnostics& diagnostics) {
  if (name.ends_with(".csv")) {
    const auto found = find_table(kGlass, name, where, diagnostics);
    return found ? load_tables(kGlass, name, found->path, where, diagnostics) : std::nullopt;
  }
  const Catalogue catalogue(diagnostics);
  if (const auto row = catalogue.rows().find(name); row != catalogue.rows().end())
    return catalogue.load(row->second, diagnostics);
  for (const char* folder : kFolders) {
    if (const auto path = table_of(folder, name))
      return load_tables(folder, path->stem().string(), *path, where, diagnostics);
  }
  diagnostics.error(where, unknown_name("material", name, index_names()));
  return std::nullopt;
}

std::vector<std::string> index_names() {
  Diagnostics unheard;
  std::vector<std::string> names;
  const Catalogue catalogue(unheard);
  for (const auto& [name, row] : catalogue.rows()) names.push_back(name);
  for (const char* folder : kFolders)
    for (const std::string& name : table_names(folder))
      if (name.find(':') == std::string::npos && table_of(folder, name)) names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace abbe
