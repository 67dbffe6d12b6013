#include "spectral/curve_use.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe {

namespace {
/// The unit or quantity that is allowed instead. `by_factor` is true if a factor may convert to it.
struct UnitMismatch {
  std::string_view allowed;
  bool by_factor = true;
};

constexpr UnitMismatch kLinearNeeded{
    "linear values: 10^x for log10 x, 10^-D for a density D, 10^(-A/10) for A dB", false};

struct QuantityUnit {
  std::string_view name;
  unsigned divisors;
};
std::optional<QuantityUnit> quantity_unit(CurveUnit quantity) {
  constexpr unsigned kPerNm = TableUnit::wavelength;
  switch (quantity) {
    case CurveUnit::spectral_radiance:
      return QuantityUnit{"W/(m^2 sr nm)", TableUnit::area | TableUnit::solid_angle | kPerNm};
    case CurveUnit::spectral_intensity:
      return QuantityUnit{"W/(sr nm)", TableUnit::solid_angle | kPerNm};
    case CurveUnit::spectral_irradiance:
      return QuantityUnit{"W/(m^2 nm)", TableUnit::area | kPerNm};
    case CurveUnit::spectral_flux:
      return QuantityUnit{"W/nm", kPerNm};
    default:
      return std::nullopt;
  }
}

std::optional<UnitMismatch> fraction_mismatch(const TableUnit& unit, UnitRole role) {
  switch (unit.kind) {
    case TableUnit::Kind::fraction:
    case TableUnit::Kind::relative:
      return std::nullopt;
    case TableUnit::Kind::percent:
      return UnitMismatch{"fractions of 1"};
    case TableUnit::Kind::logarithm:
      return kLinearNeeded;
    case TableUnit::Kind::unknown:
      return UnitMismatch{
          "fractions of 1: 1, 0-1, relative, electrons/photon or a name such as reflectance; put remarks "
          "after "
          "a \";\"",
          false};
    default:
      return role == UnitRole::factor ? std::nullopt : std::optional(UnitMismatch{"fractions of 1", false});
  }
}

// Factors of a coefficient may have units that are not listed, such as concentrations.
std::optional<UnitMismatch> coefficient_mismatch(const TableUnit& unit, UnitRole role) {
  if (unit.kind == TableUnit::Kind::logarithm)
    return UnitMismatch{"1/m for powers of e: ln 10 times the coefficient for powers of 10"};
  const bool is_coefficient = unit.kind == TableUnit::Kind::coefficient;
  if (is_coefficient ? unit.log10_factor == 0 : role == UnitRole::factor) return std::nullopt;
  return UnitMismatch{"1/m"};
}

std::optional<UnitMismatch> power_mismatch(const TableUnit& unit, CurveUnit needed, UnitRole role) {
  const auto quantity = quantity_unit(needed);
  const UnitMismatch other{quantity
                               ? quantity->name
                               : "power per nm: W/nm, W/(m^2 nm), W/(sr nm), W/(m^2 sr nm) or multiples, 1 "
                                 "or relative"};
  const bool is_factor = role == UnitRole::factor;
  switch (unit.kind) {
    case TableUnit::Kind::unknown:
      return other;
    case TableUnit::Kind::logarithm:
      return kLinearNeeded;
    case TableUnit::Kind::photons:
      if (is_factor) return std::nullopt;
      return UnitMismatch{"power per nm: hc/lambda for each photon", false};
    case TableUnit::Kind::coefficient:
      return is_factor ? std::nullopt : std::optional(other);
    case TableUnit::Kind::power:
      if (!quantity) return std::nullopt;
      return unit.log10_factor == 0 && (is_factor || unit.divisors == quantity->divisors)
                 ? std::nullopt
                 : std::optional(other);
    default:
      return std::nullopt;
  }
}

std::optional<UnitMismatch> unit_mismatch(const TableUnit& unit, CurveUnit needed, UnitRole role) {
  switch (needed) {
    case CurveUnit::any:
    case CurveUnit::unknown_response:
      return std::nullopt;
    case CurveUnit::fraction:
      return fraction_mismatch(unit, role);
    case CurveUnit::per_metre:
      return coefficient_mismatch(unit, role);
    default:
      return power_mismatch(unit, needed, role);
  }
}

using Kind = TableUnit::Kind;
using Words = std::vector<std::string_view>;

// Units that are no products, in lower case.
const std::vector<std::pair<Kind, Words>>& unit_words() {
  static const std::vector<std::pair<Kind, Words>> kWords{
      {Kind::fraction,
       {"1", "1.0", "0-1", "0..1", "w/w", "electrons per photon", "electrons/photon", "e-/photon"}},
      {Kind::percent, {"%", "percent", "per cent", "pct", "0-100", "0-100 %"}},
      {Kind::logarithm,
       {"db", "decibel", "od", "density", "optical density", "absorbance", "log", "log10", "ln", "base 10",
        "decadic"}},
      {Kind::relative,
       {"relative", "rel.", "normalised", "normalized", "norm.", "dimensionless", "unitless",
        "arbitrary units", "arb. u.", "a.u.", "counts"}},
      {Kind::coefficient, {"per metre", "per meter"}}};
  return kWords;
}
// Names of fractions, which need no unit.
constexpr std::array<std::string_view, 9> kFractionNames{"reflectance",    "transmittance", "transmission",
                                                         "transmissivity", "throughput",    "factor",
                                                         "efficiency",     "fraction",      "qe"};

struct Numerator {
  std::string_view symbol;
  Kind kind;
  int log10_factor = 0;
};
constexpr std::array<Numerator, 8> kNumerators{{{"W", Kind::power},
                                                {"mW", Kind::power, -3},
                                                {"uW", Kind::power, -6},
                                                {"kW", Kind::power, 3},
                                                {"1", Kind::coefficient},
                                                {"photons", Kind::photons},
                                                {"mol", Kind::photons},
                                                {"umol", Kind::photons}}};

struct DivisorSymbol {
  std::string_view symbol;  ///< After "/".
  std::string_view power;   ///< In a product without "/".
  TableUnit::Divisor divisor;
  int log10_factor = 0;
};
constexpr std::array<DivisorSymbol, 11> kDivisors{{{"m2", "m-2", TableUnit::area},
                                                   {"cm2", "cm-2", TableUnit::area, 4},
                                                   {"mm2", "mm-2", TableUnit::area, 6},
                                                   {"sr", "sr-1", TableUnit::solid_angle},
                                                   {"nm", "nm-1", TableUnit::wavelength},
                                                   {"um", "um-1", TableUnit::wavelength, -3},
                                                   {"Å", "Å-1", TableUnit::wavelength, 1},
                                                   {"s", "s-1", TableUnit::time},
                                                   {"m", "m-1", TableUnit::length},
                                                   {"cm", "cm-1", TableUnit::length, 2},
                                                   {"mm", "mm-1", TableUnit::length, 3}}};

// Signs and their replacement, so that "W·m⁻²" and "W m^-2" become "W m-2".
constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kReplacements{{{"⁻", "-"},
                                                                                       {"−", "-"},
                                                                                       {"–", "-"},
                                                                                       {"¹", "1"},
                                                                                       {"²", "2"},
                                                                                       {"µ", "u"},
                                                                                       {"μ", "u"},
                                                                                       {"\u212B", "Å"},
                                                                                       {"·", " "},
                                                                                       {"*", " "},
                                                                                       {"^", ""},
                                                                                       {"{", ""},
                                                                                       {"}", ""},
                                                                                       {"\t", " "}}};

std::string plain_text(std::string_view line) {
  std::string plain;
  while (!line.empty()) {
    const auto sign = std::ranges::find_if(
        kReplacements, [line](const auto& replacement) { return line.starts_with(replacement.first); });
    const bool found = sign != kReplacements.end();
    plain += found ? sign->second : line.substr(0, 1);
    line.remove_prefix(found ? sign->first.size() : 1);
  }
  return plain;
}

// Parts of a text between commas, semicolons, brackets and parentheses, except for "/(...)".
std::vector<std::string> parts_of(std::string_view text) {
  std::string separated;
  bool divides = false;
  for (const char sign : text) {
    if (sign == '(' && separated.ends_with('/')) divides = true;
    const bool separates = std::string_view(",;()[]").find(sign) != std::string_view::npos && !divides;
    if (sign == ')') divides = false;
    separated += separates ? '\n' : sign;
  }
  std::vector<std::string> parts = split(separated, '\n');
  std::erase(parts, "");
  return parts;
}

std::optional<TableUnit> product_of(std::string text) {
  const bool divides = text.find('/') != text.npos;
  if (divides)
    std::ranges::replace_if(
        text, [](char sign) { return sign == '/' || sign == '(' || sign == ')'; }, ' ');
  std::istringstream stream(text);
  const std::vector<std::string> symbols{std::istream_iterator<std::string>(stream), {}};
  if (symbols.empty()) return std::nullopt;

  const auto numerator = std::ranges::find(kNumerators, symbols.front(), &Numerator::symbol);
  const bool has_numerator = numerator != kNumerators.end();
  if (divides && (!has_numerator || symbols.size() == 1)) return std::nullopt;
  TableUnit unit =
      has_numerator ? TableUnit{numerator->kind, 0, numerator->log10_factor} : TableUnit{Kind::coefficient};
  for (const std::string& symbol : std::span(symbols).subspan(has_numerator ? 1 : 0)) {
    const auto entry =
        std::ranges::find(kDivisors, symbol, divides ? &DivisorSymbol::symbol : &DivisorSymbol::power);
    if (entry == kDivisors.end() || (unit.divisors & entry->divisor) != 0) return std::nullopt;
    unit.divisors |= entry->divisor;
    unit.log10_factor += entry->log10_factor;
  }
  const unsigned others = unit.divisors & (TableUnit::length | TableUnit::time);
  const bool is_allowed = unit.kind == Kind::coefficient ? unit.divisors == TableUnit::length
                                                         : unit.kind == Kind::photons || others == 0;
  return is_allowed ? std::optional(unit) : std::nullopt;
}

// Unit that a part consists of or that follows "in", as in "reflectance in percent".
std::optional<TableUnit> unit_of(const std::string& part) {
  const std::string small = lower_case(part);
  for (const auto& [kind, words] : unit_words())
    if (std::ranges::count(words, small) != 0) return TableUnit{kind};
  if (const auto product = product_of(part)) return product;
  const std::size_t in = (" " + part).rfind(" in ");
  return in == std::string::npos ? std::nullopt : unit_of(part.substr(in + 3));
}

bool contains(std::string_view text, std::string_view words) {
  return text.find(words) != text.npos;
}

// A relative quantity per something else than nm or a photon needs a conversion.
TableUnit relative_unit(const std::string& quantity) {
  const bool per_photon = contains(quantity, " per photon");
  if (contains(quantity, "photon") && !per_photon) return {Kind::photons};
  return {contains(quantity, " per ") && !per_photon && !contains(quantity, " per nm") ? Kind::unknown
                                                                                       : Kind::relative};
}

TableUnit unit_of_names(const std::vector<std::string>& parts) {
  const std::string quantity = parts.empty() ? "" : lower_case(parts.front());
  for (const std::string_view word : {"relative ", "normalised ", "normalized "})
    if (quantity.starts_with(word)) return relative_unit(quantity);
  for (const std::string& part : parts)
    for (const std::string_view name : kFractionNames)
      if (const std::string small = lower_case(part);
          small == name || small.ends_with(" " + std::string(name)))
        return {Kind::fraction};
  return {};
}

// True if the quantity of the line mentions photons or quantum efficiencies, or a unit after it divides by
// photons. Lines that mention energy declare no response per photon.
bool declares_response_per_photon(std::string_view line) {
  const std::string small = lower_case(line.substr(0, line.find(';')));
  const std::vector<std::string> parts = parts_of(small);
  if (parts.empty() || contains(small, "energy")) return false;
  const std::string& quantity = parts.front();
  return contains(quantity, "photon") || contains(quantity, "quantum") || contains(" " + quantity, " qe") ||
         contains(small, "/photon") || contains(small, "per photon");
}
}  // namespace

