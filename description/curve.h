#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/load_context.h"
#include "description/value_ranges.h"
#include "spectral/curve_use.h"
#include "spectral/sources.h"

namespace abbe::spec {

// Curves as scene files describe them. Their values are in the unit of the use, such as a fraction or 1/m.

struct Curve;

/// Samples, linearly interpolated.
struct TableCurve {
  std::vector<double> wavelength_nm;  ///< Strictly ascending, two or more.
  std::vector<double> values;         ///< One per wavelength.
  Outside outside = Outside::clamp;   ///< Values outside the wavelengths: those of the ends, or 0.
  SourcePosition where;
};
/// A rectangular function: `value` on [low, high) nm, 0 outside.
struct Band {
  schema::Located<std::array<double, 2>> ends;  ///< low and high [nm].
  double value = 1;
};
/// The function peak * 2^(-(2 (wavelength - center)/fwhm)^2).
struct Gaussian {
  double center_nm = 0;
  double fwhm_nm = 0;
  double peak = 1;
};
/// A spectral line of constant height power/width_nm over its width.
struct Line {
  double nm = 0;        ///< Center.
  double width_nm = 0;  ///< Full width, above 0.
  double power = 0;     ///< Integral of the line over wavelength, 0 or more.
};
struct Lines : schema::Value<std::vector<Line>> {};  ///< The sum of one or more lines.
/// Planck's spectral radiance [W/(m2 sr nm)] at this temperature [K].
struct Blackbody : schema::Value<double> {};
/// Relative spectrum of CIE daylight of this correlated colour temperature [K].
struct Daylight : schema::Value<double> {};
struct Product : schema::Value<std::vector<Curve>> {};  ///< Product of one or more curves.
struct Sum : schema::Value<std::vector<Curve>> {};      ///< Sum of one or more curves.
/// The curve `of` times `scale`.
struct Scaled {
  double scale = 1;
  std::shared_ptr<Curve> of;
};
/// One of the formulas above. `std::monostate` means that none has been read.
struct CurveFormula {
  std::variant<std::monostate, TableCurve, Band, Gaussian, Lines, Blackbody, Daylight, Product, Sum, Scaled>
      of;
};
/// A function of wavelength: a constant, the name of a table, or a formula.
struct Curve : schema::Located<std::variant<double, std::string, CurveFormula>> {};

// Forms in which scene files write these types.
[[nodiscard]] schema::ValueType value_type(schema::Tag<Curve::Wrapped>);
[[nodiscard]] schema::ValueType value_type(schema::Tag<Lines::Wrapped>);
// Allowed temperatures of `Blackbody` and `Daylight`.
inline constexpr Range kBlackbody = Range{100, 1e6}.in("K");
inline constexpr Range kDaylight = Range{4000, 25000}.in("K");

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the curve over wavelength [nm], with values in the unit of `use`; nothing after an error. Reports
/// to `context.diagnostics`, in addition to the errors of the key table:
/// - wavelengths that do not ascend, an empty band, an unknown name, a value that `use` does not allow;
/// - a table without data at wavelengths that `context.coverage` needs;
/// - a table in another unit than the use needs, such as 1/cm instead of 1/m, or percent instead of a
///   fraction.
/// A table that is scaled may have any unit. It counts as scaled under `scale`, or in a product (nested
/// products included) with a number other than 1. A table that is another factor of a product may be a
/// different quantity, but no multiple of the unit.
/// Warns of units that count photons where the kind of response is unknown. Warns of relative spectra where a
/// quantity is needed. In a product this second warning is dropped if another factor is in watts or is a
/// formula. Tables that end within the sensor's range are noted in `context.coverage`.
[[nodiscard]] std::optional<Curve> build(const spec::Curve& curve, const CurveUse& use, LoadContext& context);
/// Builds the sum of the spectral lines, each of which spreads its power evenly over its width. Never fails.
/// Power outside 300 to 1100 nm is lost.
[[nodiscard]] Curve build(const spec::Lines& lines);

}  // namespace abbe::description
