#include "description/curve.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "spectral/library.h"

namespace abbe::description {
namespace {

/// Builds each form of a curve, without regard to the values it may take.
struct CurveBuilder {
  std::string_view folder;
  const SourcePosition& where;
  LoadContext& context;

  [[nodiscard]] std::optional<Curve> of(const spec::Curve& curve) const {
    return std::visit(CurveBuilder{folder, curve.where, context}, curve.value);
  }
  // A product or a sum of one curve or more.
  template <typename Combine>
  [[nodiscard]] std::optional<Curve> combined(const std::vector<spec::Curve>& list, Combine combine) const {
    std::optional<Curve> all;
    bool complete = true;
    for (const spec::Curve& entry : list) {
      std::optional<Curve> one = of(entry);
      complete = complete && one;
      if (complete) all = all ? combine(*all, *one) : std::move(one);
    }
    return complete ? all : std::nullopt;
  }

  std::optional<Curve> operator()(double value) const { return Curve(value); }
  std::optional<Curve> operator()(const std::string& words) const {
    const std::optional<std::string> name = context.table(words, where);
    if (!name) return std::nullopt;
    std::optional<NamedCurve> named = load_curve(folder, *name, where, context.diagnostics);
    if (!named) return std::nullopt;
    return std::move(named->curve);
  }
  std::optional<Curve> operator()(const spec::CurveFormula& formula) const {
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
    if (step == wavelengths.end()) return table_curve(wavelengths, table.values, table.outside);
    context.diagnostics.error(
        table.where, fmt::format("wavelengths must ascend (got {} nm after {} nm)", *(step + 1), *step));
    return std::nullopt;
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
  std::optional<Curve> operator()(const spec::Lines& lines) const { return build(lines); }
  std::optional<Curve> operator()(const spec::Blackbody& body) const { return planck(body.value); }
  std::optional<Curve> operator()(const spec::Daylight& day) const { return daylight(day.value); }
  std::optional<Curve> operator()(const spec::Product& factors) const {
    return combined(factors.value, product);
  }
  std::optional<Curve> operator()(const spec::Sum& terms) const {
    return combined(terms.value, [](const Curve& a, const Curve& b) { return sum(a, b); });
  }
  std::optional<Curve> operator()(const spec::Scaled& said) const {
    const std::optional<Curve> curve = of(*said.of);
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
  std::optional<Curve> built = CurveBuilder{use.folder, curve.where, context}.of(curve);
  if (!built) return std::nullopt;
  const auto fault = value_fault(*built, use.allowed);
  if (!fault) return built;
  context.diagnostics.error(curve.where, *fault);
  return std::nullopt;
}

}  // namespace abbe::description
