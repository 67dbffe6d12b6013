#include "spectral/curve_use.h"

#include <algorithm>
#include <initializer_list>

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
std::string_view without_spaces_behind(std::string_view text) {
  return text.substr(0, text.find_last_not_of(' ') + 1);
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
  const std::string text = lower_case(unit.substr(0, unit.find(';')));
  for (const std::string_view sign : {"%", "percent", "per cent"})
    for (std::size_t at = text.find(sign); at != text.npos; at = text.find(sign, at + 1))
      if (!makes_an_amount(std::string_view(text).substr(0, at))) return true;
  return false;
}

bool is_per_metre(std::string_view unit) {
  return is_one_of(without_spaces_behind(unit.substr(0, unit.find_first_of(";,("))),
                   {"1/m", "/m", "m^-1", "m-1", "m⁻¹", "per m", "per metre", "per meter"});
}

bool is_another_radiance(std::string_view unit) {
  return has_one_of(unit.substr(0, 2), {"mW", "uW", "µ", "nW", "kW"}) ||
         has_one_of(unit, {"/um", "/µm", " um)", " µm)", "/cm", "cm2", "cm^2"});
}

}  // namespace

std::optional<std::string> unit_fault(std::string_view name, std::string_view told, CurveUnit needed,
                                      std::string_view remedy) {
  const auto fault = [&](std::string_view allowed) {
    return fmt::format("\"{}\" is in another unit (got \"{}\", allowed {}{})", name, told, allowed, remedy);
  };
  if (needed == CurveUnit::share && is_percent(told)) return fault("shares of 1");
  if (needed == CurveUnit::per_metre && !is_per_metre(told)) return fault("1/m");
  if (needed == CurveUnit::spectral_radiance && is_another_radiance(told)) return fault("W/(m^2 sr nm)");
  return std::nullopt;
}

std::optional<std::string> unsaid_response(std::string_view name, std::string_view unit) {
  if (!has_one_of(lower_case(unit), {"quantum efficiency", "per photon"})) return std::nullopt;
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
