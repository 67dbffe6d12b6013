#pragma once

#include <string_view>

namespace abbe {

/// Unit that a table declares in its line `# unit:`. docs/formats.md lists the allowed spellings.
struct TableUnit {
  enum class Kind {
    unknown,      ///< No listed unit.
    fraction,     ///< Fractions of 1.
    percent,      ///< Per cent.
    logarithm,    ///< Densities, decibels, decadic coefficients and logarithms of values.
    relative,     ///< Values whose ratios alone count.
    coefficient,  ///< Coefficients per length; a log10_factor of 0 is 1/m.
    power,        ///< Watts or parts and multiples of them, over the divisors.
    photons       ///< Numbers or moles of photons, over any divisors.
  };
  /// Bits of `divisors`.
  enum Divisor : unsigned { length = 1, area = 2, solid_angle = 4, wavelength = 8, time = 16 };

  Kind kind = Kind::unknown;
  unsigned divisors = 0;
  int log10_factor = 0;  ///< Of the unit in products of W, m^2, sr, nm and 1/m.
};

/// Unit of a table by the value of the line `# unit:`. The text before the first ";" is the unit, or the name
/// of a quantity with its unit after a comma, in brackets, or after "in". A quantity without unit must be
/// relative or the name of a fraction. A remark behind the ";" counts only if it is the word for a logarithm,
/// such as "decadic".
[[nodiscard]] TableUnit table_unit(std::string_view line);

/// True if the line declares a response per photon: its quantity mentions photons or quantum efficiencies, or
/// a unit after it divides by photons. Lines that mention energy declare none.
[[nodiscard]] bool declares_response_per_photon(std::string_view line);

}  // namespace abbe
