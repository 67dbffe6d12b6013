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

/// A curve read from a table, and its metadata.
struct NamedCurve {
  std::string name;
  std::string source;
  std::string unit;
  double low_nm = 0;   ///< First tabulated wavelength.
  double high_nm = 0;  ///< Last tabulated wavelength.
  Curve curve;
  Outside outside = Outside::clamp;  ///< Extrapolation rule of the table.
};

/// Wavelengths [nm] that a table must cover. The standard observers have less than a thousandth of their
/// response outside the default. Sums over a wider range extrapolate the table as it declares, or by its
/// first and last value [CIE15, sec. 7.2].
struct NeededRange {
  double low_nm = 380;
  double high_nm = 780;
};
/// All wavelengths of a render.
inline constexpr NeededRange kEveryWavelength{kMinWavelengthNm, kMaxWavelengthNm};

/// A column of a table without interpolation.
struct TableSamples {
  Table table;
  Samples samples;  ///< One per row.
};

/// Reads the samples of the curve `name` of a data folder at any wavelengths. Names, units and errors are
/// those of `load_curve`.
[[nodiscard]] std::optional<TableSamples> load_samples(std::string_view folder, const std::string& name,
                                                       const SourcePosition& where, Diagnostics& diagnostics);

/// Reads the curve `name` of a data folder ("illuminant", "reflectance", "camera", "filter", "observer").
/// `find_table` describes the names. The first column is `wavelength_nm`, or `wavelength_um` in a user's
/// file. The line `# interpolation:` selects the rule (default linear). Overshoot is clamped to the line `#
/// value_range: low, high`, or to 0 if no sample is negative. Illuminants A and E follow their definitions
/// outside their tables. Reports
/// - wavelengths that do not ascend, and fewer than two samples;
/// - wavelengths that all lie outside [300, 1100] nm, which indicates a wrong unit;
/// - a table declared `outside: error` that does not cover `needed`;
/// - an unknown interpolation rule, samples that it does not accept, and samples outside the declared range.
[[nodiscard]] std::optional<NamedCurve> load_curve(std::string_view folder, const std::string& name,
                                                   const SourcePosition& where, Diagnostics& diagnostics,
                                                   NeededRange needed = {});

/// Reads a column of a parsed table under the name `name`, with the checks of `load_curve`.
[[nodiscard]] std::optional<NamedCurve> curve_of(const Table& table, const std::string& column,
                                                 const std::string& name, Diagnostics& diagnostics,
                                                 NeededRange needed = {});

/// Explains why a table or formula valid on [low_nm, high_nm] is useless: all of it lies outside [300, 1100]
/// nm. Nothing if some of it lies inside.
[[nodiscard]] std::optional<std::string> range_fault(double low_nm, double high_nm);

/// Explains that a curve leaves the allowed range, by its first knot outside. Nothing if it does not.
[[nodiscard]] std::optional<std::string> value_fault(const Curve& curve, const Range& allowed);

/// CIE daylight of correlated colour temperature `kelvin`, named "daylight:<K>"; 0 above 830 nm.
[[nodiscard]] NamedCurve named_daylight(double kelvin);

/// Reads an illuminant by name: a table of `data/illuminant` as for `load_curve`, "blackbody:<K>" or
/// "daylight:<K>". Reports a table with negative power.
[[nodiscard]] std::optional<NamedCurve> load_illuminant(const std::string& name, const SourcePosition& where,
                                                        Diagnostics& diagnostics, NeededRange needed = {});

}  // namespace abbe
