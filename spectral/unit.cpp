#include "spectral/unit.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "io/text.h"

namespace abbe {
namespace {

constexpr int kMaxExponent = 99;  // largest exponent of a unit
constexpr int kMaxDepth = 8;      // of nested parentheses

struct Symbol {
  std::string_view name;
  Unit::Exponents exponents;
  double log10_factor = 0;
};
constexpr Unit::Exponents power(Unit::Base base, int exponent = 1) {
  Unit::Exponents exponents{};
  exponents.at(base) = exponent;
  return exponents;
}
constexpr Unit::Exponents kJoule{1, 1};
constexpr Unit::Exponents kJansky{1, 0, -1, -2};

// No rule depends on the number of photons in a mole.
constexpr std::array<Symbol, 20> kSymbols{{{"W", power(Unit::watt)},
                                           {"J", kJoule},
                                           {"s", power(Unit::second)},
                                           {"sec", power(Unit::second)},
                                           {"Hz", power(Unit::hertz)},
                                           {"m", power(Unit::metre)},
                                           {"sqm", power(Unit::metre, 2)},
                                           {"sr", power(Unit::steradian)},
                                           {"ster", power(Unit::steradian)},
                                           {"AA", power(Unit::metre), -10},
                                           {"A", power(Unit::ampere)},
                                           {"V", power(Unit::volt)},
                                           {"ph", power(Unit::photon)},
                                           {"mol", power(Unit::photon)},
                                           {"uE", power(Unit::photon)},
                                           {"eV", power(Unit::electronvolt)},
                                           {"Jy", kJansky, -26},
                                           {"lm", power(Unit::lumen)},
                                           {"lx", power(Unit::lumen)},
                                           {"cd", power(Unit::lumen)}}};
// Names in upper or lower case, with an optional plural s.
constexpr std::array<Symbol, 21> kNames{{{"watt", power(Unit::watt)},
                                         {"joule", kJoule},
                                         {"erg", kJoule, -7},
                                         {"second", power(Unit::second)},
                                         {"hertz", power(Unit::hertz)},
                                         {"metre", power(Unit::metre)},
                                         {"meter", power(Unit::metre)},
                                         {"micron", power(Unit::metre), -6},
                                         {"angstrom", power(Unit::metre), -10},
                                         {"ang", power(Unit::metre), -10},
                                         {"steradian", power(Unit::steradian)},
                                         {"photon", power(Unit::photon)},
                                         {"quanta", power(Unit::photon)},
                                         {"mole", power(Unit::photon)},
                                         {"einstein", power(Unit::photon)},
                                         {"electronvolt", power(Unit::electronvolt)},
                                         {"jansky", kJansky, -26},
                                         {"lumen", power(Unit::lumen)},
                                         {"lux", power(Unit::lumen)},
                                         {"candela", power(Unit::lumen)},
                                         {"nit", power(Unit::lumen)}}};
using Prefix = std::pair<std::string_view, int>;
constexpr std::array<Prefix, 9> kPrefixes{
    {{"p", -12}, {"n", -9}, {"u", -6}, {"m", -3}, {"c", -2}, {"k", 3}, {"M", 6}, {"G", 9}, {"T", 12}}};
constexpr std::array<Prefix, 8> kPrefixNames{{{"pico", -12},
                                              {"nano", -9},
                                              {"micro", -6},
                                              {"milli", -3},
                                              {"centi", -2},
                                              {"kilo", 3},
                                              {"mega", 6},
                                              {"giga", 9}}};

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

std::optional<Symbol> listed(std::span<const Symbol> symbols, std::string_view name) {
  const auto entry = std::find_if(symbols.begin(), symbols.end(),
                                  [name](const Symbol& symbol) { return symbol.name == name; });
  return entry == symbols.end() ? std::nullopt : std::optional(*entry);
}
std::optional<Symbol> prefixed(std::span<const Prefix> prefixes, std::span<const Symbol> symbols,
                               std::string_view name) {
  for (const auto& [prefix, log10_factor] : prefixes)
    if (name.starts_with(prefix))
      if (auto symbol = listed(symbols, name.substr(prefix.size()))) {
        symbol->log10_factor += log10_factor;
        return symbol;
      }
  return std::nullopt;
}
std::optional<Symbol> symbol_of(std::string_view word) {
  if (const auto symbol = listed(kSymbols, word)) return symbol;
  if (const auto symbol = prefixed(kPrefixes, kSymbols, word)) return symbol;
  const std::string small = lower_case(word);
  for (const std::string_view name :
       {std::string_view(small), std::string_view(small).substr(0, small.size() - small.ends_with('s'))}) {
    if (const auto symbol = listed(kNames, name)) return symbol;
    if (const auto symbol = prefixed(kPrefixNames, kNames, name)) return symbol;
    if (const auto symbol = prefixed(kPrefixNames, kSymbols, name)) return symbol;
  }
  return std::nullopt;
}

/// A symbol, and the number of letters that it takes of a word.
struct FirstSymbol {
  Symbol symbol;
  std::size_t length;
};
// "Wm-2" contains two symbols in one word.
std::optional<FirstSymbol> first_symbol(std::string_view word) {
  if (const auto all = symbol_of(word)) return FirstSymbol{*all, word.size()};
  const std::size_t watts = word.find('W') + 1;
  const auto first = symbol_of(word.substr(0, watts));
  if (watts == 0 || !first || !symbol_of(word.substr(watts))) return std::nullopt;
  return FirstSymbol{*first, watts};
}

/// A symbol or a number of a product, with the exponent as written and the signed exponent that applies.
struct Factor {
  Symbol symbol;
  int written = 1;
  int exponent = 1;
};

/// Recursive-descent parser of a product of units at the beginning of a text.
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text) {}

