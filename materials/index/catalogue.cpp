#include "materials/index/catalogue.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "io/json.h"
#include "io/text.h"
#include "spectral/air.h"

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

/// A shipped catalogue, read at the first request. Thread-safe.
const Catalogue* cached(const char* file, bool with_extinction, Diagnostics& diagnostics) {
  static std::mutex mutex;
  static std::map<std::string, Catalogue> catalogues;
  const std::lock_guard lock(mutex);
  if (const auto known = catalogues.find(file); known != catalogues.end()) return &known->second;
  auto table = read_table(data_directory() / kGlassFolder / file, TableOrigin::shipped, diagnostics);
  if (!table) return nullptr;
  return &catalogues.try_emplace(file, *std::move(table), with_extinction).first->second;
}

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
  return cached("dielectrics.csv", true, diagnostics);
}

const Catalogue* makers(Diagnostics& diagnostics) {
  return cached("makers.csv", false, diagnostics);
}

namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 22;
constexpr double kNmPerUm = 1e3;

std::vector<std::string_view> words_of(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  std::vector<std::string_view> words;
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(kBlanks, end);
  }
  return words;
}

// A text of the database as one line, without its HTML tags.
std::string plain(std::string_view text) {
  std::string without_tags;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool tag = text[at] == '<' && at + 1 < text.size() &&
                     (text[at + 1] == '/' || std::isalpha(static_cast<unsigned char>(text[at + 1])));
    const std::size_t end = tag ? text.find('>', at) : std::string_view::npos;
    if (end == std::string_view::npos)
      without_tags += text[at];
    else
      at = end;
  }
  return fmt::format("{}", fmt::join(words_of(without_tags), " "));
}

// Allowed numbers of coefficients of a formula: from `min` to `max` in steps of `step`.
struct Count {
  std::size_t min, max, step;
};
constexpr Count kCounts[] = {{3, 17, 2}, {3, 17, 2}, {3, 17, 2}, {5, 17, 1}, {3, 11, 2},
                             {3, 11, 2}, {3, 6, 1},  {4, 4, 1},  {6, 6, 1}};

// Keys for the medium of index and wavelengths, in the spellings of current and earlier editions, and the
// sections that may contain them.
using Spellings = std::array<const char*, 2>;
constexpr Spellings kAbsolute{"n_is_absolute", "n_absolute"};
constexpr Spellings kVacuumWavelengths{"wavelength_is_vacuum", "wavelength_vacuum"};
constexpr std::array kSections{"SPECS", "CONDITIONS", "PROPERTIES"};

bool is_reference_key(std::string_view key) {
  const auto is_key = [key](const char* word) { return key == word; };
  return std::ranges::any_of(kAbsolute, is_key) || std::ranges::any_of(kVacuumWavelengths, is_key);
}

class EntryReader {
 public:
  EntryReader(std::shared_ptr<const SourceText> source, Diagnostics& diagnostics)
      : source_(std::move(source)), diagnostics_(diagnostics) {}

  std::optional<NamedIndex> read(const JsonValue& root) {
    const JsonValue* data = root.find("DATA");
    const auto* blocks = data ? std::get_if<JsonValue::Array>(&data->value) : nullptr;
    if (!blocks || blocks->empty()) {
      complain(data ? data->where : root.where, "expected DATA, a list of formulas and tables");
      return std::nullopt;
    }
    check_key_placement(root, true);
    if (read_flag(root, kAbsolute)) medium_ = IndexMedium::vacuum;
    vacuum_wavelengths_ = read_flag(root, kVacuumWavelengths);
    for (const JsonValue& block : *blocks) read_block(block);
    if (!complained_ && !formula_ && !n_) complain(data->where, "no block of DATA gives n");
    if (complained_) return std::nullopt;
    return NamedIndex{std::filesystem::path(source_->file).stem().string(), identity(root), index()};
  }

 private:
  void complain(const SourcePosition& where, std::string message) {
    diagnostics_.error(where, std::move(message), ErrorCode::input);
    complained_ = true;
  }

  // The scalar under `key`, or nullptr.
  const std::string* scalar(const JsonValue& value, std::string_view key) const {
    const JsonValue* found = value.find(key);
    return found ? std::get_if<std::string>(&found->value) : nullptr;
  }

  // Reports these keys where they would be ignored.
  void check_key_placement(const JsonValue& value, bool is_root, bool is_section = false) {
    if (const auto* list = std::get_if<JsonValue::Array>(&value.value))
      for (const JsonValue& item : *list) check_key_placement(item, false);
    const auto* object = std::get_if<JsonValue::Object>(&value.value);
    if (object == nullptr) return;
    for (const auto& [key, inner] : *object) {
      if (!is_section && is_reference_key(key))
        complain(inner.where,
                 fmt::format("{} is ignored here (allowed only under {})", key, fmt::join(kSections, ", ")));
      const bool names_section = std::find(kSections.begin(), kSections.end(), key) != kSections.end();
      check_key_placement(inner, false, is_root && names_section);
    }
  }

