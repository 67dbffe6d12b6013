#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace abbe {

/// A product of powers of units that spectra are told in, as mW/(m^2 sr nm) is: `10^log10_factor` times
/// these. J, Jy and lengths of any kind are made of them. Quanta and moles, of any number, are photons, and
/// candela, lux and nits lumens. "A" is an ampere: who writes it for an angstrom means a unit that is none of
/// those wanted either.
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
  /// Whether it divides by a wavenumber, as W/(m2 cm-1) and W cm/m2 do.
  bool per_wavenumber = false;
  /// Whether a factor follows that cannot be read, as in W/(m2 furlong): all else is of what stands before.
  bool unread = false;

  [[nodiscard]] int of(Base base) const { return exponents[base]; }
  /// Whether it is no symbol alone, but divides by something or has more than one base.
  [[nodiscard]] bool is_compound() const;
  /// Whether it is a length, an area or a volume.
  [[nodiscard]] bool is_extent() const;
  /// Whether both are equal, but for roundings.
  [[nodiscard]] bool equals(const Unit& other) const;
};

/// The unit that a text is, or that it begins with before words of another kind where that is compound, as
/// "mW/nm at 25 C". Symbols may be written out and have prefixes of SI, exponents stand behind "^", "**" or
/// nothing, in braces too, and all that follows a "/" or "per" is divided by, but for what has a negative
/// exponent of its own. One of power or photons that goes on with a sign and what is no unit is `unread`.
/// Nothing where a text is no unit, as A and V alone are none but names. It is to be in ASCII, with "u" for
/// micro and "^2" for a raised 2.
[[nodiscard]] std::optional<Unit> leading_unit(std::string_view text);

}  // namespace abbe
