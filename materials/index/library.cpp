#include "materials/index/library.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "io/table.h"
#include "io/text.h"
#include "spectral/library.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolders[] = {kGlassFolder, "metal"};

/// Path of the table of n, and perhaps k, called `name`: by its stem, an alias or a user's path. Empty if
/// there is none.
std::optional<fs::path> table_of(const char* folder, const std::string& name) {
  Diagnostics ignored;
  const auto found = find_table(folder, name, {}, ignored);
  if (!found || (!found->column.empty() && found->column != "n")) return std::nullopt;
  if (!find_table(folder, found->path.stem().string() + ":n", {}, ignored)) return std::nullopt;
  return found->path;
}

/// False, with an error, if the table has a column that no index has.
bool has_index_columns(const Table& table, Diagnostics& diagnostics) {
  const std::vector<std::string> known{"wavelength_nm", "wavelength_um", "n", "k"};
  for (const std::string& column : table.columns) {
    if (std::find(known.begin(), known.end(), column) != known.end()) continue;
    const std::string word = lower_case(column);
    diagnostics.error(
        table.where,
        word == "k" || word == "kappa"
            ? fmt::format("unknown column \"{}\" (the extinction column must be called k)", column)
            : fmt::format("unknown column of an index (got \"{}\", allowed {})", column,
                          fmt::join(known, ", ")),
        ErrorCode::input);
    return false;
  }
  return true;
}

/// False, with an error, if the table declares an index of 0 outside its rows.
bool has_valid_outside_rule(const Table& table, const NamedCurve& n, Diagnostics& diagnostics) {
  const bool covers_all = n.low_nm <= kMinWavelengthNm && kMaxWavelengthNm <= n.high_nm;
  if (table.outside != Outside::zero || covers_all) return true;
  diagnostics.error(
      table.where,
      "an index cannot be 0 outside the rows of its table (got \"# outside: zero\", allowed clamp, error: "
      "both use the value at the nearer end)",
      ErrorCode::input);
  return false;
}

std::optional<NamedIndex> load_tables(const char* folder, const std::string& name, const fs::path& path,
                                      const SourcePosition& where, Diagnostics& diagnostics) {
  const auto table = read_table(path, TableOrigin::user, diagnostics);
  if (!table || !has_index_columns(*table, diagnostics)) return std::nullopt;
  const auto n = load_curve(folder, name + ":n", where, diagnostics, kAnyWavelength);
  if (!n || !has_valid_outside_rule(*table, *n, diagnostics)) return std::nullopt;
  std::optional<Extinction> k;
  Diagnostics ignored;
  if (find_table(folder, name + ":k", where, ignored)) {
    const auto loaded = load_curve(folder, name + ":k", where, diagnostics, kAnyWavelength);
    if (!loaded) return std::nullopt;
    k = {loaded->curve, {loaded->low_nm, loaded->high_nm}};
  }
  if (const auto fault = index_fault(n->curve, k ? k->k : Curve())) {
    diagnostics.error(where, fmt::format("{}: {}", path.string(), *fault), ErrorCode::input);
    return std::nullopt;
  }
  const std::vector<std::string> media{"air", "vacuum"};
  const auto declared = table->keys.find("index_relative_to");
  const std::string medium = declared != table->keys.end() ? declared->second : media.front();
  if (std::find(media.begin(), media.end(), medium) == media.end()) {
    diagnostics.error(table->where, unknown_name("index_relative_to", medium, media), ErrorCode::input);
    return std::nullopt;
  }
  const bool absolute = medium == "vacuum";
  return NamedIndex{
      path.stem().string(), n->source,
      RefractiveIndex(n->curve, k, absolute ? IndexMedium::vacuum : IndexMedium::air, n->low_nm, n->high_nm)};
}

/// "maker/glass" with the maker in the catalogues' spelling.
std::string qualified(const std::string& name) {
  const std::size_t maker = std::min(name.find('/'), name.size());
  return lower_case(std::string_view(name).substr(0, maker)) + name.substr(maker);
}

/// All makers' glasses, as "maker/glass", sorted.
std::vector<std::string> all_glasses(Diagnostics& diagnostics) {
  std::vector<std::string> glasses;
  for (const Catalogue* catalogue : {dielectrics(diagnostics), makers(diagnostics)})
    if (catalogue)
      for (const auto& [glass, row] : catalogue->glasses()) glasses.push_back(glass);
  std::sort(glasses.begin(), glasses.end());
  return glasses;
}

