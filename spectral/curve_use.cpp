#include "spectral/curve_use.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe {
namespace {

bool is_one_of(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}
bool has_one_of(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [text](std::string_view word) { return text.find(word) != text.npos; });
}
// Whether the word that stands at `at` has no letter beside it.
bool is_whole(std::string_view text, std::size_t at, std::string_view word) {
  const auto is_letter = [text](std::size_t place) {
    return place < text.size() &&
           ((text[place] >= 'a' && text[place] <= 'z') || (text[place] >= 'A' && text[place] <= 'Z'));
  };
  return !is_letter(at - 1) && !is_letter(at + word.size());
}
bool has_word(std::string_view text, std::initializer_list<std::string_view> words) {
  for (const std::string_view word : words)
    for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1))
      if (is_whole(text, at, word)) return true;
  return false;
}
// What a unit says before remarks of other things, in small letters.
std::string stated(std::string_view unit) {
  return lower_case(unit.substr(0, unit.find(';')));
}
std::string_view without_spaces_behind(std::string_view text) {
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kPlainLetters{{{"**", ""},
                                                                                       {"^", ""},
                                                                                       {"¹", "1"},
                                                                                       {"²", "2"},
                                                                                       {"³", "3"},
                                                                                       {"⁻", "-"},
                                                                                       {"−", "-"},
                                                                                       {"µ", "u"},
                                                                                       {"μ", "u"},
                                                                                       {"·", " "},
                                                                                       {"⋅", " "},
                                                                                       {"*", " "}}};

// A unit before its remarks, in the letters that all its spellings have: "W m-2 um-1".
std::string plain(std::string_view unit) {
  std::string text(unit.substr(0, unit.find(';')));
  for (const auto& [sign, letters] : kPlainLetters)
    for (std::size_t at = text.find(sign); at != text.npos; at = text.find(sign, at + letters.size()))
      text.replace(at, sign.size(), letters);
  return text;
}

// Whether what stands before a sign of percent makes an amount of it, as "within 0.5" or "1 = 100" does, and
// no unit, as nothing does or "0-100".
bool makes_an_amount(std::string_view before) {
  before = without_spaces_behind(before);
  const std::size_t digits = before.find_last_not_of("0123456789") + 1;
  const std::string_view number = before.substr(digits);
  if (number.empty()) return false;
  return number != "100" || without_spaces_behind(before.substr(0, digits)).ends_with('=');
}

bool is_percent(std::string_view unit) {
  const std::string text = stated(unit);
  for (const std::string_view sign : {"%", "percent", "per cent"})
    for (std::size_t at = text.find(sign); at != text.npos; at = text.find(sign, at + 1))
      if (!makes_an_amount(std::string_view(text).substr(0, at))) return true;
  return false;
}

// The length that a coefficient is per; empty for another unit.
std::string length_per(std::string_view unit) {
  const std::string all = plain(unit.substr(0, unit.find_first_of(",(")));
  const std::string_view text = without_spaces_behind(all);
  for (const std::string_view per : {"1/", "/", "per "})
    if (text.starts_with(per)) return std::string(text.substr(per.size()));
  return std::string(text.ends_with("-1") ? text.substr(0, text.size() - 2) : "");
}
bool is_per_metre(std::string_view unit) {
  return is_one_of(length_per(unit), {"m", "metre", "meter"});
}
bool is_per_other_length(std::string_view unit) {
  return is_one_of(length_per(unit), {"km", "cm", "mm", "um", "nm", "centimetre", "centimeter", "millimetre",
                                      "millimeter", "micrometre", "micrometer", "micron"});
}

// Coefficients of powers of 10 say so, often in a remark; those of powers of e need not.
bool is_decadic(std::string_view unit) {
  const std::string text = lower_case(unit);
  return has_one_of(text, {"decadic", "base 10", "base-10", "base ten", "log10", "log 10", "log_10"}) &&
         !has_one_of(text, {"natural", "napierian", "neperian", "base e"});
}

// Whether a unit divides by one of these lengths, as "sr um)", "/um", "per um" and "um-1" do and "wavelength
// in um" does not.
bool divides_by(std::string_view text, std::initializer_list<std::string_view> lengths) {
  const auto divides = [text](std::size_t at, std::string_view length) {
    const std::string_view before = without_spaces_behind(text.substr(0, at));
    const auto is_before = [before](std::string_view end) { return before.ends_with(end); };
    constexpr std::array<std::string_view, 5> kBefore{"/", "/(", "per", "sr", "m2"};
    return text.substr(at + length.size()).starts_with("-1") ||
           std::any_of(kBefore.begin(), kBefore.end(), is_before);
  };
  for (const std::string_view length : lengths)
    for (std::size_t at = text.find(length); at != text.npos; at = text.find(length, at + 1))
      if (is_whole(text, at, length) && divides(at, length)) return true;
  return false;
}

bool tells_watts(std::string_view text) {
  return has_word(text, {"W", "Wm"}) || has_word(lower_case(text), {"watt", "watts"});
}

// Parts or multiples of a power per m^2, sr or nm, in plain letters.
bool is_another_multiple(std::string_view text) {
  const std::string small = lower_case(text);
  const bool of_watts =
      has_word(text, {"pW", "nW", "uW", "mW", "kW", "MW", "nWm", "uWm", "mWm", "Wcm", "uWcm", "mWcm"}) ||
      has_one_of(small, {"nanowatt", "microwatt", "milliwatt", "kilowatt"}) ||
      has_word(small, {"erg", "ergs"});
  const bool of_area = has_word(text, {"cm2", "cm-2", "mm2", "mm-2", "um2", "um-2"}) ||
                       has_one_of(small, {"square cent", "square mill", "sq cm", "sq. cm"});
  return (of_watts && !tells_watts(text)) || of_area ||
         divides_by(text, {"um", "Å", "micron", "micrometre", "micrometer"}) ||
         divides_by(small, {"angstrom"});
}

// What the eye sees of a power is none.
bool is_photometric(std::string_view text) {
  return has_word(lower_case(text), {"lm", "lumen", "lumens", "lx", "lux", "cd", "candela", "nit", "nits"});
}

// Of a neutral density filter the density is but its name.
bool is_density(std::string_view text) {
  if (has_one_of(text, {"absorbance", "attenuation", "extinction"}) || has_word(text, {"od"})) return true;
  constexpr std::string_view kDensity = "density";
  for (std::size_t at = text.find(kDensity); at != text.npos; at = text.find(kDensity, at + 1))
    if (!text.substr(0, at).ends_with("neutral ") && !text.substr(0, at).ends_with("neutral-")) return true;
  return false;
}

/// What is allowed in place of a unit, and whether a factor makes it of that.
struct Instead {
  std::string_view allowed;
  bool by_factor = true;
};

std::optional<Instead> instead_of_share(std::string_view unit) {
  const std::string text = stated(unit);
  if (is_percent(unit)) return Instead{"shares of 1"};
  if (has_word(text, {"db", "decibel", "decibels"})) return Instead{"shares of 1: 10^(-A/10) of A dB", false};
  if (is_density(text)) return Instead{"shares of 1: 10^-D of a density D", false};
  return std::nullopt;
}

std::optional<Instead> instead_of_power(std::string_view unit) {
  const std::string text = stated(unit);
  if (has_one_of(text, {"photon", "quanta", "quantum"}) ||
      has_word(text, {"mol", "mmol", "umol", "nmol", "micromol", "mole", "moles", "micromole", "micromoles"}))
    return Instead{"power per nm: hc/lambda for each photon", false};
  if (has_word(text, {"hz", "khz", "mhz", "ghz", "thz", "hertz", "jy"}))
    return Instead{"power per nm: c/lambda^2 times that per Hz", false};
  if (has_word(plain(text), {"cm-1"}))
    return Instead{"power per nm: 10^7 nm cm^-1/lambda^2 times that per cm^-1", false};
  return std::nullopt;
}

std::string_view unit_of(CurveUnit quantity) {
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

// A unit that tells watts tells areas and solid angles too, which are those of the quantity then.
bool is_another_extent(std::string_view text, CurveUnit needed) {
  const bool area = has_one_of(text, {"m2", "m-2"});
  const bool angle = has_one_of(lower_case(text), {"sr", "steradian"});
  if (needed == CurveUnit::spectral_radiance) return !angle;
  if (needed == CurveUnit::spectral_intensity) return area || !angle;
  return angle || (area && needed == CurveUnit::spectral_flux);
}

std::optional<Instead> instead_of_quantity(std::string_view unit, CurveUnit needed) {
  if (const auto instead = instead_of_power(unit)) return instead;
  const std::string text = plain(unit);
  const bool watts = tells_watts(text);
  if (is_another_multiple(text) || (watts && is_another_extent(text, needed)))
    return Instead{unit_of(needed)};
  if (!watts && is_photometric(text)) return Instead{unit_of(needed), false};
  return std::nullopt;
}

std::optional<Instead> instead_of_coefficient(std::string_view unit) {
  if (!is_per_metre(unit)) return Instead{"1/m"};
  if (is_decadic(unit)) return Instead{"1/m of powers of e: ln 10 times that of powers of 10"};
  return std::nullopt;
}

std::optional<Instead> instead_of(std::string_view unit, CurveUnit needed) {
  switch (needed) {
    case CurveUnit::share:
      return instead_of_share(unit);
    case CurveUnit::per_metre:
      return instead_of_coefficient(unit);
    case CurveUnit::power:
      return instead_of_power(unit);
    case CurveUnit::spectral_radiance:
    case CurveUnit::spectral_intensity:
    case CurveUnit::spectral_irradiance:
    case CurveUnit::spectral_flux:
      return instead_of_quantity(unit, needed);
    case CurveUnit::any:
    case CurveUnit::unsaid_response:
      return std::nullopt;
  }
  return std::nullopt;
}

// Other factors may make a power of photons, or a radiance of what is relative; none takes parts for wholes.
std::optional<Instead> instead_of_factor(std::string_view unit, CurveUnit needed) {
  if (needed == CurveUnit::share) return instead_of_share(unit);
  if (needed == CurveUnit::per_metre && (is_per_metre(unit) || is_per_other_length(unit)))
    return instead_of_coefficient(unit);
  if (unit_of(needed).empty() || instead_of_power(unit) || !is_another_multiple(plain(unit)))
    return std::nullopt;
  return Instead{unit_of(needed)};
}

std::optional<std::string> told_instead(std::string_view name, std::string_view told,
                                        const std::optional<Instead>& instead, std::string_view remedy) {
  if (!instead) return std::nullopt;
  return fmt::format("\"{}\" is in another unit (got \"{}\", allowed {}{})", name, told, instead->allowed,
                     instead->by_factor ? remedy : std::string_view());
}

}  // namespace

std::optional<std::string> unit_fault(std::string_view name, std::string_view told, CurveUnit needed,
                                      std::string_view remedy) {
  return told_instead(name, told, instead_of(told, needed), remedy);
}

std::optional<std::string> factor_unit_fault(std::string_view name, std::string_view told, CurveUnit needed,
                                             std::string_view remedy) {
  return told_instead(name, told, instead_of_factor(told, needed), remedy);
}

std::optional<std::string> relative_power(std::string_view name, std::string_view unit, CurveUnit needed) {
  const std::string_view allowed = unit_of(needed);
  const bool relative =
      has_word(stated(unit), {"relative", "dimensionless", "arbitrary", "normalised", "normalized"});
  if (allowed.empty() || !relative || tells_watts(plain(unit))) return std::nullopt;
  return fmt::format(
      "\"{}\" is taken to be in {}, though its unit is \"{}\": scale the emission to a quantity", name,
      allowed, unit);
}

std::optional<std::string> unsaid_response(std::string_view name, std::string_view unit) {
  const std::string text = lower_case(unit);
  if (!has_one_of(text, {"photon", "quantum"}) && !has_word(text, {"qe"})) return std::nullopt;
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
