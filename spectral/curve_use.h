#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/diagnostics.h"
#include "io/json_values.h"
#include "spectral/curve.h"
#include "spectral/library.h"

namespace abbe {

/// What the values of a curve stand for, where a table may say that its own stand for something else. A
/// response is `unsaid` while nobody has said whether it multiplies energy, as it is taken to, or photons. A
/// `power` is one per nm in any unit, read or unread, as of lamps that are scaled; radiance, intensity,
/// irradiance and flux are in W/(m^2 sr nm), W/(sr nm), W/(m^2 nm) and W/nm.
enum class CurveUnit {
  any,
  share,
  per_metre,
  power,
  spectral_radiance,
  spectral_intensity,
  spectral_irradiance,
  spectral_flux,
  unsaid_response
};

/// Where a curve is used: the data folder its names are looked for in, the values it may take, and their
/// unit.
struct CurveUse {
  std::string_view folder;
  Range allowed;
  CurveUnit unit = CurveUnit::any;
  /// Whether it goes on where a table of it ends and says 0, as light and what filters pass do. A response
  /// is what its table says.
  bool goes_on = false;
};
inline constexpr CurveUse kIlluminantUse{"illuminant", {0, 1e30}, CurveUnit::power, true};
inline constexpr CurveUse kReflectanceUse{"reflectance", Range::unit(), CurveUnit::share};
/// Of the patches of charts, which may shine or fluoresce into the instrument; per cent are more.
inline constexpr CurveUse kReflectanceFactorUse{"reflectance", {0, 2}, CurveUnit::share};
/// Of a filter before a sensor: above 1 by what a measurement may err, far below a percentage.
inline constexpr CurveUse kTransmittanceUse{"filter", {0, 1.05}, CurveUnit::share, true};
/// Electrons per photon, above 1 for energetic photons; per cent are more.
inline constexpr CurveUse kQuantumEfficiencyUse{"camera", {0, 10}, CurveUnit::share};
/// The same of a channel, which may have a negative response.
inline constexpr CurveUse kQuantumResponseUse{"camera", {-10, 10}, CurveUnit::share};

/// Why a table called `name` whose line `# unit:` says `told` is not in the unit that is needed, as one in
/// percent or of densities is not in shares, one in 1/cm not in 1/m, and one of photons or per Hz no power
/// per nm. `remedy` ends what is said to be allowed, where a factor makes the one of the other. Nothing when
/// it is in that unit, or in prose that may mean it, such as "reflectance (0-1); wavelength in nm"; for a
/// coefficient prose does not do.
[[nodiscard]] std::optional<std::string> unit_fault(std::string_view name, std::string_view told,
                                                    CurveUnit needed, std::string_view remedy = {});

/// The same of a table that is one factor of a product: what the others cannot make the unit that is needed,
/// as shares in percent, coefficients in 1/cm and parts or multiples of a power. Another quantity than the
/// one needed is none of these.
[[nodiscard]] std::optional<std::string> factor_unit_fault(std::string_view name, std::string_view told,
                                                           CurveUnit needed, std::string_view remedy = {});

/// What is to be said of a table called `name` whose unit says that it is relative, in counts or in percent,
/// where a radiance, an intensity, an irradiance or a flux is needed.
[[nodiscard]] std::optional<std::string> relative_power(std::string_view name, std::string_view unit,
                                                        CurveUnit needed);

/// Whether the unit of a table is one of watts, as W/nm and erg/s are.
[[nodiscard]] bool tells_power(std::string_view unit);

/// What is to be said of a table called `name` that is taken as a response to energy for lack of a word about
/// it, when its unit states quantum efficiencies or a response per photon, and no energy.
[[nodiscard]] std::optional<std::string> unsaid_response(std::string_view name, std::string_view unit);

/// Whether the unit and the values of a table called `name` are those of the use; reports both when not.
bool check_use(const std::string& name, const std::string& unit, const Curve& curve, const CurveUse& use,
               const SourcePosition& where, Diagnostics& diagnostics);

/// Reads a curve as `load_curve` of a folder does, and reports one whose unit or values are not those of the
/// use.
[[nodiscard]] std::optional<NamedCurve> load_curve(const CurveUse& use, const std::string& name,
                                                   const SourcePosition& where, Diagnostics& diagnostics,
                                                   NeededRange needed = {});

}  // namespace abbe
