#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace abbe {

/// One of the dispersion formulas 1 to 9 of refractiveindex.info. `c` holds c1, c2, ... in order, for
/// wavelengths in micrometres; absent coefficients are 0. [Polyanskiy2024]
struct DispersionFormula {
  int id = 2;  ///< Number of the formula, 1 to 9.
  std::array<double, 17> c{};
  int terms = 17;                   ///< Number of coefficients given in the table.
  bool vacuum_wavelengths = false;  ///< True if its wavelengths are in vacuum, false if in standard air.
};

/// An error message if `f` cannot be used on [low_nm, high_nm], its range of wavelengths [nm]. The reason is
/// a resonance there (within 1e-3 of its squared wavelength), or n <= 1, or no n, at a wavelength in [300,
/// 1100] nm. Empty otherwise.
[[nodiscard]] std::optional<std::string> dispersion_fault(const DispersionFormula& f, double low_nm,
                                                          double high_nm);

namespace dispersion {

/// Coefficient `c_i`, counted from 1 as the formulas are written.
template <typename T>
T coefficient(const DispersionFormula& f, int i) {
  return T(f.c[static_cast<std::size_t>(i - 1)]);
}

/// The sum c_first L^c_(first+1) + c_(first+2) L^c_(first+3) + ..., with L the wavelength [um].
template <typename T>
T powers(const DispersionFormula& f, int first, const T& L) {
  using std::pow;
  T sum(0);
  for (int i = first; i + 1 <= f.terms; i += 2)
    if (coefficient<double>(f, i) != 0) sum += coefficient<T>(f, i) * pow(L, coefficient<T>(f, i + 1));
  return sum;
}

/// The sum c1 + c2 L^2/(L^2 - p3) + c4 L^2/(L^2 - p5) + ..., with p = c^2 if `squared`, else p = c. L2 is the
/// squared wavelength L^2 [um^2].
template <typename T>
T sellmeier(const DispersionFormula& f, bool squared, const T& L2) {
  T sum = coefficient<T>(f, 1);
  for (int i = 2; i + 1 <= f.terms; i += 2) {
    const T p = coefficient<T>(f, i + 1);
    if (coefficient<double>(f, i) != 0) sum += coefficient<T>(f, i) * L2 / (L2 - (squared ? p * p : p));
  }
  return sum;
}

/// The term c_i L^c_(i+1)/(L^2 - c_(i+2)^c_(i+3)), a resonance of formula 4; L is the wavelength [um].
template <typename T>
T resonance(const DispersionFormula& f, int i, const T& L) {
  using std::pow;
  if (coefficient<double>(f, i) == 0) return T(0);
  const double pole = std::pow(coefficient<double>(f, i + 2), coefficient<double>(f, i + 3));
  return coefficient<T>(f, i) * pow(L, coefficient<T>(f, i + 1)) / (L * L - T(pole));
}

/// The sum c1 + c2/(c3 - L^-2) + c4/(c5 - L^-2) + ..., with L2 the squared wavelength L^2 [um^2].
template <typename T>
T gas(const DispersionFormula& f, const T& L2) {
  T sum = coefficient<T>(f, 1);
  for (int i = 2; i + 1 <= f.terms; i += 2)
    if (coefficient<double>(f, i) != 0) sum += coefficient<T>(f, i) / (coefficient<T>(f, i + 1) - T(1) / L2);
  return sum;
}

/// Constant of Herzberger's formula [um^2].
inline constexpr double kHerzberger = 0.028;

}  // namespace dispersion

/// n by formula `f.id` at a wavelength in MICROMETRES, in the medium of the formula's wavelengths; its range
/// is not checked. NaN if n^2 < 0 or the id is unknown.
template <typename T>
[[nodiscard]] T dispersion_index(const DispersionFormula& f, const T& L) {
  using std::sqrt;
  const auto c = [&f](int i) { return dispersion::coefficient<T>(f, i); };
  const T L2 = L * L;
  switch (f.id) {
    case 1:
    case 2:
      return sqrt(T(1) + dispersion::sellmeier(f, f.id == 1, L2));
    case 3:
      return sqrt(c(1) + dispersion::powers(f, 2, L));
    case 4:
      return sqrt(c(1) + dispersion::resonance(f, 2, L) + dispersion::resonance(f, 6, L) +
                  dispersion::powers(f, 10, L));
    case 5:
      return c(1) + dispersion::powers(f, 2, L);
    case 6:
      return T(1) + dispersion::gas(f, L2);
    case 7: {
      const T h = T(1) / (L2 - T(dispersion::kHerzberger));
      return c(1) + (c(2) + c(3) * h) * h + (c(4) + (c(5) + c(6) * L2) * L2) * L2;
    }
    case 8: {
      const T q = c(1) + c(2) * L2 / (L2 - c(3)) + c(4) * L2;
      return sqrt((T(1) + T(2) * q) / (T(1) - q));
    }
    case 9: {
      const T d = L - c(5);
      return sqrt(c(1) + c(2) / (L2 - c(3)) + c(4) * d / (d * d + c(6)));
    }
    default:
      return T(std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace abbe