std::optional<std::string> unit_fault(std::string_view name, std::string_view unit, CurveUnit needed,
                                      std::string_view remedy, UnitRole role) {
  const auto mismatch = unit_mismatch(table_unit(unit), needed, role);
  if (!mismatch) return std::nullopt;
  return fmt::format("\"{}\" has the wrong unit (got \"{}\", allowed {}{})", name, unit, mismatch->allowed,
                     mismatch->by_factor ? remedy : std::string_view());
}

std::optional<std::string> relative_power(std::string_view name, std::string_view unit, CurveUnit needed) {
  const auto quantity = quantity_unit(needed);
  const TableUnit::Kind kind = table_unit(unit).kind;
  if (!quantity || (kind != TableUnit::Kind::relative && kind != TableUnit::Kind::percent))
    return std::nullopt;
  return fmt::format("\"{}\" is used in {}, but its unit is \"{}\": scale the emission to a quantity", name,
                     quantity->name, unit);
}

bool declares_power(std::string_view unit) {
  return table_unit(unit).kind == TableUnit::Kind::power;
}

std::optional<std::string> unknown_response(std::string_view name, std::string_view unit) {
  if (!declares_response_per_photon(unit)) return std::nullopt;
  return fmt::format(
      "\"{}\" is used as a response to energy, but its unit is \"{}\": set the response to energy or "
      "quantum",
      name, unit);
}

