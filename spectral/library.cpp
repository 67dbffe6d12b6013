#include "spectral/library.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "io/text.h"
#include "spectral/curve_use.h"
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

/// Wavelengths of a table [nm], strictly ascending.
std::optional<std::vector<double>> wavelengths(const Table& table, Diagnostics& diagnostics) {
  const auto nm = table.column("wavelength_nm");
  const auto um = table.column("wavelength_um");
  if (!nm && !um) return diagnostics.refuse(table.where, "no column \"wavelength_nm\"", ErrorCode::input);
  if (nm != 0 && um != 0)
    return diagnostics.refuse(
        table.where,
        fmt::format("first column \"{}\" (allowed wavelength_nm, wavelength_um)", table.columns.front()),
        ErrorCode::input);
  auto values = table.numbers(nm ? *nm : *um, diagnostics);
  if (!values) return std::nullopt;
  if (!nm)
    for (double& value : *values) value *= kNmPerUm;
  if (values->size() < 2)
    return diagnostics.refuse(table.where, fmt::format("needs at least two samples (got {})", values->size()),
                              ErrorCode::input);
  const auto fall = std::ranges::adjacent_find(*values, std::greater_equal<>{});
  if (fall != values->end())
    return diagnostics.refuse(
        table.position(static_cast<std::size_t>(fall - values->begin()) + 1),
        fmt::format("wavelengths must ascend (got {} nm after {} nm)", *std::next(fall), *fall),
        ErrorCode::input);
  if (auto fault = range_fault(values->front(), values->back()))
    return diagnostics.refuse(table.where, std::move(*fault), ErrorCode::input);
  return values;
}

std::optional<std::size_t> value_column(const Table& table, const std::string& name,
                                        Diagnostics& diagnostics) {
  std::vector<std::string> names;
  std::ranges::copy_if(table.columns, std::back_inserter(names),
                       [](const std::string& column) { return !column.starts_with("wavelength_"); });
  if (name.empty())
    return diagnostics.refuse(
        table.where,
        fmt::format("has several curves, name one as file:column (allowed {})", fmt::join(names, ", ")),
        ErrorCode::input);
  const auto column = table.column(name);
  if (!column) diagnostics.error(table.where, unknown_name("column", name, names), ErrorCode::input);
  return column;
}

std::optional<Samples> samples_of(const Table& table, const std::string& column, Diagnostics& diagnostics) {
  auto nm = wavelengths(table, diagnostics);
  const auto values_at = value_column(table, column, diagnostics);
  if (!nm || !values_at) return std::nullopt;
  auto values = table.numbers(*values_at, diagnostics);
  if (!values) return std::nullopt;
  return Samples{*std::move(nm), *std::move(values)};
}

/// A line `# key: value` of a table, with its position in the file.
struct KeyLine {
  std::string value;
  SourcePosition where;
};
std::optional<KeyLine> key_line(const Table& table, const std::string& key) {
  const auto entry = table.keys.find(key);
  if (entry == table.keys.end()) return std::nullopt;
  std::size_t offset = 0;
  for (const std::string& line : split(table.where.source->text, '\n')) {
    if (line.starts_with('#') && line.find(':') < line.npos && split(line.substr(1), ':').front() == key)
      break;
    offset = table.where.source->text.find('\n', offset) + 1;
  }
  return KeyLine{entry->second, {table.where.source, offset, ""}};
}

// Reports a misspelt governing key, which would otherwise be ignored like a remark.
bool check_keys(const Table& table, Diagnostics& diagnostics) {
  const std::vector<std::string>& known = governing_keys();
  for (const auto& [key, value] : table.keys) {
    if (std::find(known.begin(), known.end(), key) != known.end() || !nearest_name(key, known)) continue;
    diagnostics.error(key_line(table, key)->where, unknown_name("key", key, known), ErrorCode::input);
    return false;
  }
  return true;
}