  [[nodiscard]] std::optional<Unit> read() {
    if (!product(0)) return std::nullopt;
    Unit unit = multiplied();
    unit.has_unknown_factor = is_of_light(unit) && continues();
    return is_meaningful(unit) && (unit.has_unknown_factor || is_at_end(unit)) ? std::optional(unit)
                                                                               : std::nullopt;
  }

 private:
  [[nodiscard]] std::string_view rest() const { return text_.substr(at_); }
  bool accept(std::string_view sign) {
    const bool is_there = rest().starts_with(sign);
    if (is_there) at_ += sign.size();
    return is_there;
  }
  [[nodiscard]] std::string_view word() const {
    const auto all = rest();
    return all.substr(
        0, static_cast<std::size_t>(std::find_if_not(all.begin(), all.end(), is_letter) - all.begin()));
  }
  bool accept_word(std::string_view expected) { return word() == expected && accept(expected); }
  bool accept_hyphen() { return rest().size() > 1 && is_letter(rest()[1]) && accept("-"); }

  // Accepts the separators between factors. Returns true if they divide.
  bool accept_separators() {
    bool divides = false;
    for (bool more = true; more;) {
      const bool over = accept("/") || accept_word("per");
      divides = divides || over;
      more = over || accept(" ") || accept("*") || accept(".") || accept(",") || accept_hyphen() ||
             accept_word("and");
    }
    return divides;
  }

  std::optional<int> written_exponent() {
    const std::size_t before = at_;
    const bool marked = accept("**") || accept("^");
    const bool enclosed = accept("{") || (marked && accept("("));
    int exponent = 0;
    const auto [end, fault] = std::from_chars(rest().data(), text_.data() + text_.size(), exponent);
    if (fault == std::errc() && std::abs(exponent) <= kMaxExponent) {
      at_ = static_cast<std::size_t>(end - text_.data());
      if (!enclosed || accept("}") || accept(")")) return exponent;
    }
    at_ = before;
    return std::nullopt;
  }