bool check_use(const std::string& name, const std::string& unit, const Curve& curve, const CurveUse& use,
               const SourcePosition& where, Diagnostics& diagnostics) {
  const auto wrong_unit = unit_fault(name, unit, use.unit);
  if (wrong_unit) diagnostics.error(where, *wrong_unit, ErrorCode::input);
  const auto wrong_value = value_fault(curve, use.allowed);
  if (wrong_value) diagnostics.error(where, fmt::format("\"{}\": {}", name, *wrong_value), ErrorCode::input);
  return !wrong_unit && !wrong_value;
}

std::optional<NamedCurve> load_curve(const CurveUse& use, const std::string& name,
                                     const SourcePosition& where, Diagnostics& diagnostics,
                                     NeededRange needed) {
  auto curve = load_curve(use.folder, name, where, diagnostics, needed);
  if (!curve || !check_use(name, curve->unit, curve->curve, use, where, diagnostics)) return std::nullopt;
  return curve;
}

TableUnit table_unit(std::string_view line) {
  const std::string plain = plain_text(line);
  for (const std::string& part : parts_of(plain))
    if (const auto unit = unit_of(part); unit && unit->kind == Kind::logarithm) return *unit;
  const std::vector<std::string> parts = parts_of(std::string_view(plain).substr(0, plain.find(';')));
  for (const std::string& part : parts)
    if (const auto unit = unit_of(part)) return *unit;
  return unit_of_names(parts);
}

}  // namespace abbe