std::optional<Interpolation> interpolation_of(const Table& table, std::span<const double> wavelengths_nm,
                                              Diagnostics& diagnostics) {
  const auto line = key_line(table, "interpolation");
  if (!line) return Interpolation::linear;
  const std::vector<std::string> names{"linear", "sprague", "cubic"};
  const auto name = std::ranges::find(names, line->value);
  if (name == names.end())
    return diagnostics.refuse(line->where, unknown_name("interpolation", line->value, names),
                              ErrorCode::input);
  const auto rule = static_cast<Interpolation>(name - names.begin());
  const auto fault = interpolation_fault(wavelengths_nm, rule);
  if (!fault) return rule;
  return diagnostics.refuse(
      table.position(fault->row),
      rule == Interpolation::sprague
          ? fmt::format("\"interpolation: sprague\" needs six samples or more in even steps (got "
                        "{}); declare \"cubic\" or \"linear\"",
                        fault->text)
          : fmt::format("\"interpolation: cubic\" needs more samples (got {})", fault->text),
      ErrorCode::input);
}

/// Range of the quantity of a table. All samples must lie in it.
std::optional<Range> value_range(const Table& table, std::span<const double> values,
                                 Diagnostics& diagnostics) {
  const auto line = key_line(table, "value_range");
  const bool signed_values = std::ranges::any_of(values, [](double v) { return v < 0; });
  if (!line) return signed_values ? Range::any() : Range::non_negative();
  std::vector<std::optional<double>> ends;
  for (const std::string& end : split(line->value, ',')) ends.push_back(parse_number(end));
  if (ends.size() != 2 || !ends[0] || !ends[1] || !(*ends[0] < *ends[1]))
    return diagnostics.refuse(
        line->where,
        fmt::format("malformed range (got \"{}\", allowed two ascending numbers, as \"0, 1\")", line->value),
        ErrorCode::input);
  const Range range{*ends[0], *ends[1]};
  const auto out_of_range = std::ranges::find_if(values, [&](double v) { return !range.contains(v); });
  if (out_of_range == values.end()) return range;
  return diagnostics.refuse(
      table.position(static_cast<std::size_t>(out_of_range - values.begin())),
      fmt::format("value outside the declared range (got {}, allowed {})", *out_of_range, range.text()),
      ErrorCode::input);
}

/// A table of a folder, and the name of one of its columns.
struct NamedColumn {
  Table table;
  std::string column;
};
std::optional<NamedColumn> read_named(std::string_view folder, const std::string& name,
                                      const SourcePosition& where, Diagnostics& diagnostics) {
  const auto location = find_table(folder, name, where, diagnostics);
  if (!location) return std::nullopt;
  auto table = read_table(location->path, origin(location->path), diagnostics);
  if (!table) return std::nullopt;
  return NamedColumn{*std::move(table), location->column};
}

/// S = 100 (560/l)^5 (exp(c2/560) - 1)/(exp(c2/l) - 1), c2 = 1.435e7/2848 nm [CIE15, sec. 3.1].
double illuminant_a(double wavelength_nm) {
  constexpr double kSecond = 1.435e7 / 2848;
  return 100 * std::pow(560 / wavelength_nm, 5) * std::expm1(kSecond / 560) /
         std::expm1(kSecond / wavelength_nm);
}

