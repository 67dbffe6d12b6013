#include "description/curve.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "description/load_context.h"
#include "spectral/library.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr Range kLineWidth = Range{1e-3, kMaxWavelengthNm - kMinWavelengthNm}.in("nm");

}  // namespace

static Fields fields(Tag<TableCurve>) {
  return describe("table_curve", "Samples, linearly interpolated.",
                  {field("wavelength_nm", &TableCurve::wavelength_nm, kTableWavelength,
                         "Strictly ascending wavelengths."),
                   field("values", &TableCurve::values, kValue, "Values at these wavelengths."),
                   field("outside", &TableCurve::outside,
                         enumeration<Outside>("rule for outside the table", {"clamp", "zero"}),
                         "Values outside the range of the table: those of the ends, or zero.")});
}

static Fields fields(Tag<Band>) {
  return describe("band", "A rectangular function.",
                  {field("band", &Band::ends, vector<std::array<double, 2>>(kWavelength),
                         "Range [low, high) in nm, with zero outside."),
                   defaulted("value", &Band::value, kValue, "Height of the band.")});
}

static Fields fields(Tag<Gaussian>) {
  return describe("gaussian", "A Gaussian: peak x 2^(-(2 (wavelength - center)/fwhm)^2).",
                  {field("center_nm", &Gaussian::center_nm, kWavelength, "Wavelength of the maximum."),
                   field("fwhm_nm", &Gaussian::fwhm_nm, kLineWidth, "Full width at half maximum."),
                   defaulted("peak", &Gaussian::peak, kValue, "Value at the center.")});
}

static Fields fields(Tag<Line>) {
  return describe("line", "A spectral line.",
                  {field("nm", &Line::nm, kWavelength, "Center of the line."),
                   field("width_nm", &Line::width_nm, kLineWidth, "Width of the line."),
                   field("power", &Line::power, kPower,
                         "Integral of the line. The part outside 300 to 1100 nm is lost.")});
}

static Fields fields(Tag<Scaled>) {
  return describe("scaled", "",
                  {field("of", &Scaled::of, "Curve to multiply by `scale`."),
                   field("scale", &Scaled::scale, kValue, "Factor applied to the curve `of`.")});
}

static Fields fields(Tag<CurveFormula>) {
  return describe(
      "curve_formula", "A curve given by a formula.",
      {one_of(&CurveFormula::of, under<TableCurve>("table"), inlined_by<Band>("band"),
              under<Gaussian>("gaussian"),
              under<Lines>("lines", "Spectral lines, each of which spreads its power evenly over its width."),
              under<Blackbody>("blackbody_K", kBlackbody, "Planck's spectral radiance [W/(m2 sr nm)]."),
              under<Daylight>("daylight_K", kDaylight,
                              "Relative spectrum of CIE daylight of this correlated colour temperature."),
              under<Product>("product", list<Curve>("curves", 1), "Product of all curves."),
              under<Sum>("sum", list<Curve>("curves", 1), "Sum of all curves."), inlined_by<Scaled>("of"))});
}

