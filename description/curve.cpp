#include "description/curve.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "description/table_ends.h"
#include "spectral/library.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr Range kLineWidth = Range{1e-3, kMaxWavelengthNm - kMinWavelengthNm}.in("nm");

}  // namespace

static Fields fields(Tag<TableCurve>) {
  return describe(
      "table_curve", "Samples with straight lines between them.",
      {field("wavelength_nm", &TableCurve::wavelength_nm, kTableWavelength,
             "Strictly ascending wavelengths."),
       field("values", &TableCurve::values, kValue, "As many values."),
       field("outside", &TableCurve::outside, word<Outside>("rule for outside the table", {"clamp", "zero"}),
             "What holds before the first and after the last sample.")});
}

static Fields fields(Tag<Band>) {
  return describe("band", "A box.",
                  {field("band", &Band::ends, vector<std::array<double, 2>>(kWavelength),
                         "[low, high) in nm, and zero elsewhere."),
                   defaulted("value", &Band::value, kValue, "Height of the band.")});
}

static Fields fields(Tag<Gaussian>) {
  return describe("gaussian", "A bell: peak x 2^(-(2 (wavelength - center)/fwhm)^2).",
                  {field("center_nm", &Gaussian::center_nm, kWavelength, "Where it is highest."),
                   field("fwhm_nm", &Gaussian::fwhm_nm, kLineWidth, "Full width at half maximum."),
                   defaulted("peak", &Gaussian::peak, kValue, "Its height.")});
}

static Fields fields(Tag<Line>) {
  return describe("line", "A spectral line.",
                  {field("nm", &Line::nm, kWavelength, "Its middle."),
                   field("width_nm", &Line::width_nm, kLineWidth, "Its width."),
                   field("power", &Line::power, kPower,
                         "Its integral, of which what lies beyond 300 to 1100 nm does not count.")});
}

static Fields fields(Tag<Scaled>) {
  return describe("scaled", "",
                  {field("of", &Scaled::of, "A curve that `scale` multiplies."),
                   field("scale", &Scaled::scale, kValue, "Factor of the curve `of`.")});
}

Fields fields(Tag<CurveFormula>) {
  return describe(
      "curve_formula", "A curve given by a formula.",
      {one_of(&CurveFormula::of, under<TableCurve>("table"), beside<Band>("band"),
              under<Gaussian>("gaussian"),
              under<Lines>("lines", "Spectral lines, each of which spreads its power evenly over its width."),
              under<Blackbody>("blackbody_K", kBlackbody, "Planck's spectral radiance [W/(m2 sr nm)]."),
              under<Daylight>("daylight_K", kDaylight,
                              "CIE daylight of this correlated colour temperature, relative."),
              under<Product>("product", list<Curve>("curves", 1), "The product of all."),
              under<Sum>("sum", list<Curve>("curves", 1), "The sum of all."), beside<Scaled>("of"))});
}

