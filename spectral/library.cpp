#include "spectral/library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "io/data_directory.h"
#include "io/table.h"
#include "io/text.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

constexpr double kNmPerUm = 1e3;

TableOrigin origin(const std::filesystem::path& path) {
  const std::filesystem::path& shipped = data_directory();
  const bool inside =
      std::mismatch(shipped.begin(), shipped.end(), path.begin(), path.end()).first == shipped.end();
  return inside ? TableOrigin::shipped : TableOrigin::user;
}

/// The wavelengths of a table [nm], strictly ascending.
std::optional<std::vector<double>> wavelengths(const Table& table, Diagnostics& diagnostics) {
  const auto nm = table.column("wavelength_nm");
  const auto um = table.column("wavelength_um");
  if (!nm && !um) {
    diagnostics.error(table.where, "no column \"wavelength_nm\"", ErrorCode::input);
    return std::nullopt;
  }
  auto values = table.numbers(nm ? *nm : *um, diagnostics);
  if (!values) return std::nullopt;
  if (!nm) {
    for (double& value : *values) value *= kNmPerUm;
  }
  if (values->size() < 2) {
    diagnostics.error(table.where, fmt::format("needs at least two samples (got {})", values->size()),
                      ErrorCode::input);
    return std::nullopt;
  }
  const auto fall = std::adjacent_find(values->begin(), values->end(), std::greater_equal<>{});
  if (fall != values->end()) {
    diagnostics.error(table.position(static_cast<std::size_t>(fall - values->begin()) + 1),
                      fmt::format("wavelengths must ascend (got {} nm after {} nm)", *std::next(fall), *fall),
                      ErrorCode::input);
    return std::nullopt;
  }
  if (auto fault = range_fault(values->front(), values->back())) {
    diagnostics.error(table.where, std::move(*fault), ErrorCode::input);
    return std::nullopt;
  }
  return values;
}

std::optional<std::size_t> value_column(const Table& table, const std::string& name,
                                        Diagnostics& diagnostics) {
  std::vector<std::string> names;
  std::copy_if(table.columns.begin(), table.columns.end(), std::back_inserter(names),
               [](const std::string& column) { return !column.starts_with("wavelength_"); });
  if (name.empty()) {
    diagnostics.error(
        table.where,
        fmt::format("has several curves, name one as file:column (allowed {})", fmt::join(names, ", ")),
        ErrorCode::input);
    return std::nullopt;
  }
  const auto column = table.column(name);
  if (!column) diagnostics.error(table.where, unknown_name("column", name, names), ErrorCode::input);
  return column;
}

bool covers(const NamedCurve& curve, const NeededRange& needed) {
  return curve.low_nm <= needed.low_nm && curve.high_nm >= needed.high_nm;
}

/// S = 100 (560/l)^5 (exp(c2/560) - 1)/(exp(c2/l) - 1), c2 = 1.435e7/2848 nm [CIE15, sec. 3.1].
double illuminant_a(double wavelength_nm) {
  constexpr double kSecond = 1.435e7 / 2848;
  return 100 * std::pow(560 / wavelength_nm, 5) * std::expm1(kSecond / 560) /
         std::expm1(kSecond / wavelength_nm);
}

void extend_by_definition(NamedCurve& a) {
  std::vector<Knot> knots;
  for (const Knot& knot : a.curve.knots()) {
    if (knot.wavelength_nm <= a.high_nm) knots.push_back(knot);
  }
  for (int nm = static_cast<int>(a.high_nm) + 1; nm <= kMaxWavelengthNm; ++nm) {
    knots.push_back({static_cast<double>(nm), illuminant_a(nm)});
  }
  a.curve = Curve(std::move(knots));
  a.high_nm = kMaxWavelengthNm;
}

/// The temperature of "family:<K>" if `name` is of that family; reports one that is not in [low, high] and
/// gives 0.
std::optional<double> temperature(std::string_view name, std::string_view family, double low, double high,
                                  const SourcePosition& where, Diagnostics& diagnostics) {
  if (!name.starts_with(family) || name.substr(family.size(), 1) != ":") return std::nullopt;
  const std::string_view text = name.substr(family.size() + 1);
  const auto kelvin = parse_number(text);
  if (kelvin && *kelvin >= low && *kelvin <= high) return kelvin;
  diagnostics.error(where,
                    fmt::format("{} temperature in K (got {}, allowed [{}, {}])", family, text, low, high));
  return 0;
}

}  // namespace

std::optional<NamedCurve> load_curve(std::string_view folder, const std::string& name,
                                     const SourcePosition& where, Diagnostics& diagnostics,
                                     NeededRange needed) {
  const auto found = find_table(folder, name, where, diagnostics);
  if (!found) return std::nullopt;
  const auto table = read_table(found->path, origin(found->path), diagnostics);
  return table ? curve_of(*table, found->column, name, diagnostics, needed) : std::nullopt;
}

std::optional<NamedCurve> curve_of(const Table& table, const std::string& column, const std::string& name,
                                   Diagnostics& diagnostics, NeededRange needed) {
  const auto nm = wavelengths(table, diagnostics);
  const auto values_at = value_column(table, column, diagnostics);
  if (!nm || !values_at) return std::nullopt;
  const auto values = table.numbers(*values_at, diagnostics);
  if (!values) return std::nullopt;
  NamedCurve result{name,
                    table.provenance.source,
                    table.provenance.unit,
                    nm->front(),
                    nm->back(),
                    table_curve(*nm, *values, table.outside)};
  if (table.outside == Outside::error && !covers(result, needed)) {
    diagnostics.error(
        table.where,
        fmt::format("covers {} to {} nm and declares \"outside: error\", but {} to {} nm are needed "
                    "(declare \"outside: clamp\" or \"outside: zero\" to say what holds there)",
                    result.low_nm, result.high_nm, needed.low_nm, needed.high_nm),
        ErrorCode::input);
    return std::nullopt;
  }
  return result;
}

std::optional<std::string> range_fault(double low_nm, double high_nm) {
  if (high_nm > kMinWavelengthNm && low_nm < kMaxWavelengthNm) return std::nullopt;
  return fmt::format("wavelengths from {} to {} nm lie outside [{}, {}] nm; is the unit right?", low_nm,
                     high_nm, kMinWavelengthNm, kMaxWavelengthNm);
}

std::optional<NamedCurve> load_illuminant(const std::string& name, const SourcePosition& where,
                                          Diagnostics& diagnostics, NeededRange needed) {
  if (const auto kelvin = temperature(name, "blackbody", 100, 1e6, where, diagnostics)) {
    if (*kelvin == 0) return std::nullopt;
    return NamedCurve{name,
                      "Planck's law",
                      "spectral radiance [W m^-2 sr^-1 nm^-1]",
                      kMinWavelengthNm,
                      kMaxWavelengthNm,
                      planck(*kelvin)};
  }
  if (const auto kelvin = temperature(name, "daylight", 4000, 25000, where, diagnostics)) {
    if (*kelvin == 0) return std::nullopt;
    return NamedCurve{name,
                      "CIE 15 daylight of that correlated colour temperature",
                      "relative, 100 at 560 nm",
                      300,
                      830,
                      daylight(*kelvin)};
  }
  auto illuminant = load_curve("illuminant", name, where, diagnostics, needed);
  if (illuminant && (name == "A" || name == "cie_A")) extend_by_definition(*illuminant);
  return illuminant;
}

}  // namespace abbe
