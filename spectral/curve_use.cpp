#include "spectral/curve_use.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "spectral/told_unit.h"

namespace abbe {
namespace {

/// What is allowed in place of a unit, and whether a factor makes it of that.
struct Instead {
  std::string_view allowed;
  bool by_factor = true;
};

std::optional<Instead> instead_of_prose_of_share(const ToldUnit& told) {
  static const Phrases kDecibels{"db", "decibel", "decibels"};
  static const Phrases kDensities{"optical density", "density",    "od",
                                  "absorbance",      "extinction", "attenuation"};
  if (is_told_in_percent(told)) return Instead{"shares of 1"};
  if (is_told_as(told, kDecibels)) return Instead{"shares of 1: 10^(-A/10) of A dB", false};
  if (is_told_as(told, kDensities)) return Instead{"shares of 1: 10^-D of a density D", false};
  return std::nullopt;
}

// A share has no unit; "electrons per photon" may be one.
std::optional<Instead> instead_of_share(const ToldUnit& told) {
  if (auto prose = instead_of_prose_of_share(told)) return prose;
  if (told.unit && told.unit->of(Unit::photon) >= 0) return Instead{"shares of 1", false};
  return std::nullopt;
}

bool tells_photons(const ToldUnit& told) {
  static const Phrases kPhotons{"photon",       "photons",       "photon flux",     "photon flux density",
                                "photon count", "photon counts", "photon radiance", "photon irradiance",
                                "quanta",       "moles",         "micromoles",      "ppfd"};
  return told.unit ? told.unit->of(Unit::photon) > 0 : is_told_as(told, kPhotons);
}

bool tells_wavenumbers(const ToldUnit& told) {
  return told.unit ? told.unit->of(Unit::watt) > 0 && told.unit->per_wavenumber
                   : is_told_as(told, {"per wavenumber", "per cm-1", "per cm^-1", "per 1/cm"});
}

std::optional<Instead> instead_of_power(const ToldUnit& told) {
  if (tells_photons(told)) return Instead{"power per nm: hc/lambda for each photon", false};
  if (tells_wavenumbers(told))
    return Instead{"power per nm: 10^7 nm cm^-1/lambda^2 times that per cm^-1", false};
  if (!told.unit && is_told_as(told, {"db", "dbm", "decibel", "decibels"}))
    return Instead{"power per nm: 10^(A/10) of A dB", false};
  if (told.unit && told.unit->of(Unit::hertz) < 0)
    return Instead{"power per nm: c/lambda^2 times that per Hz", false};
  if (told.unit && told.unit->of(Unit::electronvolt) < 0)
    return Instead{"power per nm: hc/lambda^2 times that per unit of energy", false};
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

bool is_power(const ToldUnit& told) {
  return told.unit && told.unit->of(Unit::watt) > 0;
}
bool is_relative(const ToldUnit& told) {
  static const Phrases kRelative{"relative", "dimensionless", "unitless",   "arbitrary", "arb",   "a.u",
                                 "rel",      "normalised",    "normalized", "norm",      "count", "counts"};
  const auto is_so = [](std::string_view text) { return says(text, kRelative); };
  return !is_power(told) &&
         (is_so(told.quantity) || std::any_of(told.additions.begin(), told.additions.end(), is_so) ||
          is_told_in_percent(told));
}

std::optional<Instead> instead_of_quantity(const ToldUnit& told, CurveUnit needed) {
  if (auto instead = instead_of_power(told)) return instead;
  const std::string_view allowed = name_of(needed);
  if (!told.unit || is_relative(told) || told.unit->equals(leading_unit(allowed).value()))
    return std::nullopt;
  return Instead{allowed, told.unit->of(Unit::lumen) == 0};
}

// Coefficients of powers of 10 say so, often in a remark; those of powers of e need not, and of some a remark
// tells what they were made of.
bool is_decadic(const ToldUnit& told) {
  static const Phrases kDecadic{"decadic", "base 10", "base-10", "base ten", "log10", "log 10", "log_10"};
  static const Phrases kNatural{"natural", "napierian", "neperian", "base e",
                                "ln 10",   "ln(10)",    "2.3",      "converted from"};
  if (says(told.line, kNatural)) return false;
  const std::size_t remark = told.line.find(';');
  return says(told.quantity, kDecadic) || is_told_as(told, kDecadic) ||
         (remark != told.line.npos &&
          is_told_as(told_unit(std::string_view(told.line).substr(remark + 1)), kDecadic));
}

bool is_per_length(const ToldUnit& told) {
  static const Unit kPerMetre = leading_unit("1/m").value();
  return told.unit && told.unit->exponents == kPerMetre.exponents;
}

std::optional<Instead> instead_of_coefficient(const ToldUnit& told) {
  if (!is_per_length(told) || told.unit->log10_factor != 0) return Instead{"1/m"};
  if (is_decadic(told)) return Instead{"1/m of powers of e: ln 10 times that of powers of 10"};
  return std::nullopt;
}

std::optional<Instead> instead_of(const ToldUnit& told, CurveUnit needed) {
  switch (needed) {
    case CurveUnit::share:
      return instead_of_share(told);
    case CurveUnit::per_metre:
      return instead_of_coefficient(told);
    case CurveUnit::power:
      return instead_of_power(told);
    case CurveUnit::spectral_radiance:
    case CurveUnit::spectral_intensity:
    case CurveUnit::spectral_irradiance:
    case CurveUnit::spectral_flux:
      return instead_of_quantity(told, needed);
    case CurveUnit::any:
    case CurveUnit::unsaid_response:
      return std::nullopt;
  }
  return std::nullopt;
}

// Watts per nm, m^2 and sr, whichever of them: an odd power of lengths has a wavelength among them.
bool is_in_watts_per_nm(const Unit& unit) {
  constexpr double kPerNm = 9;
  constexpr double kRounding = 1e-6;
  return unit.of(Unit::ampere) == 0 &&
         std::abs(unit.log10_factor - (unit.of(Unit::metre) % 2 != 0 ? kPerNm : 0)) < kRounding;
}

// Other factors may make a power of photons, or a radiance of what is relative; none takes parts for wholes.
std::optional<Instead> instead_of_factor(const ToldUnit& told, CurveUnit needed) {
  if (needed == CurveUnit::share) return instead_of_prose_of_share(told);
  if (needed == CurveUnit::per_metre && is_per_length(told)) return instead_of_coefficient(told);
  if (name_of(needed).empty() || instead_of_power(told) || !is_power(told) || is_in_watts_per_nm(*told.unit))
    return std::nullopt;
  return Instead{name_of(needed)};
}

// Whether a response is told to be one per photon: its quantity says so, or what it is divided by.
bool is_per_photon(const ToldUnit& told) {
  const auto of_energy = [](std::string_view text) { return says(text, {"energy"}); };
  const auto divides = [](std::string_view text) {
    return text.find("/photon") != text.npos || says(text, {"per photon"});
  };
  if (of_energy(told.quantity) || std::any_of(told.additions.begin(), told.additions.end(), of_energy))
    return false;
  return says(told.quantity, {"photon", "photons", "quantum", "qe"}) ||
         std::any_of(told.additions.begin(), told.additions.end(), divides);
}

// Of coefficients a word of logarithms tells what they are coefficients of, and prose is none.
bool takes_what_is_unclear(CurveUnit needed) {
  return needed == CurveUnit::any || needed == CurveUnit::unsaid_response || needed == CurveUnit::per_metre;
}

// Whether a table is one of logarithms, as "log10 W/nm" and "radiance (log)" are: "log" and "ln" stand for
// them alone or before what is logged, a unit or a quantity, and not in "log book".
bool is_of_logarithms(std::string_view line, const ToldUnit& told) {
  static const Phrases kLogged{"radiance", "irradiance",  "intensity",     "flux",     "power", "energy",
                               "spectral", "reflectance", "transmittance", "relative", "scale"};
  if (is_told_as(told, {"log10", "log_10", "logarithm", "logarithmic"})) return true;
  for (const std::string_view sign : {"log 10", "log", "ln"}) {
    if (told.quantity == sign || std::count(told.additions.begin(), told.additions.end(), sign) != 0)
      return true;
    if (!told.quantity.starts_with(std::string(sign) + ' ')) continue;
    std::string_view behind = line.substr(told.line.find(sign) + sign.size() + 1);
    if (behind.starts_with("of ")) behind.remove_prefix(3);
    const ToldUnit logged = told_unit(behind.substr(0, behind.find_first_of(" ,;")));
    if (logged.unit || std::count(kLogged.begin(), kLogged.end(), logged.quantity) != 0) return true;
  }
  return false;
}

// A lamp that is scaled is in any unit, and may be in one of any divisor, as "W/nm/lamp".
bool takes_what_is_unread(CurveUnit needed) {
  return takes_what_is_unclear(needed) || needed == CurveUnit::power;
}

using Rule = std::optional<Instead> (*)(const ToldUnit&, CurveUnit);

std::optional<std::string> fault_by(Rule rule, std::string_view name, std::string_view line, CurveUnit needed,
                                    std::string_view remedy) {
  const ToldUnit told = told_unit(line);
  if (!takes_what_is_unread(needed) && told.unit && told.unit->unread)
    return fmt::format(
        "\"{}\" is in a unit that cannot be read (got \"{}\", allowed {}, and words behind a \";\")", name,
        line, needed == CurveUnit::share ? "shares of 1" : "products as W/(m^2 nm)");
  const std::optional<Instead> instead =
      !takes_what_is_unclear(needed) && is_of_logarithms(line, told)
          ? std::optional(Instead{"no logarithms: 10^x of a log10 x, e^x of a ln x", false})
          : rule(told, needed);
  if (!instead) return std::nullopt;
  return fmt::format("\"{}\" is in another unit (got \"{}\", allowed {}{})", name, line, instead->allowed,
                     instead->by_factor ? remedy : std::string_view());
}

}  // namespace

std::optional<std::string> unit_fault(std::string_view name, std::string_view told, CurveUnit needed,
                                      std::string_view remedy) {
  return fault_by(instead_of, name, told, needed, remedy);
}

std::optional<std::string> factor_unit_fault(std::string_view name, std::string_view told, CurveUnit needed,
                                             std::string_view remedy) {
  return fault_by(instead_of_factor, name, told, needed, remedy);
}

std::optional<std::string> relative_power(std::string_view name, std::string_view unit, CurveUnit needed) {
  const std::string_view allowed = name_of(needed);
  if (allowed.empty() || !is_relative(told_unit(unit))) return std::nullopt;
  return fmt::format(
      "\"{}\" is taken to be in {}, though its unit is \"{}\": scale the emission to a quantity", name,
      allowed, unit);
}

bool tells_power(std::string_view unit) {
  return is_power(told_unit(unit));
}

std::optional<std::string> unsaid_response(std::string_view name, std::string_view unit) {
  if (!is_per_photon(told_unit(unit))) return std::nullopt;
  return fmt::format(
      "\"{}\" is taken as a response to energy, though its unit is \"{}\": say the response, energy or "
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