ValueType value_type(Tag<Lines::Wrapped>) {
  return list<Line>("lines", 1);
}
ValueType value_type(Tag<Curve::Wrapped>) {
  return forms<Curve::Wrapped>("curve", "a curve: a number, a name or an object",
                               form<double>(Json::number, kValue), form<std::string>(Json::text),
                               form<CurveFormula>(Json::object));
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

/// Role of a table in a curve; it decides how the unit of the table is checked.
enum class TableRole { whole, factor, scaled };

// True for a number other than 1, which scales the other factors as `scale` does, also within nested
// products.
bool scales(const spec::Curve& factor) {
  if (const auto* number = std::get_if<double>(&factor.value)) return *number != 1;
  const auto* formula = std::get_if<spec::CurveFormula>(&factor.value);
  const auto* product = formula != nullptr ? std::get_if<spec::Product>(&formula->of) : nullptr;
  return product != nullptr && std::any_of(product->value.begin(), product->value.end(), scales);
}
TableRole role_in(const std::vector<spec::Curve>& factors, TableRole product) {
  const bool scaled = std::any_of(factors.begin(), factors.end(), scales);
  return scaled || product == TableRole::scaled ? TableRole::scaled : TableRole::factor;
}

/// Warnings about relative tables in a product. They are dropped if another factor gives the product a unit:
/// a table in watts, or a formula or `scale`, whose values the user has chosen.
struct UnitWarnings {
  bool has_unit = false;
  std::vector<std::pair<SourcePosition, std::string>> warnings;
};

/// Builds each form of a curve, without checking its values.
struct CurveBuilder {
  const CurveUse& use;
  const SourcePosition& where;
  LoadContext& context;
  TableRole role = TableRole::whole;
  UnitWarnings* product_warnings =
      nullptr;  ///< Warnings of the outermost enclosing product; null outside products.

  [[nodiscard]] std::optional<NamedCurve> named(const std::string& words) const {
    const std::optional<std::string> name = context.table(words, where);
    auto table = name ? load_curve(use.folder, *name, where, context.diagnostics, context.coverage.needed)
                      : std::nullopt;
    if (!table) return std::nullopt;
    table->name = words;
    return with_extrapolation(*std::move(table), use, where, context.coverage);
  }
  // True if the unit of the table is allowed. Reports the error or warning.
  [[nodiscard]] bool fits(const NamedCurve& table) const {
    if (product_warnings != nullptr && declares_power(table.unit)) product_warnings->has_unit = true;
    if (role == TableRole::scaled) return true;
    const std::string remedy = fmt::format("; {{\"scale\": S, \"of\": \"{}\"}} converts", table.name);
    const auto fault = unit_fault(table.name, table.unit, use.unit, remedy,
                                  role == TableRole::factor ? UnitRole::factor : UnitRole::whole);
    if (fault) {
      context.diagnostics.error(where, *fault);
      return false;
    }
    auto warning = use.unit == CurveUnit::unknown_response ? unknown_response(table.name, table.unit)
                                                           : relative_power(table.name, table.unit, use.unit);
    if (warning) warn(*std::move(warning));
    return true;
  }
  // Reports a warning now, or when all factors are known if another factor may resolve it.
  void warn(std::string warning) const {
    if (product_warnings != nullptr && use.unit != CurveUnit::unknown_response)
      product_warnings->warnings.emplace_back(where, std::move(warning));
    else
      context.diagnostics.error_if_strict(where, std::move(warning));
  }
  [[nodiscard]] std::optional<Curve> of(const spec::Curve& curve, TableRole entry) const {
    return std::visit(CurveBuilder{use, curve.where, context, entry, product_warnings}, curve.value);
  }
  // Combines one or more curves to a product or a sum.
  template <typename Combine>
  [[nodiscard]] std::optional<Curve> combined(const std::vector<spec::Curve>& list, TableRole entry_role,
                                              Combine combine) const {
    std::optional<Curve> all;
    bool complete = true;
    for (const spec::Curve& entry : list) {
      std::optional<Curve> one = of(entry, entry_role);
      complete = complete && one;
      if (complete) all = all ? combine(*all, *one) : std::move(one);
    }
    return complete ? all : std::nullopt;
  }

  std::optional<Curve> operator()(double value) const { return Curve(value); }
  std::optional<Curve> operator()(const std::string& words) const {
    std::optional<NamedCurve> table = named(words);
    if (!table || !fits(*table)) return std::nullopt;
    return std::move(table->curve);
  }
  std::optional<Curve> operator()(const spec::CurveFormula& formula) const {
    const bool combines =
        std::holds_alternative<spec::Product>(formula.of) || std::holds_alternative<spec::Sum>(formula.of);
    if (!combines && product_warnings != nullptr) product_warnings->has_unit = true;
    return std::visit(*this, formula.of);
  }
  std::optional<Curve> operator()(std::monostate) const { return std::nullopt; }
  std::optional<Curve> operator()(const spec::TableCurve& table) const {
    const std::vector<double>& wavelengths = table.wavelength_nm;
    if (table.values.size() != wavelengths.size())
      return context.refuse(
          table.where, fmt::format("as many values as wavelengths are needed (got {} values, allowed {})",
                                   table.values.size(), wavelengths.size()));
    if (wavelengths.size() < 2)
      return context.refuse(table.where,
                            fmt::format("a table needs two samples or more (got {})", wavelengths.size()));
    const auto step = std::adjacent_find(wavelengths.begin(), wavelengths.end(), std::greater_equal<>());
    if (step != wavelengths.end())
      return context.refuse(
          table.where, fmt::format("wavelengths must ascend (got {} nm after {} nm)", *(step + 1), *step));
    if (auto fault = range_fault(wavelengths.front(), wavelengths.back()))
      return context.refuse(table.where, std::move(*fault));
    return table_curve(wavelengths, table.values, table.outside);
  }
  std::optional<Curve> operator()(const spec::Band& spec) const {
    const auto [low, high] = spec.ends.value;
    if (low < high) return band(low, high, spec.value);
    return context.refuse(spec.ends.where,
                          fmt::format("an empty band (got [{}, {}] nm, allowed low < high)", low, high));
  }
  std::optional<Curve> operator()(const spec::Gaussian& bell) const {
    return gaussian(bell.center_nm, bell.fwhm_nm, bell.peak);
  }
  std::optional<Curve> operator()(const spec::Lines& lines) const { return description::build(lines); }
  std::optional<Curve> operator()(const spec::Blackbody& body) const { return planck(body.value); }
  std::optional<Curve> operator()(const spec::Daylight& day) const {
    return with_extrapolation(named_daylight(day.value), use, where, context.coverage).curve;
  }
  std::optional<Curve> operator()(const spec::Product& factors) const {
    UnitWarnings warnings;
    CurveBuilder outermost = *this;
    if (product_warnings == nullptr) outermost.product_warnings = &warnings;
    auto all = outermost.combined(factors.value, role_in(factors.value, role), product);
    if (!warnings.has_unit)
      for (const auto& [at, warning] : warnings.warnings) context.diagnostics.error_if_strict(at, warning);
    return all;
  }
  std::optional<Curve> operator()(const spec::Sum& terms) const {
    return combined(terms.value, role, [](const Curve& a, const Curve& b) { return sum(a, b); });
  }
  std::optional<Curve> operator()(const spec::Scaled& spec) const {
    const std::optional<Curve> curve = of(*spec.of, TableRole::scaled);
    return curve ? std::optional(scaled(*curve, spec.scale)) : std::nullopt;
  }
};

}  // namespace

Curve build(const spec::Lines& spec) {
  std::vector<SpectralLine> spectral_lines;
  for (const spec::Line& line : spec.value) spectral_lines.push_back({line.nm, line.width_nm, line.power});
  return lines(spectral_lines);
}

std::optional<Curve> build(const spec::Curve& curve, const CurveUse& use, LoadContext& context) {
  std::optional<Curve> built = std::visit(CurveBuilder{use, curve.where, context}, curve.value);
  if (!built) return std::nullopt;
  const auto fault = value_fault(*built, use.allowed);
  if (!fault) return built;
  return context.refuse(curve.where, *fault);
}

}  // namespace abbe::description
