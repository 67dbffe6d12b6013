#pragma once

#include <cstddef>
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
  std::string name;    ///< Name under which it was requested.
  std::string source;  ///< Line `# source` of the table: a reference, or path and hash of a user's file.
  std::string unit;    ///< Line `# unit` of the table, unparsed. The values of `curve` are in this unit.
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

/// A column of a table.
struct TableSamples {
  Table table;
  Samples samples;  ///< One per row.
};

/// Reads the samples of the curve `name` of a data folder at any wavelengths. Names and reports are those of
/// `load_curve`, which also checks coverage and misspelt keys.
[[nodiscard]] std::optional<TableSamples> load_samples(std::string_view folder, const std::string& name,
                                                       const SourcePosition& where, Diagnostics& diagnostics);

/// Reads the curve `name` of a data folder ("illuminant", "reflectance", "camera", "filter", "observer").
/// `find_table` describes the names. The first column is `wavelength_nm`, or `wavelength_um` in a user's
/// file. The line `# interpolation:` selects the rule (default linear). Overshoot is clamped to the line `#
/// value_range: low, high`, or to 0 if no sample is negative. Values keep the unit of the table. Illuminants
/// A and E follow their definitions outside their tables. An unknown name is an error of the code `scene`,
/// others have `input`. Reports errors and returns nothing for
/// - a name that `find_table` does not know, and a file that `read_table` rejects;
/// - a table of several value columns whose name does not select one;
/// - wavelengths that do not ascend, and fewer than two samples;
/// - wavelengths that all lie outside [300, 1100] nm, which indicates a wrong unit;
/// - a table declared `outside: error` that does not cover `needed`;
/// - an unknown interpolation rule, and samples that it does not accept;
/// - a malformed `value_range`, and samples outside it;
/// - a key that resembles one of `governing_keys` but is misspelt.
[[nodiscard]] std::optional<NamedCurve> load_curve(std::string_view folder, const std::string& name,
                                                   const SourcePosition& where, Diagnostics& diagnostics,
                                                   NeededRange needed = {});

/// The curve `name` of a shipped table. Throws Error{input} if `load_curve` reports an error.
[[nodiscard]] Curve shipped_curve(std::string_view folder, const std::string& name);

/// Reads a column of a parsed table. `name` only becomes the name of the curve.
[[nodiscard]] std::optional<NamedCurve> curve_of(const Table& table, const std::string& column,
                                                 const std::string& name, Diagnostics& diagnostics,
                                                 NeededRange needed = {});

/// Explains why a table or formula valid on [low_nm, high_nm] is useless: all of it lies outside [300, 1100]
/// nm.
[[nodiscard]] std::optional<std::string> range_fault(double low_nm, double high_nm);

/// Explains that a curve leaves the allowed range, by its first knot outside. Nothing if it does not.
[[nodiscard]] std::optional<std::string> value_fault(const Curve& curve, const Range& allowed);

/// CIE daylight of correlated colour temperature `kelvin` in [4000, 25000] K, which the caller checks. Throws
/// like `daylight`.
[[nodiscard]] NamedCurve named_daylight(double kelvin);

/// Reads an illuminant by name: a table of `data/illuminant` as for `load_curve`, "blackbody:<K>" with 100 to
/// 1e6 K or "daylight:<K>" with 4000 to 25000 K. Black bodies are radiances [W/(m^2 sr nm)]; tables have any
/// unit of power per nm.
[[nodiscard]] std::optional<NamedCurve> load_illuminant(const std::string& name, const SourcePosition& where,
                                                        Diagnostics& diagnostics, NeededRange needed = {});

/// Largest fraction of a response or light that may be unknown without a warning.
inline constexpr double kNegligibleFraction = 1e-3;

/// Fraction of an integral outside a range, and the number of linear pieces that were summed for it.
struct FractionOutside {
  double fraction = 0;     ///< In [0, 1].
  std::size_t pieces = 0;  ///< A measure of the work, for tests.
};

/// Fraction of the integral of |weight x light| below `low_nm` and above `high_nm`; 0 if the product is 0
/// everywhere. Sums only pieces with a nonzero weight, and none if all of them lie inside the range.
[[nodiscard]] FractionOutside fraction_outside(const Curve& weight, const Curve& light, double low_nm,
                                               double high_nm);

/// Smallest range [nm] between knots of the curve, rounded outwards to whole nanometres, that omits at most
/// `kNegligibleFraction` of the integral of |curve| at each end. For a curve that is 0 everywhere, the range
/// is {1100, 300}.
[[nodiscard]] NeededRange main_range(const Curve& curve);

/// Curve of a table, extrapolated by its first and last row, whatever `table.outside` declares.
[[nodiscard]] Curve extrapolated(const NamedCurve& table);

}  // namespace abbe