std::optional<NamedIndex> load_user_file(const std::string& name, const SourcePosition& where,
                                         Diagnostics& diagnostics) {
  if (is_refractiveindex_info(name))
    return is_file(name, where, diagnostics) ? read_refractiveindex_info(name, diagnostics) : std::nullopt;
  const auto found = find_table(kGlassFolder, name, where, diagnostics);
  return found ? load_tables(kGlassFolder, name, found->path, where, diagnostics) : std::nullopt;
}

void report_unknown(const std::string& name, const SourcePosition& where, Diagnostics& diagnostics) {
  std::vector<std::string> known = index_names();
  for (const std::string& glass : glass_names()) {
    known.push_back(glass);
    known.push_back(glass.substr(glass.find('/') + 1));
  }
  diagnostics.error(where, unknown_name("material", name, known));
}

}  // namespace

void require_data_at(const NamedIndex& material, std::span<const double> wavelengths_nm,
                     const std::string& where) {
  const double low = std::max<double>(material.index.low_nm(), kMinWavelengthNm);
  const double high = std::min<double>(material.index.high_nm(), kMaxWavelengthNm);
  const DataRange data{material.index.low_nm(), material.index.high_nm()};
  for (const double nm : wavelengths_nm)
    if (data.contains(nm) && !(nm >= low && nm <= high))
      throw Error(
          ErrorCode::usage, where,
          fmt::format("outside the wavelengths that Abbe supports, although {} has data there (got {} nm, "
                      "allowed [{:g}, {:g}] nm)",
                      material.name, nm, low, high));
  require_between(material.name, low, high, wavelengths_nm, where);
}

void require_k_at(const NamedIndex& material, std::span<const double> wavelengths_nm,
                  const std::string& where) {
  const auto& k = material.index.k_range();
  for (const double nm : wavelengths_nm)
    if (k && material.index.catalogued_k(nm) > kLargestGlassK)
      require_between("the k of " + material.name, k->low_nm, k->high_nm, {&nm, 1}, where);
}

void require_between(const std::string& name, double low_nm, double high_nm,
                     std::span<const double> wavelengths_nm, const std::string& where) {
  for (const double nm : wavelengths_nm)
    if (!(nm >= low_nm && nm <= high_nm))
      throw Error(ErrorCode::usage, where,
                  fmt::format("{} has no data at this wavelength (got {} nm, allowed [{:g}, {:g}] nm)", name,
                              nm, low_nm, high_nm));
}

bool is_refractiveindex_info(const std::string& name) {
  return name.ends_with(".yml") || name.ends_with(".yaml");
}

std::optional<NamedIndex> load_index(const std::string& name, const SourcePosition& where,
                                     Diagnostics& diagnostics) {
  if (user_table_end(name) == name.size() || is_refractiveindex_info(name))
    return load_user_file(name, where, diagnostics);
  const Catalogue* plain = dielectrics(diagnostics);
  if (!plain) return std::nullopt;
  if (const auto row = plain->rows().find(name); row != plain->rows().end())
    return plain->load(row->second, plain->cell(row->second, "id"), diagnostics);
  for (const char* folder : kFolders) {
    if (const auto path = table_of(folder, name))
      return load_tables(folder, path->stem().string(), *path, where, diagnostics);
  }
  std::vector<std::string> glasses{qualified(name)};
  if (name.find('/') == std::string::npos) {
    glasses = all_glasses(diagnostics);
    std::erase_if(glasses,
                  [&](const std::string& glass) { return glass.substr(glass.find('/') + 1) != name; });
  }
  if (glasses.size() > 1) {
    diagnostics.error(where, fmt::format("several makers sell a glass \"{}\"; name one of {}", name,
                                         fmt::join(glasses, ", ")));
    return std::nullopt;
  }
  for (const Catalogue* catalogue : {plain, makers(diagnostics)}) {
    if (!catalogue) return std::nullopt;
    const auto row = catalogue->glasses().find(glasses.empty() ? "" : glasses.front());
    if (row != catalogue->glasses().end()) return catalogue->load(row->second, row->first, diagnostics);
  }
  report_unknown(name, where, diagnostics);
  return std::nullopt;
}

std::vector<std::string> index_names() {
  Diagnostics ignored;
  std::vector<std::string> names;
  if (const Catalogue* catalogue = dielectrics(ignored))
    for (const auto& [name, row] : catalogue->rows()) names.push_back(name);
  for (const char* folder : kFolders)
    for (const std::string& name : table_names(folder))
      if (name.find(':') == std::string::npos && table_of(folder, name)) names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> glass_names() {
  Diagnostics ignored;
  return all_glasses(ignored);
}

}  // namespace abbe