  // Value of a flag, false if absent. Editions of the database differ in the section and the spelling of its
  // key. Reports contradictory values.
  bool read_flag(const JsonValue& root, const Spellings& spellings) {
    std::string flag;
    std::string_view first_key;  // where the value was found
    for (const char* section : kSections)
      for (const char* key : spellings) {
        const JsonValue* specs = root.find(section);
        const std::string* value = specs ? scalar(*specs, key) : nullptr;
        if (value == nullptr) continue;
        const SourcePosition& at = specs->find(key)->where;
        const std::string word = lower_case(*value);
        if (word != "true" && word != "false") {
          complain(at, fmt::format("{} (got \"{}\", allowed true, false)", key, *value));
        } else if (!first_key.empty() && word != flag) {
          complain(at, fmt::format("{} is {}, but {} is {}", key, word, first_key, flag));
        } else {
          flag = word;
          first_key = key;
        }
      }
    return flag == "true";
  }

  std::string identity(const JsonValue& root) const {
    std::string source;
    for (const char* key : {"REFERENCES", "COMMENTS"})
      if (const std::string* text = scalar(root, key); text && !plain(*text).empty())
        source += plain(*text) + "; ";
    return source + user_source(*source_);
  }

  RefractiveIndex index() {
    if (formula_) return {*formula_, std::move(k_), medium_, low_nm_, high_nm_};
    return {std::move(*n_), std::move(k_), medium_, low_nm_, high_nm_};
  }

  void read_block(const JsonValue& block) {
    const std::string* type = scalar(block, "type");
    if (!type) return complain(block.where, "expected a block with a \"type\"");
    const SourcePosition& at = block.find("type")->where;
    if (type->size() == 9 && type->starts_with("formula ") && type->back() >= '1' && type->back() <= '9')
      return read_formula(block, type->back() - '0');
    if (*type == "tabulated n") return read_table(block, true, false);
    if (*type == "tabulated nk") return read_table(block, true, true);
    if (*type == "tabulated k") return read_table(block, false, true);
    complain(at, fmt::format("unknown type of data (got \"{}\", allowed \"formula 1\" to \"formula 9\", "
                             "\"tabulated n\", \"tabulated nk\" and \"tabulated k\")",
                             type->substr(0, 40)));
  }

  // False, with an error, if the file gave the quantity before.
  bool is_first(const JsonValue& block, const char* what, bool& given) {
    if (given) complain(block.where, fmt::format("{} is given twice", what));
    return !std::exchange(given, true);
  }

  void read_formula(const JsonValue& block, int id) {
    if (!is_first(block, "n", gives_n_)) return;
    const auto range = numbers(block, block.find("range") ? "range" : "wavelength_range");  // old, new
    const auto coefficients = numbers(block, "coefficients");
    if (!range || !coefficients) return;
    if (range->size() != 2 || !((*range)[0] > 0) || !((*range)[0] < (*range)[1]))
      return complain(block.where, "expected a wavelength_range of two ascending wavelengths in micrometres");
    const Count count = kCounts[id - 1];
    const std::size_t got = coefficients->size();
    if (got < count.min || got > count.max || (got - count.min) % count.step != 0)
      return complain(block.find("coefficients")->where,
                      fmt::format("wrong number of coefficients for formula {} (got {}, allowed {})", id, got,
                                  text(count)));
    DispersionFormula formula{
        .id = id, .c = {}, .terms = static_cast<int>(got), .vacuum_wavelengths = vacuum_wavelengths_};
    std::copy(coefficients->begin(), coefficients->end(), formula.c.begin());
    low_nm_ = to_air_nm((*range)[0] * kNmPerUm);
    high_nm_ = to_air_nm((*range)[1] * kNmPerUm);
    if (auto fault = range_fault(low_nm_, high_nm_)) return complain(block.where, std::move(*fault));
    if (auto fault = dispersion_fault(formula, low_nm_, high_nm_))
      return complain(block.where, std::move(*fault));
    formula_ = formula;
  }

  static std::string text(const Count& count) {
    if (count.min == count.max) return std::to_string(count.min);
    return fmt::format("{} to {}{}", count.min, count.max, count.step == 2 ? ", odd" : "");
  }