Kind kind(Tag<Lines::Wrapped>) {
  return list<Line>("lines", 1);
}
Kind kind(Tag<Curve::Wrapped>) {
  return forms<Curve::Wrapped>("curve", "a curve: a number, a name or an object",
                               form<double>(Json::number, kValue), form<std::string>(Json::text),
                               form<CurveFormula>(Json::object));
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

/// What a table is of the curve that it stands in, of which its unit is asked.
enum class TablePart { whole, factor, scaled };

// A number other than 1 scales the other factors, as `scale` does, also one within a product of products.
bool scales(const spec::Curve& factor) {
  if (const auto* number = std::get_if<double>(&factor.value)) return *number != 1;
  const auto* formula = std::get_if<spec::CurveFormula>(&factor.value);
  const auto* product = formula != nullptr ? std::get_if<spec::Product>(&formula->of) : nullptr;
  return product != nullptr && std::any_of(product->value.begin(), product->value.end(), scales);
}
TablePart part_in(const std::vector<spec::Curve>& factors, TablePart product) {
  const bool scaled = std::any_of(factors.begin(), factors.end(), scales);
  return scaled || product == TablePart::scaled ? TablePart::scaled : TablePart::factor;
}

/// What is to be said of the tables of a product that are relative, unless another factor gives it a unit: a
/// table in watts, or a formula or a `scale`, of which the user has chosen the values.
struct ProductDoubts {
  bool has_unit = false;
  std::vector<std::pair<SourcePosition, std::string>> doubts;

  void report(Diagnostics& diagnostics) const {
    if (has_unit) return;
    for (const auto& [where, doubt] : doubts) diagnostics.error_if_strict(where, doubt);
  }
};

std::optional<std::string> fault_of_unit(const NamedCurve& table, const CurveUse& use, TablePart part) {
  if (part == TablePart::scaled) return std::nullopt;
  const std::string remedy = fmt::format("; {{\"scale\": S, \"of\": \"{}\"}} converts", table.name);
  return part == TablePart::factor ? factor_unit_fault(table.name, table.unit, use.unit, remedy)
                                   : unit_fault(table.name, table.unit, use.unit, remedy);
}
std::optional<std::string> doubt_of_unit(const NamedCurve& table, const CurveUse& use, TablePart part) {
  if (part == TablePart::scaled) return std::nullopt;
  if (use.unit == CurveUnit::unsaid_response) return unsaid_response(table.name, table.unit);
  return relative_power(table.name, table.unit, use.unit);
}

/// Builds each form of a curve, without regard to the values it may take.
struct CurveBuilder {
  const CurveUse& use;
  const SourcePosition& where;
  LoadContext& context;
  TablePart part = TablePart::whole;
  ProductDoubts* product_doubts = nullptr;  ///< Of the outermost product that it stands in.

  [[nodiscard]] std::optional<NamedCurve> named(const std::string& words) const {
    const std::optional<std::string> name = context.table(words, where);
    auto table =
        name ? load_curve(use.folder, *name, where, context.diagnostics, context.ends.needed) : std::nullopt;
    if (!table) return std::nullopt;
    table->name = words;
    return with_ends(*std::move(table), use, where, context.ends);
  }
  // Whether its unit is that of the use.
  [[nodiscard]] bool fits(const NamedCurve& table) const {
    const auto fault = fault_of_unit(table, use, part);
    if (fault)
      context.diagnostics.error(where, *fault);
    else if (auto doubt = doubt_of_unit(table, use, part))
      tell(*std::move(doubt));
    if (product_doubts != nullptr && tells_power(table.unit)) product_doubts->has_unit = true;
    return !fault;
  }
  // Of what other factors may give a unit it is said when all are known.
  void tell(std::string doubt) const {
    if (product_doubts != nullptr && use.unit != CurveUnit::unsaid_response)
      product_doubts->doubts.emplace_back(where, std::move(doubt));
    else
      context.diagnostics.error_if_strict(where, std::move(doubt));
  }
  [[nodiscard]] std::optional<Curve> of(const spec::Curve& curve, TablePart entry) const {
    return std::visit(CurveBuilder{use, curve.where, context, entry, product_doubts}, curve.value);
  }
  // A product or a sum of one curve or more.
  template <typename Combine>
  [[nodiscard]] std::optional<Curve> combined(const std::vector<spec::Curve>& list, TablePart entry_part,
                                              Combine combine) const {
    std::optional<Curve> all;
    bool complete = true;
    for (const spec::Curve& entry : list) {
      std::optional<Curve> one = of(entry, entry_part);
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
    if (!combines && product_doubts != nullptr) product_doubts->has_unit = true;
    return std::visit(*this, formula.of);
  }
  std::optional<Curve> operator()(std::monostate) const { return std::nullopt; }
  std::optional<Curve> operator()(const spec::TableCurve& table) const {
    const std::vector<double>& wavelengths = table.wavelength_nm;
    if (table.values.size() != wavelengths.size()) {
      context.diagnostics.error(
          table.where, fmt::format("as many values as wavelengths are needed (got {} values, allowed {})",
                                   table.values.size(), wavelengths.size()));
      return std::nullopt;
    }
    if (wavelengths.size() < 2) {
      context.diagnostics.error(
          table.where, fmt::format("a table needs two samples or more (got {})", wavelengths.size()));
      return std::nullopt;
    }
    const auto step = std::adjacent_find(wavelengths.begin(), wavelengths.end(), std::greater_equal<>());
    if (step != wavelengths.end()) {
      context.diagnostics.error(
          table.where, fmt::format("wavelengths must ascend (got {} nm after {} nm)", *(step + 1), *step));
      return std::nullopt;
    }
    if (auto fault = range_fault(wavelengths.front(), wavelengths.back())) {
      context.diagnostics.error(table.where, std::move(*fault));
      return std::nullopt;
    }
    return table_curve(wavelengths, table.values, table.outside);
  }
  std::optional<Curve> operator()(const spec::Band& said) const {
    const auto [low, high] = said.ends.value;
    if (low < high) return band(low, high, said.value);
    context.diagnostics.error(said.ends.where,
                              fmt::format("an empty band (got [{}, {}] nm, allowed low < high)", low, high));
    return std::nullopt;
  }
  std::optional<Curve> operator()(const spec::Gaussian& bell) const {
    return gaussian(bell.center_nm, bell.fwhm_nm, bell.peak);
  }
  std::optional<Curve> operator()(const spec::Lines& lines) const { return description::build(lines); }
  std::optional<Curve> operator()(const spec::Blackbody& body) const { return planck(body.value); }
  std::optional<Curve> operator()(const spec::Daylight& day) const {
    return with_ends(named_daylight(day.value), use, where, context.ends).curve;
  }
  std::optional<Curve> operator()(const spec::Product& factors) const {
    ProductDoubts found;
    CurveBuilder outermost = *this;
    if (product_doubts == nullptr) outermost.product_doubts = &found;
    auto all = outermost.combined(factors.value, part_in(factors.value, part), product);
    found.report(context.diagnostics);
    return all;
  }
  std::optional<Curve> operator()(const spec::Sum& terms) const {
    return combined(terms.value, part, [](const Curve& a, const Curve& b) { return sum(a, b); });
  }
  std::optional<Curve> operator()(const spec::Scaled& said) const {
    const std::optional<Curve> curve = of(*said.of, TablePart::scaled);
    return curve ? std::optional(scaled(*curve, said.scale)) : std::nullopt;
  }
};

}  // namespace

Curve build(const spec::Lines& said) {
  std::vector<SpectralLine> found;
  for (const spec::Line& line : said.value) found.push_back({line.nm, line.width_nm, line.power});
  return lines(found);
}

std::optional<Curve> build(const spec::Curve& curve, const CurveUse& use, LoadContext& context) {
  std::optional<Curve> built = std::visit(CurveBuilder{use, curve.where, context}, curve.value);
  if (!built) return std::nullopt;
  const auto fault = value_fault(*built, use.allowed);
  if (!fault) return built;
  context.diagnostics.error(curve.where, *fault);
  return std::nullopt;
}

}  // namespace abbe::description
