#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "io/diagnostics.h"
#include "io/table.h"
#include "materials/index/refractive_index.h"
#include "spectral/library.h"

namespace abbe {

struct NamedIndex {
  std::string name;
  std::string source;  ///< Text that identifies the origin of the data.
  RefractiveIndex index;
};

/// Required of an index table is no range: RefractiveIndex extrapolates n and reports the range of its data.
inline constexpr NeededRange kAnyWavelength{kMaxWavelengthNm, kMinWavelengthNm};

/// Data folder of transparent materials.
inline constexpr const char* kGlassFolder = "glass";

/// A table of `data/glass` with one dispersion formula per row. Rows are numbered from 0. Columns: id,
/// formula, c1, c2, ..., lambda_min_um, lambda_max_um, db_path; optionally source, name and
/// index_relative_to.
class Catalogue {
 public:
  /// If `with_extinction` is true, the folder may hold extinction tables of these materials as `<id>_k.csv`.
  /// Throws Error{input} if the table has no column `id` or `db_path`.
  Catalogue(Table table, bool with_extinction);

  /// Row number of each id and alias.
  [[nodiscard]] const std::map<std::string, std::size_t>& rows() const { return rows_; }
  /// Row number of each maker's glass, under "maker/glass" with the makers' spelling of the glass.
  [[nodiscard]] const std::map<std::string, std::size_t>& glasses() const { return glasses_; }

  /// The index of a row under `name`, with its extinction if that is tabulated. Reports a malformed number, a
  /// pole within the row's range, and n <= 1 there; the result is then empty. Throws as `cell`.
  [[nodiscard]] std::optional<NamedIndex> load(std::size_t row, const std::string& name,
                                               Diagnostics& diagnostics) const;
  /// The text of a cell. Throws Error{input} if there is no such column; `row` must exist.
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

/// The shipped catalogues, read at the first request and cached for the whole run; thread-safe. `dielectrics`
/// holds transparent materials by name, `makers` the other glasses of the makers of optical glass. nullptr,
/// with an error in `diagnostics`, if the file cannot be read.
[[nodiscard]] const Catalogue* dielectrics(Diagnostics& diagnostics);
[[nodiscard]] const Catalogue* makers(Diagnostics& diagnostics);

/// Reads a file of the refractiveindex.info database (`.yml`). [Polyanskiy2024]
/// - DATA has one block that gives n ("formula 1" to "formula 9", "tabulated n", "tabulated nk") and
///   optionally one that gives k ("tabulated nk", "tabulated k"). Outside its table k has the value at the
///   nearer end.
/// - REFERENCES and COMMENTS become the source.
/// - `n_is_absolute` and `wavelength_is_vacuum` in SPECS, CONDITIONS or PROPERTIES are true for an index
///   relative to vacuum and for wavelengths in vacuum; air is the default. Earlier editions spell them
///   `n_absolute` and `wavelength_vacuum`.
/// Anything missing, malformed, out of order, misplaced or contradictory is reported as an input error with
/// its position; the result is then empty.
[[nodiscard]] std::optional<NamedIndex> read_refractiveindex_info(const std::filesystem::path& path,
                                                                  Diagnostics& diagnostics);

}  // namespace abbe
