#include "spectral/curve_use.h"

#include <utility>

#include <fmt/format.h>

#include "spectral/unit.h"

namespace abbe {
namespace {

/// The unit or quantity that is allowed instead. `by_factor` is true if a factor may convert to it.
struct UnitMismatch {
  std::string_view allowed;
  bool by_factor = true;
};

constexpr UnitMismatch kLinearNeeded{
    "linear values: 10^x for log10 x, 10^-D for a density D, 10^(-A/10) for A dB", false};

/// Unit of a radiometric quantity.
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

/// `factor`: other factors of a product can convert from another quantity, but not from a multiple.
enum class UnitRole { whole, factor };

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

std::optional<std::string> describe_mismatch(UnitRole role, std::string_view name, std::string_view unit,
                                             CurveUnit needed, std::string_view remedy) {
  const auto mismatch = unit_mismatch(table_unit(unit), needed, role);
  if (!mismatch) return std::nullopt;
  return fmt::format("\"{}\" has the wrong unit (got \"{}\", allowed {}{})", name, unit, mismatch->allowed,
                     mismatch->by_factor ? remedy : std::string_view());
}

}  // namespace

std::optional<std::string> unit_fault(std::string_view name, std::string_view unit, CurveUnit needed,
                                      std::string_view remedy) {
  return describe_mismatch(UnitRole::whole, name, unit, needed, remedy);
}

std::optional<std::string> factor_unit_fault(std::string_view name, std::string_view unit, CurveUnit needed,
                                             std::string_view remedy) {
  return describe_mismatch(UnitRole::factor, name, unit, needed, remedy);
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

}  // namespace abbe
