#include "spectral/unit_line.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "io/text.h"

namespace abbe {
namespace {

constexpr std::string_view kDigits = "0123456789";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}
bool is_letter_at(std::string_view text, std::size_t at) {
  return at < text.size() && ((text[at] >= 'a' && text[at] <= 'z') || (text[at] >= 'A' && text[at] <= 'Z'));
}
bool is_digit_at(std::string_view text, std::size_t at) {
  return at < text.size() && kDigits.find(text[at]) != kDigits.npos;
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kPlainLetters{{{"−", "-"},
                                                                                       {"–", "-"},
                                                                                       {"µ", "u"},
                                                                                       {"μ", "u"},
                                                                                       {"·", "*"},
                                                                                       {"⋅", "*"},
                                                                                       {"Å", "Angstrom"},
                                                                                       {"Å", "Angstrom"},
                                                                                       {"…", "..."},
                                                                                       {"\t", " "}}};
constexpr std::array<std::pair<std::string_view, std::string_view>, 11> kSuperscripts{{{"⁻", "-"},
                                                                                       {"⁰", "0"},
                                                                                       {"¹", "1"},
                                                                                       {"²", "2"},
                                                                                       {"³", "3"},
                                                                                       {"⁴", "4"},
                                                                                       {"⁵", "5"},
                                                                                       {"⁶", "6"},
                                                                                       {"⁷", "7"},
                                                                                       {"⁸", "8"},
                                                                                       {"⁹", "9"}}};

// Entry of a list for the sign that a text begins with, or nullptr.
template <std::size_t size>
const std::pair<std::string_view, std::string_view>* leading_sign(
    const std::array<std::pair<std::string_view, std::string_view>, size>& list, std::string_view text) {
  const auto entry = std::find_if(list.begin(), list.end(),
                                  [text](const auto& sign) { return text.starts_with(sign.first); });
  return entry == list.end() ? nullptr : &*entry;
}

// Line with the Unicode signs of units replaced by ASCII, such as "W m^-2 um^-1".
std::string plain_letters(std::string_view line) {
  std::string plain;
  bool raised = false;
  while (!line.empty()) {
    const auto* superscript = leading_sign(kSuperscripts, line);
    const auto* sign = superscript != nullptr ? superscript : leading_sign(kPlainLetters, line);
    if (superscript != nullptr && !raised) plain += '^';
    raised = superscript != nullptr;
    plain += sign != nullptr ? sign->second : line.substr(0, 1);
    line.remove_prefix(sign != nullptr ? sign->first.size() : 1);
  }
  return plain;
}

// True if the parentheses that open at `at` belong to a unit and not to a remark: after a division or
// multiplication sign, or before an exponent.
bool are_of_a_unit(std::string_view text, std::size_t at) {
  const std::string_view before = trimmed(text.substr(0, at));
  const bool joined = !before.empty() && std::string_view("/*.^").find(before.back()) != before.npos;
  const std::size_t behind = text.find(')', at) + 1;
  const bool raised =
      behind != 0 && (text.substr(behind).starts_with('^') || text.substr(behind).starts_with('-') ||
                      text.substr(behind).starts_with('/') || text.substr(behind).starts_with("**"));
  return joined || before.ends_with(" per") || before == "per" || raised;
}

// Splits a line at commas, brackets and the parentheses of remarks.
std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  int depth = 0;  // of the parentheses of a unit
  for (std::size_t at = 0; at <= text.size(); ++at) {
    const char sign = at < text.size() ? text[at] : ',';
    if (sign == '(' && (depth > 0 || are_of_a_unit(text, at))) {
      ++depth;
    } else if (sign == ')' && depth > 0) {
      --depth;
    } else if (at == text.size() ||
               (depth == 0 && std::string_view(",()[]").find(sign) != std::string_view::npos)) {
      if (const auto part = trimmed(text.substr(begin, at - begin)); !part.empty()) parts.push_back(part);
      begin = at + 1;
    }
  }
  return parts;
}

// Unit at a position of the text; nothing for a length alone.
std::optional<Unit> unit_at(std::string_view text, std::size_t at) {
  const auto unit = leading_unit(text.substr(at));
  return unit && !unit->is_extent() ? unit : std::nullopt;
}

// True if the "/" at `slash` follows a unit, as in fractions such as "W/W".
bool divides_a_unit(std::string_view text, std::size_t slash) {
  const std::string_view before = trimmed(text.substr(0, slash));
  return leading_unit(before.substr(before.find_last_of(' ') + 1)).has_value();
}

// Unit after words. It must be compound or follow "in": "spectral radiance W/(m2 sr nm)", "flux in mW".
std::optional<Unit> unit_within(std::string_view text) {
  for (std::size_t blank = text.find(' '); blank != text.npos; blank = text.find(' ', blank + 1)) {
    const std::string_view before = text.substr(0, blank);
    if (is_digit_at(before, blank - 1) || before.ends_with(" per")) continue;
    if (is_digit_at(text, blank + 1) && !text.substr(blank + 1).starts_with("1/")) continue;
    if (text.substr(blank + 1).starts_with('/') && divides_a_unit(text, blank)) continue;
    const auto unit = unit_at(text, blank + 1);
    if (unit && (unit->is_compound() || before.ends_with(" in"))) return unit;
  }
  return std::nullopt;
}

// Divisor of a first word that is not a unit, as in "DN/(nJ/cm2)". A length is not enough, as in
// "wavelength/nm".
std::optional<Unit> unit_dividing_a_word(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == text.npos || text.find(' ') < slash || is_digit_at(text, 0) || divides_a_unit(text, slash))
    return std::nullopt;
  const auto unit = leading_unit(text.substr(slash));
  if (!unit || unit->has_unknown_factor) return std::nullopt;
  Unit::Exponents others = unit->exponents;
  others.at(Unit::metre) = 0;
  return others == Unit::Exponents{} ? std::nullopt : unit;
}

