#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace abbe {

/// Product of powers of units times `10^log10_factor`, such as mW/(m^2 sr nm). J, Jy and all lengths reduce
/// to the bases. Quanta and moles are photons, whatever their number. Candela, lux and nits are lumens. "A"
/// is an ampere, even if the author meant an angstrom: neither is an allowed unit.
struct Unit {
  enum Base : std::size_t {
    watt,
    second,
    hertz,
    metre,
    steradian,
    photon,
    electronvolt,
    lumen,
    ampere,
    volt,
    kBases
  };
  using Exponents = std::array<int, kBases>;

  Exponents exponents{};
  double log10_factor = 0;
  /// True if it divides by a wavenumber, as W/(m2 cm-1) and W cm/m2 do.
  bool per_wavenumber = false;
  /// True if an unknown factor follows, as in W/(m2 furlong). All else describes the factors before it.
  bool has_unknown_factor = false;

  /// Exponent of a base; 0 if the unit does not contain it.
  [[nodiscard]] int of(Base base) const { return exponents[base]; }
  /// True if it divides or has more than one base, so that it is not a single symbol.
  [[nodiscard]] bool is_compound() const;
  /// True if it is a length, an area or a volume.
  [[nodiscard]] bool is_extent() const;
  /// True if both have equal exponents and factors, except for rounding. False if either has an unknown
  /// factor.
  [[nodiscard]] bool equals(const Unit& other) const;
};

/// Parses the unit that a text consists of, or a compound unit before words, as in "mW/nm at 25 C". Symbols
/// may be names and may have SI prefixes. Exponents follow "^", "**" or nothing, optionally in braces. A "/"
/// or "per" divides by all that follows, except for factors with a negative exponent of their own. A unit of
/// power or photons that continues with a sign and an unknown word has `has_unknown_factor`. Nothing if the
/// text is no unit; "A" and "V" alone are names. Requires ASCII, with "u" for micro and "^2" for a
/// superscript 2.
[[nodiscard]] std::optional<Unit> leading_unit(std::string_view text);

}  // namespace abbe
