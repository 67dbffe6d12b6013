#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "description/load_context.h"
#include "description/value_ranges.h"
#include "spectral/curve_use.h"
#include "spectral/sources.h"

namespace abbe::spec {

struct Curve;

/// Samples, linearly interpolated.
struct TableCurve {
  std::vector<double> wavelength_nm;
  std::vector<double> values;
  Outside outside = Outside::clamp;
  SourcePosition where;
};
/// `value` on [low, high) nm.
struct Band {
  schema::Located<std::array<double, 2>> ends;
  double value = 1;
};
struct Gaussian {
  double center_nm = 0;
  double fwhm_nm = 0;
  double peak = 1;
};
struct Line {
  double nm = 0;
  double width_nm = 0;
  double power = 0;
};
struct Lines : schema::Value<std::vector<Line>> {};
struct Blackbody : schema::Value<double> {};  ///< Temperature [K].
struct Daylight : schema::Value<double> {};   ///< Correlated colour temperature [K].
struct Product : schema::Value<std::vector<Curve>> {};
struct Sum : schema::Value<std::vector<Curve>> {};
struct Scaled {
  double scale = 1;
  std::shared_ptr<Curve> of;
};
struct CurveFormula {
  std::variant<std::monostate, TableCurve, Band, Gaussian, Lines, Blackbody, Daylight, Product, Sum, Scaled>
      of;
};
/// A function of wavelength: a constant, the name of a table, or a formula.
struct Curve : schema::Located<std::variant<double, std::string, CurveFormula>> {};

[[nodiscard]] schema::Fields fields(schema::Tag<CurveFormula>);
[[nodiscard]] schema::ValueType value_type(schema::Tag<Curve::Wrapped>);
[[nodiscard]] schema::ValueType value_type(schema::Tag<Lines::Wrapped>);
inline constexpr Range kBlackbody = Range{100, 1e6}.in("K");
inline constexpr Range kDaylight = Range{4000, 25000}.in("K");

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the sampled curve. Returns nothing after an error. Errors in addition to those of the key table:
/// - wavelengths that do not ascend, an empty band, an unknown name, a value that the use does not allow;
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
/// Builds the sum of the spectral lines, each of which spreads its power evenly over its width.
[[nodiscard]] Curve build(const spec::Lines& lines);

}  // namespace abbe::description