// Unit at the beginning of a text.
std::optional<Unit> unit_at_begin(std::string_view text) {
  const auto unit = unit_at(text, 0);
  return unit ? unit : unit_dividing_a_word(text);
}

// Unit of an addition. A number before it makes it an amount, as in "100 cd/m2", and not a unit.
std::optional<Unit> unit_of_addition(std::string_view text) {
  if (text.starts_with("in ")) text.remove_prefix(3);
  if (is_digit_at(text, 0) && !text.starts_with("1/") && !text.starts_with("1 /")) return std::nullopt;
  return unit_at_begin(text);
}

std::optional<Unit> unit_among(const std::vector<std::string_view>& parts) {
  if (parts.empty()) return std::nullopt;
  if (const auto unit = unit_at_begin(parts.front())) return unit;
  if (const auto unit = unit_within(parts.front())) return unit;
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (const auto unit = unit_of_addition(parts[i])) return unit;
  return std::nullopt;
}

bool begins_with(std::string_view text, std::string_view phrase) {
  if (!text.starts_with(phrase) ||
      (is_letter_at(phrase, phrase.size() - 1) && is_letter_at(text, phrase.size())))
    return false;
  const std::string_view behind = text.substr(phrase.size());
  const bool hyphened = behind.starts_with('-') && is_letter_at(behind, 1);
  const std::string_view next = trimmed(behind);
  return !hyphened && !is_digit_at(next, 0) && !next.starts_with('>') && !next.starts_with('<');
}

// True if the words before a phrase at the end of a quantity give it another meaning.
bool is_of_something_else(std::string_view before) {
  static const Phrases kElse{"of", "for",  "from",        "with",  "without",  "including", "not",
                             "no", "than", "uncertainty", "error", "accuracy", "x",         "by"};
  return contains_phrase(before, kElse) || before.find_first_of("=^") != before.npos ||
         before.find(" - ") != before.npos;
}
bool ends_with(std::string_view text, std::string_view phrase) {
  if (!text.ends_with(phrase)) return false;
  const std::string_view before = text.substr(0, text.size() - phrase.size());
  const std::string_view last = trimmed(before);
  const bool within_a_word = is_letter_at(phrase, 0) && is_letter_at(before, before.size() - 1);
  return !within_a_word && !is_digit_at(last, last.size() - 1) && !is_of_something_else(before);
}

// True if percentages were divided by 100, which makes them fractions.
bool is_divided(std::string_view text) {
  return text.ends_with("100") && (text.find('/') != text.npos || contains_phrase(text, {"divided by"}));
}
// True if a text ends with a maximum of 100, as in "0-100" and "norm. to 100", but not "1 equal to 100".
bool ends_at_100(std::string_view text) {
  text = trimmed(text);
  if (!text.ends_with("100")) return false;
  std::string_view before = trimmed(text.substr(0, text.size() - 3));
  if (before.ends_with("max") || before.ends_with("maximum")) return true;
  const bool to = before.ends_with(" to");
  before = trimmed(before.substr(0, to ? before.size() - 2 : before.find_last_not_of("-.") + 1));
  const bool scaled = to && before.find_last_of(' ') == before.npos &&
                      (before.starts_with("norm") || before.starts_with("scaled"));
  return scaled || (before.size() + 3 < text.size() && (before.ends_with("0") || before.ends_with("0%")));
}

}  // namespace

UnitLine unit_line(std::string_view line) {
  const std::string plain = plain_letters(line);
  const auto parts = parts_of(std::string_view(plain).substr(0, plain.find(';')));
  UnitLine parsed{{}, {}, lower_case(plain), unit_among(parts)};
  if (!parts.empty()) parsed.quantity = lower_case(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) parsed.additions.push_back(lower_case(parts[i]));
  return parsed;
}

bool contains_phrase(std::string_view text, const Phrases& phrases) {
  for (const std::string_view phrase : phrases)
    for (std::size_t at = text.find(phrase); at != text.npos; at = text.find(phrase, at + 1))
      if (!is_letter_at(text, at - 1) && !is_letter_at(text, at + phrase.size())) return true;
  return false;
}

bool declares(const UnitLine& line, const Phrases& phrases) {
  return std::any_of(phrases.begin(), phrases.end(), [&](std::string_view phrase) {
    const auto is_phrase = [phrase](std::string_view addition) {
      return addition == phrase || addition == "in " + std::string(phrase);
    };
    return begins_with(line.quantity, phrase) || ends_with(line.quantity, phrase) ||
           std::any_of(line.additions.begin(), line.additions.end(), is_phrase);
  });
}

bool declares_percent(const UnitLine& line) {
  static const Phrases kPercent{"%",   "percent", "per cent",  "percentage", "pct",     "100%t",
                                "ppm", "‰",       "per mille", "permille",   "per mil", "100%r"};
  const auto is_to_100 = [](std::string_view text) {
    for (const std::string_view sign : {"%", "percent", "per cent"})
      if (text.ends_with(sign)) text.remove_suffix(sign.size());
    return ends_at_100(text);
  };
  return (declares(line, kPercent) && !is_divided(line.quantity)) || is_to_100(line.quantity) ||
         std::any_of(line.additions.begin(), line.additions.end(), is_to_100);
}

}  // namespace abbe
