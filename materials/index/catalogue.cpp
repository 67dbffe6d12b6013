#include "materials/index/catalogue.h"

#include <filesystem>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "io/text.h"
#include "spectral/library.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

/// "maker/glass" of "specs/maker/.../glass.yml"; empty for paths of other materials.
std::optional<std::string> glass_at(const std::string& db_path) {
  const fs::path path = db_path;
  const auto part = path.begin();
  if (part == path.end() || *part != "specs") return std::nullopt;
  return fmt::format("{}/{}", std::next(part)->string(), path.stem().string());
}

/// Reads a catalogue at the first request and caches it. Thread-safe.
class CatalogueCache {
 public:
  CatalogueCache(const char* file, bool with_extinction) : file_(file), with_extinction_(with_extinction) {}

  const Catalogue* get(Diagnostics& diagnostics) {
    const std::lock_guard lock(mutex_);
    if (!catalogue_) {
      auto table = read_table(data_directory() / kGlassFolder / file_, TableOrigin::shipped, diagnostics);
      if (!table) return nullptr;
      catalogue_.emplace(*std::move(table), with_extinction_);
    }
    return &*catalogue_;
  }

 private:
  const char* file_;
  bool with_extinction_;
  std::mutex mutex_;
  std::optional<Catalogue> catalogue_;
};

}  // namespace

Catalogue::Catalogue(Table table, bool with_extinction)
    : table_(std::move(table)), with_extinction_(with_extinction) {
  for (std::size_t row = 0; row < table_.rows.size(); ++row) {
    rows_[cell(row, "id")] = row;
    if (const auto glass = glass_at(cell(row, "db_path"))) glasses_[*glass] = row;
  }
  const auto aliases = table_.keys.find("aliases");
  if (aliases == table_.keys.end()) return;
  for (const std::string& alias : split(aliases->second, ',')) {
    const std::vector<std::string> sides = split(alias, '=');
    if (sides.size() == 2 && rows_.contains(sides[1])) rows_.try_emplace(sides[0], rows_[sides[1]]);
  }
}

std::optional<NamedIndex> Catalogue::load(std::size_t row, const std::string& name,
                                          Diagnostics& diagnostics) const {
  const std::string& id = cell(row, "id");
  const auto low_um = number(row, "lambda_min_um", diagnostics);
  const auto high_um = number(row, "lambda_max_um", diagnostics);
  const auto formula = formula_of(row, diagnostics);
  if (!low_um || !high_um || !formula) return std::nullopt;
  if (const auto fault = dispersion_fault(*formula, *low_um * 1e3, *high_um * 1e3)) {
    diagnostics.error(table_.position(row), fmt::format("{}: {}", id, *fault), ErrorCode::input);
    return std::nullopt;
  }
  std::optional<Extinction> k;
  const fs::path absorption = data_directory() / kGlassFolder / (id + "_k.csv");
  if (with_extinction_ && fs::exists(absorption)) {
    const auto loaded =
        load_curve(kGlassFolder, absorption.stem().string() + ":k", {}, diagnostics, kAnyWavelength);
    if (!loaded) return std::nullopt;
    k = {loaded->curve, {loaded->low_nm, loaded->high_nm}};
  }
  const bool absolute = table_.column("index_relative_to") && cell(row, "index_relative_to") == "vacuum";
  return NamedIndex{name, source_of(row),
                    RefractiveIndex(*formula, k, absolute ? IndexMedium::vacuum : IndexMedium::air,
                                    *low_um * 1e3, *high_um * 1e3)};
}

const std::string& Catalogue::cell(std::size_t row, const std::string& column) const {
  const auto index = table_.column(column);
  if (!index) throw Error(ErrorCode::input, table_.where.source->file, "no column \"" + column + "\"");
  return table_.rows[row][*index];
}

std::optional<double> Catalogue::number(std::size_t row, const std::string& column,
                                        Diagnostics& diagnostics) const {
  const auto value = parse_number(cell(row, column));
  if (!value)
    diagnostics.error(table_.position(row), fmt::format("expected a number in column \"{}\"", column),
                      ErrorCode::input);
  return value;
}

std::optional<DispersionFormula> Catalogue::formula_of(std::size_t row, Diagnostics& diagnostics) const {
  const auto id = number(row, "formula", diagnostics);
  if (!id) return std::nullopt;
  DispersionFormula formula{.id = static_cast<int>(*id), .c = {}, .terms = 0};
  for (std::size_t i = 0; i < formula.c.size(); ++i) {
    const std::string column = fmt::format("c{}", i + 1);
    if (!table_.column(column) || cell(row, column).empty()) continue;
    const auto c = number(row, column, diagnostics);
    if (!c) return std::nullopt;
    formula.c[i] = *c;
    formula.terms = static_cast<int>(i + 1);
  }
  return formula;
}

std::string Catalogue::source_of(std::size_t row) const {
  if (table_.column("source")) return cell(row, "source");
  return fmt::format("{}/{}", table_.provenance.source, cell(row, "db_path"));
}

const Catalogue* dielectrics(Diagnostics& diagnostics) {
  static CatalogueCache shelf("dielectrics.csv", true);
  return shelf.get(diagnostics);
}

const Catalogue* makers(Diagnostics& diagnostics) {
  static CatalogueCache shelf("makers.csv", false);
  return shelf.get(diagnostics);
}

}  // namespace abbe
