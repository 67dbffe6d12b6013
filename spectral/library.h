#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/diagnostics.h"
#include "io/json_values.h"
#include "io/table.h"
#include "spectral/curve.h"
#include "spectral/interpolation.h"

namespace abbe {

/// A curve read from a table, with what is known of it.
struct NamedCurve {
  std::string name;
  std::string source;
  std::string unit;
  double low_nm = 0;   ///< First tabulated wavelength.
  double high_nm = 0;  ///< Last tabulated wavelength.
  Curve curve;
  Outside outside = Outside::clamp;  ///< What the table says of the wavelengths beyond.
};

/// The wavelengths [nm] that a table must cover. By default the standard observers have less than a
/// thousandth of their response outside. Sums over a wider range extend the table as it declares, else by its
/// first and last value [CIE15, sec. 7.2].
struct NeededRange {
  double low_nm = 380;
  double high_nm = 780;
};
/// All wavelengths that are carried.
inline constexpr NeededRange kEveryWavelength{kMinWavelengthNm, kMaxWavelengthNm};

/// A column of a table, as it stands there.
struct TableSamples {
  Table table;
  Samples samples;  ///< One for each row.
};

/// Reads the samples of the curve `name` of a data folder, whose names, units and faults are those of
/// `load_curve`; they may cover any wavelengths.
[[nodiscard]] std::optional<TableSamples> load_samples(std::string_view folder, const std::string& name,
                                                       const SourcePosition& where, Diagnostics& diagnostics);

/// Reads the curve `name` of a data folder ("illuminant", "reflectance", "camera", "filter", "observer"): see
/// `find_table` for the names. The first column is `wavelength_nm` (a user's file may have
/// `wavelength_um`). Reports unsorted or duplicate wavelengths, fewer than two samples, wavelengths all
/// outside [300, 1100] nm (a wrong unit), and a table declared `outside: error` that does not cover `needed`.
/// Between its samples the table is read as its line `# interpolation:` says (default linear), overshoot cut
/// to its line `# value_range: low, high`; without one, what has no negative sample is not interpolated below
/// 0. Reports an unknown rule, samples that the rule cannot take, and those outside the range. Illuminants A
/// and E beyond their tables follow their definitions.
[[nodiscard]] std::optional<NamedCurve> load_curve(std::string_view folder, const std::string& name,
                                                   const SourcePosition& where, Diagnostics& diagnostics,
                                                   NeededRange needed = {});

/// Reads a column of a table already read, called `name`, with the checks of `load_curve`.
[[nodiscard]] std::optional<NamedCurve> curve_of(const Table& table, const std::string& column,
                                                 const std::string& name, Diagnostics& diagnostics,
                                                 NeededRange needed = {});

/// Why a table or formula that holds on [low_nm, high_nm] is of no use: all of it lies outside [300, 1100]
/// nm. Nothing when some does not.
[[nodiscard]] std::optional<std::string> range_fault(double low_nm, double high_nm);

/// Why a curve is of no use for a quantity within that range: its first knot outside. Nothing when it has
/// none.
[[nodiscard]] std::optional<std::string> value_fault(const Curve& curve, const Range& allowed);

/// CIE daylight of that correlated colour temperature [K] as "daylight:<K>" names it, which is 0 beyond 830
/// nm.
[[nodiscard]] NamedCurve named_daylight(double kelvin);

/// Illuminants by name: those of `data/illuminant`, as `load_curve` has them, "blackbody:<K>" and
/// "daylight:<K>". Reports a table with negative power.
[[nodiscard]] std::optional<NamedCurve> load_illuminant(const std::string& name, const SourcePosition& where,
                                                        Diagnostics& diagnostics, NeededRange needed = {});

}  // namespace abbe
