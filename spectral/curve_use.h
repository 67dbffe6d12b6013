#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/diagnostics.h"
#include "io/json_values.h"
#include "spectral/curve.h"
#include "spectral/library.h"

namespace abbe {

/// Unit that a table declares in its line `# unit:`. docs/reference/formats.md lists the allowed spellings.
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

/// Quantity that a curve must have; a table can declare another one.
/// - `any`: no check.
/// - `fraction`: a fraction of 1, and neither percent, decibels nor densities.
/// - `per_metre`: an absorption or scattering coefficient for powers of e [1/m].
/// - `unknown_response`: no check; nothing declares if the response multiplies energy, which is assumed, or
///   photons.
/// - `power`: power per nm over any divisors and in any multiple, for lights that are scaled.
/// - radiance, intensity, irradiance and flux: W/(m^2 sr nm), W/(sr nm), W/(m^2 nm) and W/nm.
enum class CurveUnit {
  any,
  fraction,
  per_metre,
  power,
  spectral_radiance,
  spectral_intensity,
  spectral_irradiance,
  spectral_flux,
  unknown_response
};

/// Requirements on a curve.
struct CurveUse {
  std::string_view folder;  ///< Folder of `data/` for names of tables.
  Range allowed;            ///< Values that the curve may have at its knots.
  CurveUnit unit = CurveUnit::any;
  /// True if the caller extrapolates the curve as a constant outside a table that declares 0, as for light
  /// and transmittances. A response follows its table. The functions below ignore this member.
  bool extrapolates_constant = false;
};
inline constexpr CurveUse kIlluminantUse{"illuminant", {0, 1e30}, CurveUnit::power, true};
inline constexpr CurveUse kReflectanceUse{"reflectance", Range::unit(), CurveUnit::fraction};
/// Reflectance factors of chart patches, which can be glossy or fluoresce into the instrument. Per cent
/// exceed the range.
inline constexpr CurveUse kReflectanceFactorUse{"reflectance", {0, 2}, CurveUnit::fraction};
/// Transmittance of a filter in front of a sensor: above 1 only by measurement errors, far below a
/// percentage.
inline constexpr CurveUse kTransmittanceUse{"filter", {0, 1.05}, CurveUnit::fraction, true};
/// Quantum efficiency in electrons per photon, above 1 for energetic photons. Per cent exceed the range.
inline constexpr CurveUse kQuantumEfficiencyUse{"camera", {0, 10}, CurveUnit::fraction};
/// Quantum efficiency of a channel, which may be negative.
inline constexpr CurveUse kQuantumResponseUse{"camera", {-10, 10}, CurveUnit::fraction};

/// Role of a table in a curve. The other factors of a product can convert from another quantity, but correct
/// neither percentages nor coefficients in 1/cm nor multiples of a power.
enum class UnitRole { whole, factor };

/// Explains why the table `name` with the line `# unit: <unit>` does not have the needed unit, and lists what
/// is allowed. Examples are percent or densities for fractions, 1/cm for 1/m, photons for power per nm, and
/// whatever `table_unit` does not list. `remedy`, which begins with its own separator, is appended to the
/// allowed unit if a factor may convert to it. Nothing if the unit is right. A factor may have another
/// quantity than the needed one, and as a factor of a coefficient any unit.
[[nodiscard]] std::optional<std::string> unit_fault(std::string_view name, std::string_view unit,
                                                    CurveUnit needed, std::string_view remedy = {},
                                                    UnitRole role = UnitRole::whole);

/// Warning for the table `name` if a radiance, intensity, irradiance or flux is needed but its unit is
/// relative.
[[nodiscard]] std::optional<std::string> relative_power(std::string_view name, std::string_view unit,
                                                        CurveUnit needed);

/// True if the unit of a table is watts over any divisors, such as mW/nm.
[[nodiscard]] bool declares_power(std::string_view unit);

/// Warning for the table `name` that is read as a response to energy by default, if its unit declares quantum
/// efficiencies or a response per photon; otherwise nothing.
[[nodiscard]] std::optional<std::string> unknown_response(std::string_view name, std::string_view unit);

/// True if the unit and the values of the table `name` satisfy `use`. Otherwise reports each fault at
/// `where`.
bool check_use(const std::string& name, const std::string& unit, const Curve& curve, const CurveUse& use,
               const SourcePosition& where, Diagnostics& diagnostics);

/// Reads a curve from the folder of `use`, as `load_curve` of a folder, and checks it by `check_use`.
[[nodiscard]] std::optional<NamedCurve> load_curve(const CurveUse& use, const std::string& name,
                                                   const SourcePosition& where, Diagnostics& diagnostics,
                                                   NeededRange needed = {});

}  // namespace abbe