  void read_table(const JsonValue& block, bool with_n, bool with_k) {
    if (with_n && !is_first(block, "n", gives_n_)) return;
    if (with_k && !is_first(block, "k", gives_k_)) return;
    const std::string* data = scalar(block, "data");
    if (!data) return complain(block.where, "expected a table under \"data\"");
    Table table;
    table.columns = {"wavelength_nm"};
    if (with_n) table.columns.emplace_back("n");
    if (with_k) table.columns.emplace_back("k");
    table.outside = Outside::clamp;
    table.where = block.find("data")->where;
    if (!fill(table, *data)) return;
    if (with_n) {
      auto n = curve_of(table, "n", "n", diagnostics_, kAnyWavelength);
      complained_ = complained_ || !n;
      if (!n) return;
      low_nm_ = n->low_nm;
      high_nm_ = n->high_nm;
      n_ = std::move(n->curve);
    }
    if (with_k) {
      auto k = curve_of(table, "k", "k", diagnostics_, kAnyWavelength);
      complained_ = complained_ || !k;
      if (k) k_ = {std::move(k->curve), {k->low_nm, k->high_nm}};
    }
    if (auto fault = index_fault(n_ ? *n_ : Curve(1.0), k_ ? k_->k : Curve()))
      complain(table.where, std::move(*fault));
  }

  // Reads the rows of a table's text; false after an error.
  bool fill(Table& table, const std::string& data) {
    // Only a literal block of YAML preserves its lines.
    const bool literal = source_->text[table.where.offset] == '|';
    const std::string_view text = literal ? std::string_view(source_->text) : std::string_view(data);
    std::size_t line = literal ? text.find('\n', table.where.offset) + 1 : 0;
    for (const std::string& row : split(data, '\n')) {
      SourcePosition at = table.where;
      if (literal) at.offset = line;
      line = std::min(text.find('\n', line), text.size() - 1) + 1;
      if (row.empty()) continue;
      if (literal) at.offset = text.find_first_not_of(" \t", at.offset);
      if (!add_row(table, row, at)) return false;
    }
    return true;
  }

  bool add_row(Table& table, const std::string& row, const SourcePosition& at) {
    std::vector<std::string> cells;
    for (const std::string_view word : words_of(row)) {
      const auto number = number_at(word, at);
      if (!number) return false;
      if (cells.empty() && !(*number > 0))
        complain(at, fmt::format("expected a wavelength above 0 (got {})", word));
      cells.push_back(cells.empty() ? fmt::format("{}", to_air_nm(*number * kNmPerUm)) : std::string(word));
    }
    if (cells.size() != table.columns.size()) {
      complain(at,
               fmt::format("wrong number of cells (got {}, allowed {})", cells.size(), table.columns.size()));
      return false;
    }
    table.rows.push_back(std::move(cells));
    table.row_offsets.push_back(at.offset);
    return !complained_;
  }

  std::optional<double> number_at(std::string_view text, const SourcePosition& at) {
    const auto number = parse_number(text);
    if (!number)
      complain(at, fmt::format("expected a number (got \"{}\", allowed finite decimal numbers)",
                               text.substr(0, 40)));
    return number;
  }

  // The numbers in the scalar under `key`; empty after an error.
  std::optional<std::vector<double>> numbers(const JsonValue& block, std::string_view key) {
    const std::string* text = scalar(block, key);
    if (!text) {
      complain(block.where, fmt::format("expected numbers under \"{}\"", key));
      return std::nullopt;
    }
    std::vector<double> numbers;
    for (const std::string_view word : words_of(*text)) {
      const auto number = number_at(word, block.find(key)->where);
      if (!number) return std::nullopt;
      numbers.push_back(*number);
    }
    return numbers;
  }

  // Converts a wavelength of the file to one in standard air. Below 200 nm, where air absorbs, both are taken
  // as equal.
  double to_air_nm(double nm) const { return vacuum_wavelengths_ && nm > 200 ? vacuum_to_air(nm) : nm; }

  std::shared_ptr<const SourceText> source_;
  Diagnostics& diagnostics_;
  std::optional<DispersionFormula> formula_;
  std::optional<Curve> n_;
  std::optional<Extinction> k_;
  IndexMedium medium_ = IndexMedium::air;
  bool vacuum_wavelengths_ = false;
  bool gives_n_ = false;
  bool gives_k_ = false;
  bool complained_ = false;
  double low_nm_ = 0;
  double high_nm_ = 0;
};

}  // namespace

std::optional<NamedIndex> read_refractiveindex_info(const std::filesystem::path& path,
                                                    Diagnostics& diagnostics) {
  const auto source = read_text(path, diagnostics, ErrorCode::input, kMaxBytes);
  if (!source) return std::nullopt;
  const auto root = parse_yaml(source, diagnostics);
  return root ? EntryReader(source, diagnostics).read(*root) : std::nullopt;
}

}  // namespace abbe
