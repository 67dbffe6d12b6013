#pragma once

#include <map>
#include <optional>
#include <string>

#include "io/table.h"
#include "materials/index/named_index.h"

namespace abbe {

/// The folder of data with what is transparent.
inline constexpr const char* kGlassFolder = "glass";

/// A table of `data/glass` with a dispersion formula per row: columns id, formula, c1, c2, ...,
/// lambda_min_um, lambda_max_um, db_path, perhaps source, name and index_relative_to.
class Catalogue {
 public:
  /// `with_extinction`: the folder holds extinction tables of these materials, as `<id>_k.csv`.
  Catalogue(Table table, bool with_extinction);

  /// Row of each id and alias.
  [[nodiscard]] const std::map<std::string, std::size_t>& rows() const { return rows_; }
  /// Row of each glass of a maker, as "maker/glass" in the makers' spelling of the glass.
  [[nodiscard]] const std::map<std::string, std::size_t>& glasses() const { return glasses_; }

  /// The index of a row as `name`, with its extinction where that is tabulated. Reports a malformed number, a
  /// pole within the row's range, and n <= 1 there.
  [[nodiscard]] std::optional<NamedIndex> load(std::size_t row, const std::string& name,
                                               Diagnostics& diagnostics) const;
  [[nodiscard]] const std::string& cell(std::size_t row, const std::string& column) const;

 private:
  [[nodiscard]] std::optional<double> number(std::size_t row, const std::string& column,
                                             Diagnostics& diagnostics) const;
  [[nodiscard]] std::optional<DispersionFormula> formula_of(std::size_t row, Diagnostics& diagnostics) const;
  [[nodiscard]] std::string source_of(std::size_t row) const;

  Table table_;
  bool with_extinction_;
  std::map<std::string, std::size_t> rows_;
  std::map<std::string, std::size_t> glasses_;
};

/// The shipped catalogues, each read when first asked for and kept. `dielectrics` are transparent materials
/// by name, `makers` what else the makers of optical glass sell. nullptr, with a complaint, when one cannot
/// be read.
[[nodiscard]] const Catalogue* dielectrics(Diagnostics& diagnostics);
[[nodiscard]] const Catalogue* makers(Diagnostics& diagnostics);

}  // namespace abbe