  bool number(bool divides) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    double value = 0;
    const auto [end, fault] = std::from_chars(rest().data(), text_.data() + text_.size(), value);
    if (fault != std::errc() || !is_digit(rest().front()) || value == 0) return false;
    at_ = static_cast<std::size_t>(end - text_.data());
    const bool raised = rest().starts_with('^') || rest().starts_with("**");
    const int exponent = raised ? written_exponent().value_or(1) : 1;
    factors_.push_back({{"", {}, std::log10(value)}, exponent, divides ? -exponent : exponent});
    return true;
  }

  // A division sign applies to all that follows, except for factors with a negative exponent that are not
  // next to it.
  [[nodiscard]] static int signed_exponent(int written, bool divides, bool divided) {
    return divides || (divided && written > 0) ? -written : written;
  }

  bool symbol(bool divides, bool divided) {
    const bool squared = accept_word("square") || accept_word("sq");
    while (squared && (accept(" ") || accept("."))) continue;
    const auto symbol_found = first_symbol(word());
    if (!symbol_found) return false;
    at_ += symbol_found->length;
    const int written = written_exponent().value_or(1) * (squared ? 2 : 1);
    factors_.push_back({symbol_found->symbol, written, signed_exponent(written, divides, divided)});
    return true;
  }

  bool group(bool divides, bool divided, int depth) {
    const std::size_t first = factors_.size();
    if (depth == kMaxDepth || !accept("(") || !product(depth + 1) || !accept(")")) return false;
    const int exponent = signed_exponent(written_exponent().value_or(1), divides, divided);
    for (std::size_t i = first; i < factors_.size(); ++i)
      factors_[i].exponent = std::clamp(factors_[i].exponent * exponent, -kMaxExponent, kMaxExponent);
    return true;
  }

  // Parses a product of at least one factor, up to the first text that is no factor.
  bool product(int depth) {
    bool divided = false;
    for (bool first = true;; first = false) {
      const std::size_t before = at_;
      const std::size_t count = factors_.size();
      const bool divides = accept_separators();
      if (((first || divides || rest().starts_with("1/")) && number(divides)) || symbol(divides, divided) ||
          group(divides, divided, depth)) {
        divided = divided || divides;
        continue;
      }
      at_ = before;
      factors_.resize(count);
      return !first;
    }
  }

  [[nodiscard]] Unit multiplied() const {
    Unit unit;
    for (const Factor& factor : factors_) {
      const bool length = factor.symbol.exponents == power(Unit::metre);
      const bool per_cm = factor.symbol.log10_factor == -2 && factor.written == -1;
      unit.per_wavenumber |= length && (factor.exponent > 0 || per_cm);
      for (std::size_t base = 0; base < Unit::kBases; ++base)
        unit.exponents.at(base) += factor.exponent * factor.symbol.exponents.at(base);
      unit.log10_factor += factor.exponent * factor.symbol.log10_factor;
    }
    return unit;
  }

  // True unless the unit has only symbols that are also names, such as those of illuminants and bands.
  [[nodiscard]] static bool is_meaningful(const Unit& unit) {
    Unit::Exponents others = unit.exponents;
    others.at(Unit::ampere) = others.at(Unit::volt) = 0;
    return others != Unit::Exponents{};
  }

  // True for units that no prose begins with, unlike "s/p" and "per photon/electron".
  [[nodiscard]] static bool is_of_light(const Unit& unit) {
    return unit.of(Unit::watt) != 0 || (unit.of(Unit::photon) > 0 && unit.is_compound());
  }

  // True if a sign that joins factors follows, so that the next factor could not be parsed.
  [[nodiscard]] bool continues() const {
    const std::string_view following = rest().substr(std::min(rest().find_first_not_of(' '), rest().size()));
    if (following.size() < 2) return false;
    const bool dotted = following.front() == '.' && is_letter(following[1]);
    return dotted || std::string_view("/*^").find(following.front()) != following.npos ||
           following.starts_with("per ");
  }

  // True if nothing follows, or only words.
  [[nodiscard]] bool is_at_end(const Unit& unit) const {
    const std::string_view following = rest();
    if (following.find_first_not_of(' ') == following.npos) return true;
    return unit.is_compound() && following.front() == ' ' && following.size() > 1 &&
           is_letter(following[1]) && !following.starts_with(" per ");
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<Factor> factors_;
};

}  // namespace

bool Unit::is_compound() const {
  const auto used = [](int exponent) { return exponent != 0; };
  const auto divides = [](int exponent) { return exponent < 0; };
  return std::any_of(exponents.begin(), exponents.end(), divides) ||
         std::count_if(exponents.begin(), exponents.end(), used) > 1;
}

bool Unit::is_extent() const {
  return of(metre) > 0 && exponents == power(metre, of(metre));
}

bool Unit::equals(const Unit& other) const {
  constexpr double kRounding = 1e-6;
  return !has_unknown_factor && !other.has_unknown_factor && exponents == other.exponents &&
         std::abs(log10_factor - other.log10_factor) < kRounding;
}

std::optional<Unit> leading_unit(std::string_view text) {
  return UnitParser(text).read();
}

}  // namespace abbe
