#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "description/kinds.h"
#include "description/load_context.h"
#include "spectral/curve_use.h"
#include "spectral/sources.h"

namespace abbe::spec {

struct Curve;

/// Samples with straight lines between them.
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
struct Blackbody : schema::Value<double> {};  ///< [K]
struct Daylight : schema::Value<double> {};   ///< [K]
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
[[nodiscard]] schema::Kind kind(schema::Tag<Curve::Wrapped>);
[[nodiscard]] schema::Kind kind(schema::Tag<Lines::Wrapped>);
inline constexpr Range kBlackbody = Range{100, 1e6}.in("K");
inline constexpr Range kDaylight = Range{4000, 25000}.in("K");

}  // namespace abbe::spec

namespace abbe::description {

/// The curve, sampled. Reports what no table can say: wavelengths that do not ascend, an empty band, an
/// unknown name, values that the use does not allow, a table that says nothing of wavelengths that
/// `context.ends` needs, or one whose unit is another one, as 1/cm is for 1/m and percent for a share;
/// nothing then. A table that is scaled, by `scale` or by a number other than 1 in a product or a product
/// within it, may be in any unit; one that is another factor of a product may be another quantity, but no
/// part or multiple. Warns of units that speak of photons where the response is unsaid, and of relative
/// spectra where a quantity is needed, in products unless another factor is in watts or a formula. Tables
/// that end are noted in `context.ends`.
[[nodiscard]] std::optional<Curve> build(const spec::Curve& curve, const CurveUse& use, LoadContext& context);
[[nodiscard]] Curve build(const spec::Lines& lines);

}  // namespace abbe::description