void extend_a(NamedCurve& a) {
  std::vector<Knot> knots;
  for (const Knot& knot : a.curve.knots())
    if (knot.wavelength_nm <= a.high_nm) knots.push_back(knot);
  for (int nm = static_cast<int>(a.high_nm) + 1; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({static_cast<double>(nm), illuminant_a(nm)});
  a.curve = Curve(std::move(knots));
  a.high_nm = kMaxWavelengthNm;
}

// Extends illuminant A by its formula, and E by its equal power at all wavelengths.
void extend_by_definition(std::string_view name, NamedCurve& illuminant) {
  if (name == "A" || name == "cie_A" || name == "cie_A:A") extend_a(illuminant);
  if (name != "E" && name != "cie_E" && name != "cie_E:E") return;
  illuminant.curve = extrapolated(illuminant);
  illuminant.low_nm = kMinWavelengthNm;
  illuminant.high_nm = kMaxWavelengthNm;
}

/// Temperature of "family:<K>" if `name` is of that family. Reports a temperature outside [low, high] and
/// returns 0.
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

// Absolute value of a curve: exact at the knots, too large between two knots of different signs. No result
// depends on these.
Curve magnitude(const Curve& curve) {
  std::vector<Knot> knots(curve.knots().begin(), curve.knots().end());
  for (Knot& knot : knots) knot.value = std::abs(knot.value);
  return Curve(std::move(knots));
}

// Wavelength of the last knot, in the given order, up to which the integral does not exceed `integral`.
double last_within(std::span<const Knot> knots, double integral) {
  double total = 0;
  std::size_t i = 0;
  for (; i + 1 < knots.size(); ++i) {
    const double width_nm = std::abs(knots[i + 1].wavelength_nm - knots[i].wavelength_nm);
    total += width_nm * (knots[i].value + knots[i + 1].value) / 2;
    if (total > integral) break;
  }
  return knots[i].wavelength_nm;
}

// Range between the knots that enclose all nonzero values. Its ends are swapped if there are none.
NeededRange support_range(const Curve& curve) {
  const std::span<const Knot> knots = curve.knots();
  const auto is_nonzero = [](const Knot& knot) { return knot.value != 0; };
  const auto first = std::find_if(knots.begin(), knots.end(), is_nonzero);
  if (first == knots.end()) return {kMaxWavelengthNm, kMinWavelengthNm};
  const auto after = std::find_if(knots.rbegin(), knots.rend(), is_nonzero).base();
  return {(first == knots.begin() ? first : std::prev(first))->wavelength_nm,
          (after == knots.end() ? std::prev(after) : after)->wavelength_nm};
}

struct Integral {
  double value = 0;
  std::size_t pieces = 0;
};

// Integral of |a b| over a range; exact unless a factor changes sign between two knots.
Integral magnitude_of_product(const Curve& a, const Curve& b, double low_nm, double high_nm) {
  CurveCursor piece_a(a, low_nm);
  CurveCursor piece_b(b, low_nm);
  const auto magnitude = [&](double nm) { return std::abs(piece_a(nm) * piece_b(nm)); };
  Integral sum;
  for (double from = low_nm; from < high_nm; ++sum.pieces) {
    const double to = std::min({piece_a.end_nm(), piece_b.end_nm(), high_nm});
    // Simpson's rule is exact for the product of two lines.
    sum.value += (to - from) / 6 * (magnitude(from) + 4 * magnitude((from + to) / 2) + magnitude(to));
    piece_a.advance_to(to);
    piece_b.advance_to(to);
    from = to;
  }
  return sum;
}
}  // namespace

std::optional<NamedCurve> load_curve(std::string_view folder, const std::string& name,
                                     const SourcePosition& where, Diagnostics& diagnostics,
                                     NeededRange needed) {
  const auto read = read_named(folder, name, where, diagnostics);
  auto curve = read ? curve_of(read->table, read->column, name, diagnostics, needed) : std::nullopt;
  if (curve && folder == kIlluminantUse.folder) extend_by_definition(name, *curve);
  return curve;
}

Curve shipped_curve(std::string_view folder, const std::string& name) {
  Diagnostics diagnostics;
  auto loaded = load_curve(folder, name, {}, diagnostics);
  if (!loaded) throw Error(ErrorCode::input, name, diagnostics.text());
  return std::move(loaded->curve);
}

std::optional<TableSamples> load_samples(std::string_view folder, const std::string& name,
                                         const SourcePosition& where, Diagnostics& diagnostics) {
  auto read = read_named(folder, name, where, diagnostics);
  if (!read) return std::nullopt;
  auto samples = samples_of(read->table, read->column, diagnostics);
  if (!samples || !interpolation_of(read->table, samples->wavelengths_nm, diagnostics) ||
      !value_range(read->table, samples->values, diagnostics))
    return std::nullopt;
  return TableSamples{std::move(read->table), *std::move(samples)};
}

