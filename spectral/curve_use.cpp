#include "spectral/curve_use.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "spectral/unit_line.h"

namespace abbe {
namespace {

/// The unit or quantity that is allowed instead. `by_factor` is true if a factor converts to it.
struct UnitMismatch {
  std::string_view allowed;
  bool by_factor = true;
};

std::optional<UnitMismatch> fraction_mismatch_in_words(const UnitLine& line) {
  static const Phrases kDecibels{"db", "decibel", "decibels"};
  static const Phrases kDensities{"optical density", "density",    "od",
                                  "absorbance",      "extinction", "attenuation"};
  if (declares_percent(line)) return UnitMismatch{"fractions of 1"};
  if (declares(line, kDecibels)) return UnitMismatch{"fractions of 1: 10^(-A/10) for A dB", false};
  if (declares(line, kDensities)) return UnitMismatch{"fractions of 1: 10^-D for a density D", false};
  return std::nullopt;
}

// A fraction has no unit, but "electrons per photon" is a fraction too.
std::optional<UnitMismatch> fraction_mismatch(const UnitLine& line) {
  if (auto prose = fraction_mismatch_in_words(line)) return prose;
  if (line.unit && line.unit->of(Unit::photon) >= 0) return UnitMismatch{"fractions of 1", false};
  return std::nullopt;
}

bool declares_photons(const UnitLine& line) {
  static const Phrases kPhotons{"photon",       "photons",       "photon flux",     "photon flux density",
                                "photon count", "photon counts", "photon radiance", "photon irradiance",
                                "quanta",       "moles",         "micromoles",      "ppfd"};
  return line.unit ? line.unit->of(Unit::photon) > 0 : declares(line, kPhotons);
}

bool declares_wavenumbers(const UnitLine& line) {
  return line.unit ? line.unit->of(Unit::watt) > 0 && line.unit->per_wavenumber
                   : declares(line, {"per wavenumber", "per cm-1", "per cm^-1", "per 1/cm"});
}

std::optional<UnitMismatch> power_mismatch(const UnitLine& line) {
  if (declares_photons(line)) return UnitMismatch{"power per nm: hc/lambda for each photon", false};
  if (declares_wavenumbers(line))
    return UnitMismatch{"power per nm: 10^7 nm cm^-1/lambda^2 times that per cm^-1", false};
  if (!line.unit && declares(line, {"db", "dbm", "decibel", "decibels"}))
    return UnitMismatch{"power per nm: 10^(A/10) for A dB", false};
  if (line.unit && line.unit->of(Unit::hertz) < 0)
    return UnitMismatch{"power per nm: c/lambda^2 times that per Hz", false};
  if (line.unit && line.unit->of(Unit::electronvolt) < 0)
    return UnitMismatch{"power per nm: hc/lambda^2 times that per unit of energy", false};
  return std::nullopt;
}

std::string_view name_of(CurveUnit quantity) {
  switch (quantity) {
    case CurveUnit::spectral_radiance:
      return "W/(m^2 sr nm)";
    case CurveUnit::spectral_intensity:
      return "W/(sr nm)";
    case CurveUnit::spectral_irradiance:
      return "W/(m^2 nm)";
    case CurveUnit::spectral_flux:
      return "W/nm";
    default:
      return {};
  }
}

bool is_power(const UnitLine& line) {
  return line.unit && line.unit->of(Unit::watt) > 0;
}
bool is_relative(const UnitLine& line) {
  static const Phrases kRelative{"relative", "dimensionless", "unitless",   "arbitrary", "arb",   "a.u",
                                 "rel",      "normalised",    "normalized", "norm",      "count", "counts"};
  const auto is_so = [](std::string_view text) { return contains_phrase(text, kRelative); };
  return !is_power(line) &&
         (is_so(line.quantity) || std::any_of(line.additions.begin(), line.additions.end(), is_so) ||
          declares_percent(line));
}

std::optional<UnitMismatch> quantity_mismatch(const UnitLine& line, CurveUnit needed) {
  if (auto mismatch = power_mismatch(line)) return mismatch;
  const std::string_view allowed = name_of(needed);
  if (!line.unit || is_relative(line) || line.unit->equals(leading_unit(allowed).value()))
    return std::nullopt;
  return UnitMismatch{allowed, line.unit->of(Unit::lumen) == 0};
}

// True for coefficients of powers of 10. Tables declare them, often in a remark; coefficients of powers of e
// need no word. A remark can also name what the values were converted from.
bool is_decadic(const UnitLine& line) {
  static const Phrases kDecadic{"decadic", "base 10", "base-10", "base ten", "log10", "log 10", "log_10"};
  static const Phrases kNatural{"natural", "napierian", "neperian", "base e",
                                "ln 10",   "ln(10)",    "2.3",      "converted from"};
  if (contains_phrase(line.text, kNatural)) return false;
  const std::size_t remark = line.text.find(';');
  return contains_phrase(line.quantity, kDecadic) || declares(line, kDecadic) ||
         (remark != line.text.npos &&
          declares(unit_line(std::string_view(line.text).substr(remark + 1)), kDecadic));
}

bool is_per_length(const UnitLine& line) {
  static const Unit kPerMetre = leading_unit("1/m").value();
  return line.unit && line.unit->exponents == kPerMetre.exponents;
}

std::optional<UnitMismatch> coefficient_mismatch(const UnitLine& line) {
  if (!is_per_length(line) || line.unit->log10_factor != 0) return UnitMismatch{"1/m"};
  if (is_decadic(line))
    return UnitMismatch{"1/m for powers of e: ln 10 times the coefficient for powers of 10"};
  return std::nullopt;
}

std::optional<UnitMismatch> unit_mismatch(const UnitLine& line, CurveUnit needed) {
  switch (needed) {
    case CurveUnit::fraction:
      return fraction_mismatch(line);
    case CurveUnit::per_metre:
      return coefficient_mismatch(line);
    case CurveUnit::power:
      return power_mismatch(line);
    case CurveUnit::spectral_radiance:
    case CurveUnit::spectral_intensity:
    case CurveUnit::spectral_irradiance:
    case CurveUnit::spectral_flux:
      return quantity_mismatch(line, needed);
    case CurveUnit::any:
    case CurveUnit::unknown_response:
      return std::nullopt;
  }
  return std::nullopt;
}

// True for products of watts per nm, m^2 and sr. An odd power of lengths contains a wavelength.
bool is_in_watts_per_nm(const Unit& unit) {
  constexpr double kPerNm = 9;
  constexpr double kRounding = 1e-6;
  return unit.of(Unit::ampere) == 0 &&
         std::abs(unit.log10_factor - (unit.of(Unit::metre) % 2 != 0 ? kPerNm : 0)) < kRounding;
}

// Checks one factor of a product. Other factors can convert photons to power, or relative values to radiance,
// but none corrects a multiple of the needed unit.
std::optional<UnitMismatch> factor_mismatch(const UnitLine& line, CurveUnit needed) {
  if (needed == CurveUnit::fraction) return fraction_mismatch_in_words(line);
  if (needed == CurveUnit::per_metre && is_per_length(line)) return coefficient_mismatch(line);
  if (name_of(needed).empty() || power_mismatch(line) || !is_power(line) || is_in_watts_per_nm(*line.unit))
    return std::nullopt;
  return UnitMismatch{name_of(needed)};
}

// True if the unit line declares a response per photon, by its quantity or by a divisor.
bool is_per_photon(const UnitLine& line) {
  const auto of_energy = [](std::string_view text) { return contains_phrase(text, {"energy"}); };
  const auto divides = [](std::string_view text) {
    return text.find("/photon") != text.npos || contains_phrase(text, {"per photon"});
  };
  if (of_energy(line.quantity) || std::any_of(line.additions.begin(), line.additions.end(), of_energy))
    return false;
  return contains_phrase(line.quantity, {"photon", "photons", "quantum", "qe"}) ||
         std::any_of(line.additions.begin(), line.additions.end(), divides);
}

// A coefficient declares its logarithm by the word for it, and prose does not declare its unit.
bool accepts_ambiguous_unit(CurveUnit needed) {
  return needed == CurveUnit::any || needed == CurveUnit::unknown_response || needed == CurveUnit::per_metre;
}

// True for a table of logarithms, such as "log10 W/nm" and "radiance (log)". "log" and "ln" count alone or
// before a unit or a quantity, so "log book" is none.
bool is_of_logarithms(std::string_view text, const UnitLine& line) {
  static const Phrases kLogged{"radiance", "irradiance",  "intensity",     "flux",     "power", "energy",
                               "spectral", "reflectance", "transmittance", "relative", "scale"};
  if (declares(line, {"log10", "log_10", "logarithm", "logarithmic"})) return true;
  for (const std::string_view sign : {"log 10", "log", "ln"}) {
    if (line.quantity == sign || std::count(line.additions.begin(), line.additions.end(), sign) != 0)
      return true;
    if (!line.quantity.starts_with(std::string(sign) + ' ')) continue;
    std::string_view rest = text.substr(line.text.find(sign) + sign.size() + 1);
    if (rest.starts_with("of ")) rest.remove_prefix(3);
    const UnitLine logged = unit_line(rest.substr(0, rest.find_first_of(" ,;")));
    if (logged.unit || std::count(kLogged.begin(), kLogged.end(), logged.quantity) != 0) return true;
  }
  return false;
}

// A light that is scaled may have any unit with any divisor, such as "W/nm/lamp".
bool accepts_unknown_factor(CurveUnit needed) {
  return accepts_ambiguous_unit(needed) || needed == CurveUnit::power;
}

using Rule = std::optional<UnitMismatch> (*)(const UnitLine&, CurveUnit);

std::optional<std::string> describe_mismatch(Rule rule, std::string_view name, std::string_view unit,
                                             CurveUnit needed, std::string_view remedy) {
  const UnitLine line = unit_line(unit);
  if (!accepts_unknown_factor(needed) && line.unit && line.unit->has_unknown_factor)
    return fmt::format(
        "\"{}\" has a unit that cannot be parsed (got \"{}\", allowed {}; put remarks after a \";\")", name,
        unit, needed == CurveUnit::fraction ? "fractions of 1" : "products such as W/(m^2 nm)");
  const std::optional<UnitMismatch> mismatch =
      !accepts_ambiguous_unit(needed) && is_of_logarithms(unit, line)
          ? std::optional(UnitMismatch{"linear values: 10^x for log10 x, e^x for ln x", false})
          : rule(line, needed);
  if (!mismatch) return std::nullopt;
  return fmt::format("\"{}\" has the wrong unit (got \"{}\", allowed {}{})", name, unit, mismatch->allowed,
                     mismatch->by_factor ? remedy : std::string_view());
}

}  // namespace

std::optional<std::string> unit_fault(std::string_view name, std::string_view unit, CurveUnit needed,
                                      std::string_view remedy) {
  return describe_mismatch(unit_mismatch, name, unit, needed, remedy);
}

std::optional<std::string> factor_unit_fault(std::string_view name, std::string_view unit, CurveUnit needed,
                                             std::string_view remedy) {
  return describe_mismatch(factor_mismatch, name, unit, needed, remedy);
}

std::optional<std::string> relative_power(std::string_view name, std::string_view unit, CurveUnit needed) {
  const std::string_view allowed = name_of(needed);
  if (allowed.empty() || !is_relative(unit_line(unit))) return std::nullopt;
  return fmt::format("\"{}\" is used in {}, but its unit is \"{}\": scale the emission to a quantity", name,
                     allowed, unit);
}

bool declares_power(std::string_view unit) {
  return is_power(unit_line(unit));
}

std::optional<std::string> unknown_response(std::string_view name, std::string_view unit) {
  if (!is_per_photon(unit_line(unit))) return std::nullopt;
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