std::optional<std::string> value_fault(const Curve& curve, const Range& allowed) {
  for (const Knot& knot : curve.knots())
    if (!allowed.contains(knot.value))
      return fmt::format("curve out of range at {} nm (got {}, allowed {})", knot.wavelength_nm, knot.value,
                         allowed.text());
  return std::nullopt;
}

std::optional<NamedCurve> curve_of(const Table& table, const std::string& column, const std::string& name,
                                   Diagnostics& diagnostics, NeededRange needed) {
  const auto samples = samples_of(table, column, diagnostics);
  if (!samples || !check_keys(table, diagnostics)) return std::nullopt;
  const auto rule = interpolation_of(table, samples->wavelengths_nm, diagnostics);
  const auto range = value_range(table, samples->values, diagnostics);
  if (!rule || !range) return std::nullopt;
  const Samples fine = every_nanometre(*samples, *rule, range->low, range->high);
  NamedCurve result{name,
                    table.provenance.source,
                    table.provenance.unit,
                    samples->wavelengths_nm.front(),
                    samples->wavelengths_nm.back(),
                    table_curve(fine.wavelengths_nm, fine.values, table.outside),
                    table.outside};
  const bool is_covered = result.low_nm <= needed.low_nm && result.high_nm >= needed.high_nm;
  if (table.outside != Outside::error || is_covered) return result;
  return diagnostics.refuse(
      table.where,
      fmt::format("covers {} to {} nm, but {} to {} nm are needed (add a line \"# outside: clamp\" or "
                  "\"# outside: zero\" to extrapolate)",
                  result.low_nm, result.high_nm, needed.low_nm, needed.high_nm),
      ErrorCode::input);
}

std::optional<std::string> range_fault(double low_nm, double high_nm) {
  if (high_nm > kMinWavelengthNm && low_nm < kMaxWavelengthNm) return std::nullopt;
  return fmt::format("wavelengths from {} to {} nm lie outside [{}, {}] nm; is the unit right?", low_nm,
                     high_nm, kMinWavelengthNm, kMaxWavelengthNm);
}

NamedCurve named_daylight(double kelvin) {
  return {fmt::format("daylight:{}", kelvin),
          "CIE 15 daylight of that correlated colour temperature",
          "relative, 100 at 560 nm",
          300,
          830,
          daylight(kelvin),
          Outside::zero};
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
    NamedCurve day = named_daylight(*kelvin);
    day.name = name;
    return day;
  }
  return load_curve(kIlluminantUse, name, where, diagnostics, needed);
}

FractionOutside fraction_outside(const Curve& weight, const Curve& light, double low_nm, double high_nm) {
  const NeededRange support = support_range(weight);
  if (support.low_nm >= low_nm && support.high_nm <= high_nm) return {};
  const double from = std::clamp(low_nm, support.low_nm, support.high_nm);
  const double to = std::clamp(high_nm, support.low_nm, support.high_nm);
  const Integral below = magnitude_of_product(weight, light, support.low_nm, from);
  const Integral within = magnitude_of_product(weight, light, from, to);
  const Integral above = magnitude_of_product(weight, light, to, support.high_nm);
  const double outside = below.value + above.value;
  return {outside > 0 ? outside / (outside + within.value) : 0, below.pieces + within.pieces + above.pieces};
}

NeededRange main_range(const Curve& curve) {
  const Curve all = magnitude(curve);
  const double negligible = kNegligibleFraction * all.integral();
  const std::vector<Knot> upwards(all.knots().begin(), all.knots().end());
  const std::vector<Knot> downwards(upwards.rbegin(), upwards.rend());
  return {std::floor(last_within(upwards, negligible)), std::ceil(last_within(downwards, negligible))};
}

Curve extrapolated(const NamedCurve& table) {
  std::vector<Knot> knots;
  for (const Knot& knot : table.curve.knots()) {
    if (knot.wavelength_nm < table.low_nm || knot.wavelength_nm > table.high_nm) continue;
    if (knot.wavelength_nm == table.low_nm)
      knots.clear();  // at a rise from 0, the upper knot is the first row
    knots.push_back(knot);
  }
  return Curve(std::move(knots));
}

}  // namespace abbe
